//! Surfaces along curves as triangles, for what must have vertices: skins. One grid maker for all. Knows nothing of joints or pictures.
//!
//! Steps along a curve and around follow from second differences and radii, so that no triangle is farther from its surface than the tolerance, up to the
//! bend of the frame between two steps. Grids that meet share positions to the bit, vertices they do not.

use super::SurfacePoint;
use crate::geometry::mesh::{Mesh, Triangulator};
use glam::DVec3;

/// Fewest and most steps around a circle, and most along a piece.
const AROUND: (f64, f64) = (8.0, 512.0);
const MOST_ALONG: f64 = 256.0;

/// Equal steps around a circle that keep a tolerance: the sagitta of each is r (1 − cos π/n).
pub(super) fn steps_around(radius: f64, tolerance: f64) -> usize {
    let share = (tolerance / radius).clamp(0.0, 1.0);
    // cos π/n = 1 − share: π/n is about √(2 share), and never less.
    (std::f64::consts::PI / (2.0 * share).sqrt()).clamp(AROUND.0, AROUND.1).ceil() as usize
}

/// Equal steps along a piece that keep a tolerance, given the largest second derivative over it.
pub(super) fn steps_along(second: f64, tolerance: f64) -> usize {
    (second / (8.0 * tolerance)).sqrt().clamp(1.0, MOST_ALONG).ceil() as usize
}

/// k/n for k in 0..=n.
pub(super) fn even(n: usize) -> impl Iterator<Item = f64> {
    (0..=n).map(move |k| k as f64 / n as f64)
}

/// Adds a grid of `rows` by `columns` points, at least two of each, facing the way of their normals. Triangles without area are left out.
pub(super) fn grid(mesh: &mut Mesh, rows: usize, columns: usize, at: impl Fn(usize, usize) -> SurfacePoint) {
    let first = mesh.positions.len() as u32;
    for k in 0..rows * columns {
        push(mesh, &at(k / columns, k % columns));
    }
    let vertex = |i: usize, j: usize| first + (i * columns + j) as u32;
    for i in 1..rows {
        for j in 1..columns {
            let (a, b) = (vertex(i - 1, j - 1), vertex(i - 1, j));
            let (c, d) = (vertex(i, j - 1), vertex(i, j));
            triangle(mesh, [a, c, b]);
            triangle(mesh, [b, c, d]);
        }
    }
}

/// Adds a flat face with this outline, all with one normal; (u, v) are given.
pub(super) fn face(mesh: &mut Mesh, outline: &[SurfacePoint]) {
    let first = mesh.positions.len() as u32;
    let mut triangulator = Triangulator::default();
    let triangles = triangulator.polygon(outline.iter().map(|p| p.point)).to_vec();
    outline.iter().for_each(|p| push(mesh, p));
    triangles.into_iter().for_each(|t| triangle(mesh, t.map(|k| first + k)));
}

fn push(mesh: &mut Mesh, p: &SurfacePoint) {
    mesh.positions.push(p.point);
    mesh.normals.push(p.normal);
    mesh.uvs.push(p.uv);
}

/// Adds a triangle, turned to the side of its normals.
fn triangle(mesh: &mut Mesh, [a, b, c]: [u32; 3]) {
    let [p, q, r] = [a, b, c].map(|k| mesh.positions[k as usize]);
    if p == q || q == r || r == p {
        return;
    }
    let normal: DVec3 = [a, b, c].into_iter().map(|k| mesh.normals[k as usize]).sum();
    let is_turned = (q - p).cross(r - p).dot(normal) < 0.0;
    mesh.triangles.push(if is_turned { [a, c, b] } else { [a, b, c] });
}

#[cfg(test)]
mod tests {
    use super::super::cubic::{Cubic, of_curve};
    use super::super::lathe::Lathe;
    use super::super::outline::Outline;
    use super::super::prism::{Placing, Prism};
    use super::super::sweep::Sweep;
    use super::super::tube::{Caps, Tube};
    use super::*;
    use crate::geometry::boxes::Line;
    use crate::geometry::curve::{CatmullRom, Curve, Ends};
    use glam::DVec2;
    use std::f64::consts::{PI, TAU};

    /// Distances from the middles of all triangles to the surface, along their normals, which point out of it.
    fn assert_true_to(mesh: &Mesh, bar: f64, meetings: impl Fn(&Line) -> Vec<f64>) {
        assert!(mesh.triangles.len() > 8);
        assert_eq!(mesh.positions.len(), mesh.normals.len());
        for t in &mesh.triangles {
            let [p, q, r] = t.map(|k| mesh.positions[k as usize]);
            let flat = (q - p).cross(r - p);
            let smooth: DVec3 = t.iter().map(|k| mesh.normals[*k as usize]).sum();
            assert!(flat.dot(smooth) >= 0.0);
            let middle = (p + q + r) / 3.0;
            let line = Line::new(middle, smooth).unwrap();
            let nearest = meetings(&line).into_iter().fold(f64::INFINITY, |m, s| m.min(s.abs()));
            assert!(nearest <= bar, "{nearest} at {middle}");
        }
    }

    fn still(r: f64) -> Vec<Cubic<f64>> {
        vec![Cubic { start: 0.0, end: 1.0, points: [r; 4] }]
    }

    fn blob() -> Outline {
        let points = [[1.0, 0.0], [0.8, 1.0], [-0.5, 0.4], [-1.0, -0.2], [-0.4, -1.0], [0.3, -0.2]];
        Outline::new(of_curve(&Curve::bspline(&points.map(DVec2::from), Ends::Closed, None).unwrap()))
            .unwrap()
    }

    #[test]
    fn tubes_keep_the_tolerance_and_their_volume() {
        let tolerance = 0.01;
        let points = [[0.0, 0.0, 0.0], [2.0, 0.5, 0.0], [4.0, 0.0, 0.5], [6.0, 0.5, 0.0]].map(DVec3::from);
        let path = of_curve(&Curve::catmull_rom(&points, CatmullRom::default(), None, false).unwrap());
        let radius = of_curve(&Curve::bezier(&[0.5, 0.2, 0.7, 0.4], None, false).unwrap());
        for caps in [Caps::Round, Caps::Flat] {
            let tube = Tube::new(&path, &radius, false, caps).unwrap();
            let along = |line: &Line| tube.all(line).iter().map(|h| h.t * line.length).collect();
            // A flat end of a tube that widens is cut a little smaller.
            assert_true_to(&tube.mesh(tolerance), if caps == Caps::Flat { 0.05 } else { tolerance }, along);
        }
        let straight = [0.0, 1.0, 2.0, 3.0].map(|x| DVec3::X * x);
        let capsule = [Cubic { start: 0.0, end: 1.0, points: straight }];
        let volume = Tube::new(&capsule, &still(1.0), false, Caps::Round).unwrap().mesh(1e-4).volume();
        assert!((volume - PI * (3.0 + 4.0 / 3.0)).abs() < 0.01, "{volume}");
        let flat = Tube::new(&capsule, &still(1.0), false, Caps::Flat).unwrap().mesh(1e-4).volume();
        assert!((flat - PI * 3.0).abs() < 0.01, "{flat}");
    }

    #[test]
    fn lathes_keep_the_tolerance_and_their_volume() {
        let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [1.0, 2.0], [0.5, 2.25], [0.5, 3.0], [0.0, 3.0]];
        let profile = of_curve(&Curve::bezier(&points.map(DVec2::from), None, false).unwrap());
        let whole = Lathe::new(&profile, false, None).unwrap();
        let mesh = whole.mesh(0.01);
        assert_true_to(&mesh, 0.01, |line| whole.all(line).iter().map(|h| h.t * line.length).collect());
        let third = Lathe::new(&profile, false, Some(TAU / 3.0)).unwrap().mesh(1e-3);
        let fine = whole.mesh(1e-3).volume();
        assert!((third.volume() - fine / 3.0).abs() < 1e-2 * fine, "{} {fine}", third.volume());
    }

    #[test]
    fn prisms_and_sweeps_keep_the_tolerance_and_their_volume() {
        let prism = Prism::new(blob(), Placing::across(DVec3::Z).unwrap(), 3.0);
        let mesh = prism.mesh(0.01);
        assert_true_to(&mesh, 0.01, |line| prism.all(line).iter().map(|h| h.t * line.length).collect());
        let area: f64 = blob().pieces().iter().map(Cubic::<DVec2>::area).sum();
        let volume = prism.mesh(1e-5).volume();
        assert!((volume - 3.0 * area.abs()).abs() < 1e-3, "{volume} {area}");
        let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 2.0], [2.0, 1.0, 5.0], [5.0, 1.0, 5.0]].map(DVec3::from);
        let sweep = Sweep::new(blob(), &Curve::bezier(&points, None, false).unwrap()).unwrap();
        let mesh = sweep.mesh(0.01);
        assert_true_to(&mesh, 0.01, |line| sweep.all(line).iter().map(|h| h.t * line.length).collect());
        assert!(mesh.volume() > 0.0);
    }
}
