//! What a tree costs by the surface-area heuristic, and how large it is.

use super::{Node, Tree, WIDTH};

/// Half the area of a box by its rows in a node.
fn area(lower: [f32; 3], upper: [f32; 3]) -> f64 {
    let [x, y, z]: [f64; 3] = std::array::from_fn(|a| f64::from(upper[a]) - f64::from(lower[a]));
    x * y + y * z + z * x
}

impl Node {
    fn corner(&self, row: usize, slot: usize) -> [f32; 3] {
        std::array::from_fn(|a| self.planes[row + a][slot])
    }

    fn slots(&self) -> impl Iterator<Item = usize> {
        (0..WIDTH).filter(|slot| self.planes[0][*slot] <= self.planes[3][*slot])
    }

    /// Half the area of the box around all children.
    fn area(&self) -> f64 {
        let all = |row: usize, pick: fn(f32, f32) -> f32| {
            let corners = self.slots().map(|slot| self.corner(row, slot));
            corners.reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i]))).unwrap_or([0.0; 3])
        };
        area(all(0, f32::min), all(3, f32::max))
    }
}

impl Tree {
    /// Nodes visited and items tested by a line that meets the tree somewhere, whatever it meets: by the areas of their boxes. 0 without nodes.
    pub fn cost(&self) -> [f64; 2] {
        let Some(whole) = self.nodes.first().map(Node::area).filter(|area| *area > 0.0) else {
            return [0.0; 2];
        };
        let tests = |node: &Node| {
            let leaf =
                |slot| area(node.corner(0, slot), node.corner(3, slot)) * node.children[slot].count() as f64;
            node.slots().map(leaf).sum::<f64>()
        };
        [
            self.nodes.iter().map(Node::area).sum::<f64>() / whole,
            self.nodes.iter().map(tests).sum::<f64>() / whole,
        ]
    }

    /// Memory of the nodes, and of the order of items, in bytes.
    pub fn bytes(&self) -> [usize; 2] {
        [size_of_val(&*self.nodes), size_of_val(&*self.order)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Aabb;
    use crate::math::random::Random;
    use glam::DVec3;

    /// 960 boxes in a unit cube and 64 in one of 100.
    fn uneven() -> Vec<Aabb> {
        let mut random = Random::new(4);
        let boxes = (0..1024).map(|i| {
            let size = if i < 960 { 1.0 } else { 100.0 };
            let at = DVec3::from_array(std::array::from_fn(|_| random.unit() * size));
            Aabb { min: at, max: at + DVec3::splat(0.01 * size) }
        });
        boxes.collect()
    }

    #[test]
    fn areas_make_a_cheaper_tree_than_halves_by_number() {
        let boxes = uneven();
        let total = |tree: Tree| tree.cost().iter().sum::<f64>();
        let by_area = total(Tree::build(boxes.len(), |i| boxes[i]));
        let by_number = total(Tree::build_median(boxes.len(), |i| boxes[i]));
        assert!(by_area <= 0.7 * by_number, "{by_area} against {by_number}");
    }

    #[test]
    fn the_cost_of_one_node_is_that_of_its_leaves() {
        let unit = |x: f64| Aabb { min: DVec3::X * x, max: DVec3::X * x + 1.0 };
        let tree = Tree::build(2, |i| unit(9.0 * i as f64));
        // Boxes of area 6 in one of 42: a node, and one test of each by a seventh of all lines.
        let [nodes, tests] = tree.cost();
        assert!((nodes - 1.0).abs() < 1e-6 && (tests - 2.0 / 7.0).abs() < 1e-5, "{nodes} {tests}");
    }
}
