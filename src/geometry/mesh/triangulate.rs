//! Polygons cut into triangles along their inner diagonals: concave ones are not fanned.

use super::doubled_area;
use glam::{DVec2, DVec3};

/// Cuts polygons; keeps its buffers from one to the next.
#[derive(Default)]
pub struct Triangulator {
    points: Vec<DVec3>,
    flat: Vec<[f64; 2]>,
    earcut: earcut::Earcut<f64>,
    indices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    used: Vec<bool>,
}

impl Triangulator {
    /// The triangles of a polygon of at least three corners, as corner numbers from 0, turning as the polygon turns. Every
    /// corner that lies on the outline is kept, so that neighbours share it. A polygon that is not flat is cut as it appears
    /// along the axis nearest to its mean normal; one without a mean normal is fanned.
    pub fn polygon(&mut self, points: impl IntoIterator<Item = DVec3>) -> &[[u32; 3]] {
        self.points.clear();
        self.points.extend(points);
        self.triangles.clear();
        match self.points.len() {
            0..3 => {}
            3 => self.triangles.push([0, 1, 2]),
            4 => {
                self.triangles.extend(quad([self.points[0], self.points[1], self.points[2], self.points[3]]))
            }
            _ => self.clip_ears(),
        }
        &self.triangles
    }

    /// Seen along an axis first, which is exact; a polygon that is bent can overlap itself there, and is then seen along its
    /// mean normal too, and the finer cut taken.
    fn clip_ears(&mut self) {
        let normal = newell(&self.points);
        self.clip_ears_seen_by(|p| along_axis(p, normal));
        let wanted = self.points.len() - 2;
        if self.triangles.len() < wanted && normal.is_finite() && normal != DVec3::ZERO {
            let along_axis = std::mem::take(&mut self.triangles);
            let (u, v) = normal.normalize_or(DVec3::Z).any_orthonormal_pair();
            self.clip_ears_seen_by(|p| [p.dot(u), p.dot(v)]);
            if self.triangles.len() <= along_axis.len() {
                self.triangles = along_axis;
            }
        }
        if self.triangles.is_empty() {
            self.triangles.extend((2..self.points.len() as u32).map(|i| [0, i - 1, i]));
        }
    }

    fn clip_ears_seen_by(&mut self, flatten: impl Fn(DVec3) -> [f64; 2]) {
        self.flat.clear();
        self.flat.extend(self.points.iter().map(|p| flatten(*p - self.points[0])));
        self.earcut.earcut_slice(&self.flat, &[], &mut self.indices);
        for t in self.indices.chunks_exact(3) {
            let turns_right = cross(self.flat_triangle([t[0], t[1], t[2]])) < 0.0;
            self.triangles.push(if turns_right { [t[0], t[2], t[1]] } else { [t[0], t[1], t[2]] });
        }
        self.put_back_dropped_corners();
    }

    /// Ear clipping drops corners in the middle of straight edges; without them a neighbour's edge would only touch this one.
    fn put_back_dropped_corners(&mut self) {
        self.used.clear();
        self.used.resize(self.points.len(), false);
        self.triangles.iter().flatten().for_each(|&i| self.used[i as usize] = true);
        let mut at = 0;
        while at < self.triangles.len() {
            match self.dropped_edge(self.triangles[at]) {
                Some(([a, b, apex], first)) => self.split(at, a, b, apex, first),
                None => at += 1,
            }
        }
    }

    /// A side (a, b) of a triangle that passes over a dropped corner next to a, with the third corner and the dropped one.
    fn dropped_edge(&self, [i, j, k]: [u32; 3]) -> Option<([u32; 3], u32)> {
        let n = self.points.len() as u32;
        [[i, j, k], [j, k, i], [k, i, j]].into_iter().find_map(|side| {
            let dropped = (side[0] + 1) % n;
            let run = (1..n).map(|step| (side[0] + step) % n).find(|&c| self.used[c as usize])?;
            let is_run = !self.used[dropped as usize] && run == side[1];
            (is_run && self.is_between(dropped, side[0], side[1])).then_some((side, dropped))
        })
    }

    fn is_between(&self, corner: u32, a: u32, b: u32) -> bool {
        let [p, a, b] = [corner, a, b].map(|i| DVec2::from(self.flat[i as usize]));
        let along = (p - a).dot(b - a);
        along > 0.0 && along < (b - a).length_squared()
    }

    fn split(&mut self, at: usize, a: u32, b: u32, apex: u32, corner: u32) {
        self.used[corner as usize] = true;
        self.triangles[at] = [a, corner, apex];
        self.triangles.push([corner, b, apex]);
    }

    fn flat_triangle(&self, triangle: [u32; 3]) -> [DVec2; 3] {
        triangle.map(|i| DVec2::from(self.flat[i as usize]))
    }
}

/// A quadrilateral cut along a diagonal that lies inside it: the first, where both do.
fn quad(p: [DVec3; 4]) -> [[u32; 3]; 2] {
    let normal = newell(&p);
    let turns_left = |t: [u32; 3]| doubled_area(t.map(|i| p[i as usize])).dot(normal) > 0.0;
    let (first, second) = ([[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]]);
    if !first.into_iter().all(turns_left) && second.into_iter().all(turns_left) { second } else { first }
}

/// A polygon's mean normal, twice as long as its area seen along it (Newell). Taken from the first corner, so that a polygon
/// far from the origin loses nothing.
fn newell(points: &[DVec3]) -> DVec3 {
    points.windows(2).skip(1).map(|w| (w[0] - points[0]).cross(w[1] - points[0])).sum()
}

/// The two coordinates that are seen along the largest component of the normal, such that the polygon turns left.
fn along_axis(p: DVec3, normal: DVec3) -> [f64; 2] {
    let size = normal.abs();
    let (u, v, along) = if size.x >= size.y && size.x >= size.z {
        (p.y, p.z, normal.x)
    } else if size.y >= size.z {
        (p.z, p.x, normal.y)
    } else {
        (p.x, p.y, normal.z)
    };
    if along < 0.0 { [v, u] } else { [u, v] }
}

fn cross([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}
