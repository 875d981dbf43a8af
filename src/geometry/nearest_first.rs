//! The walk of a line through a tree, nearer children first: one for trees of boxes and of balls. Knows nothing of what is in them.

/// Most nodes that wait at a time: one for each level, and parts are halved in number at each, of which there are less than 2³².
const STACK: usize = 40;

/// A node of a tree.
pub(super) enum Branch<L> {
    /// Parts.
    Leaf(L),
    /// Two nodes, by their numbers.
    Fork(u32, u32),
}

/// Visits the leaves that a line enters, near ones first, from node 0. `entry` says where the line enters a node, if it does before the far end;
/// `visit` is given a leaf and the far end and returns the new one.
#[inline]
pub(super) fn walk<L>(
    mut far: f64,
    entry: impl Fn(u32, f64) -> Option<f64>,
    branch: impl Fn(u32) -> Branch<L>,
    mut visit: impl FnMut(L, f64) -> f64,
) {
    let Some(first) = entry(0, far) else { return };
    let mut stack = [(0u32, first); STACK];
    let mut height = 1;
    while height > 0 {
        height -= 1;
        let (index, t) = stack[height];
        if t > far {
            continue;
        }
        match branch(index) {
            Branch::Leaf(leaf) => far = visit(leaf, far),
            Branch::Fork(a, b) => {
                let (ta, tb) = (entry(a, far), entry(b, far));
                let farther_first = match (ta, tb) {
                    (Some(x), Some(y)) if x > y => [(a, ta), (b, tb)],
                    _ => [(b, tb), (a, ta)],
                };
                for (index, t) in farther_first {
                    if let Some(t) = t {
                        stack[height] = (index, t);
                        height += 1;
                    }
                }
            }
        }
    }
}
