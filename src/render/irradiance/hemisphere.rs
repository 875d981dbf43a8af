//! Light gathered over a hemisphere in even parts, and how it changes as the surface turns and moves: Ward & Heckbert,
//! *Irradiance Gradients* (1992), §3. Knows nothing of surfaces or of who looked.
//!
//! About a normal z, ring j of M holds the directions with sin²θ in [j/M, (j + 1)/M], sector k of N those with φ in
//! 2π [k/N, (k + 1)/N]: every cell has the same cosine-weighted solid angle π/(MN).

use crate::math::elementary::{asin, sin_cos};
use crate::scene::Rgb;
use crate::world::light::cosine_hemisphere;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// How a hemisphere is cut into cells. Cell i is ring i mod M of sector i / M.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hemisphere {
    rings: u32,
    sectors: u32,
}

/// What was seen through a cell.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Linear RGB, as far as it counts.
    pub radiance: Rgb,
    /// To where it came from; infinite where nothing was met. The harmonic mean, if through several rays.
    pub distance: f64,
    /// The least distance.
    pub nearest: f64,
}

/// A vector for each colour: by how much irradiance grows along it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gradient([DVec3; 3]);

/// The light on a surface from all directions.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Irradiance.
    pub irradiance: Rgb,
    /// Its change as the normal n turns to n′: along n′ − n.
    pub by_turning: Gradient,
    /// Its change as the point moves, per unit length. Along the surface.
    pub by_moving: Gradient,
    /// Harmonic mean of all distances; infinite where nothing was met.
    pub mean_distance: f64,
    /// The least of the distances.
    pub nearest: f64,
}

impl Gradient {
    /// Grows along a unit vector by so much more.
    pub fn add(&mut self, direction: DVec3, by: Rgb) {
        self.0.iter_mut().zip(by.to_array()).for_each(|(g, by)| *g += direction * by);
    }

    /// What a step changes.
    pub fn along(&self, step: DVec3) -> Rgb {
        Rgb::from_array(self.0.map(|g| g.dot(step)))
    }

    /// The steepest change of the mean of the colours, per unit length.
    pub fn steepest(&self) -> f64 {
        ((self.0[0] + self.0[1] + self.0[2]) / 3.0).length()
    }

    /// False where a number is infinite or none.
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|g| g.is_finite())
    }
}

impl Hemisphere {
    /// About so many cells, as long as they are wide: N ≈ πM.
    pub fn of(cells: u32) -> Hemisphere {
        let rings = (f64::from(cells) / PI).sqrt().round().max(1.0);
        Hemisphere { rings: rings as u32, sectors: (PI * rings).round() as u32 }
    }

    /// How many cells there are.
    pub fn cells(self) -> u32 {
        self.rings * self.sectors
    }

    /// A direction in a cell, by u in (0, 1)², about z.
    pub fn direction(self, cell: u32, u: DVec2) -> DVec3 {
        let (ring, sector) = (f64::from(cell % self.rings), f64::from(cell / self.rings));
        cosine_hemisphere(DVec2::new(
            (ring + u.x) / f64::from(self.rings),
            (sector + u.y) / f64::from(self.sectors),
        ))
    }

    /// What all cells bring, in their order, in the frame of x and y beside the normal.
    pub fn gathered(self, seen: &[Seen], (x, y): (DVec3, DVec3)) -> Gathered {
        let (m, n) = (self.rings as usize, self.sectors as usize);
        let share = PI / (m * n) as f64;
        let rings: Vec<Ring> = (0..m).map(|j| Ring::new(j, m)).collect();
        let mut all = Gathered {
            irradiance: Rgb::ZERO,
            by_turning: Gradient::default(),
            by_moving: Gradient::default(),
            mean_distance: 0.0,
            nearest: f64::INFINITY,
        };
        let mut nearness = 0.0;
        for k in 0..n {
            let toward = |turn: f64| {
                let (s, c) = sin_cos(TAU * turn / n as f64);
                x * c + y * s
            };
            let (middle, edge) = (toward(k as f64 + 0.5), toward(k as f64 + 0.25 * n as f64));
            let (sector, before) = (&seen[k * m..][..m], &seen[(k + n - 1) % n * m..][..m]);
            for (j, ring) in rings.iter().enumerate() {
                let cell = &sector[j];
                all.irradiance += cell.radiance * share;
                all.nearest = all.nearest.min(cell.nearest);
                nearness += 1.0 / cell.distance;
                all.by_turning.add(middle, cell.radiance * (share * ring.tangent));
                if j > 0 {
                    let passed = across(&sector[j - 1], cell) * (ring.inner * (TAU / n as f64));
                    all.by_moving.add(middle, passed);
                }
                all.by_moving.add(edge, across(&before[j], cell) * ring.width);
            }
        }
        all.mean_distance = (m * n) as f64 / nearness;
        all
    }
}

/// What a ring's cells are weighed by.
struct Ring {
    /// The mean of tan θ over a cell.
    tangent: f64,
    /// sin θ cos²θ at the inner edge: how fast light passes it, for each angle around and each nearness.
    inner: f64,
    /// The same of the edges between sectors: the sine of the outer angle less that of the inner.
    width: f64,
}

impl Ring {
    fn new(j: usize, of: usize) -> Ring {
        let squared = |j: usize| j as f64 / of as f64;
        let sines = [squared(j).sqrt(), squared(j + 1).sqrt()];
        let cosines = [(1.0 - squared(j)).sqrt(), (1.0 - squared(j + 1)).sqrt()];
        // ∫ tan θ d(sin²θ) = θ − sin θ cos θ.
        let area = |i: usize| asin(sines[i]) - sines[i] * cosines[i];
        Ring {
            tangent: of as f64 * (area(1) - area(0)),
            inner: sines[0] * cosines[0] * cosines[0],
            width: sines[1] - sines[0],
        }
    }
}

/// What a step across the edge of two cells gains, per angle: the edge is that of what is nearer.
fn across(from: &Seen, to: &Seen) -> Rgb {
    (to.radiance - from.radiance) / from.distance.min(to.distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: DVec3 = DVec3::X;
    const Y: DVec3 = DVec3::Y;

    fn gathered(cells: u32, look: impl Fn(DVec3) -> (f64, f64)) -> Gathered {
        let hemisphere = Hemisphere::of(cells);
        let seen: Vec<Seen> = (0..hemisphere.cells())
            .map(|cell| look(hemisphere.direction(cell, DVec2::splat(0.5))))
            .map(|(radiance, distance)| Seen { radiance: Rgb::splat(radiance), distance, nearest: distance })
            .collect();
        hemisphere.gathered(&seen, (X, Y))
    }

    #[test]
    fn even_light_is_pi_times_as_much_and_does_not_change() {
        let even = gathered(200, |_| (1.0, 2.0));
        assert!((even.irradiance.x - PI).abs() < 1e-12 && (even.mean_distance - 2.0).abs() < 1e-12);
        assert!(even.by_moving.steepest() < 1e-12 && even.by_turning.steepest() < 1e-12);
        assert!(gathered(200, |_| (1.0, f64::INFINITY)).mean_distance.is_infinite());
    }

    #[test]
    fn light_that_grows_one_way_grows_as_the_normal_turns_there() {
        // L = 1 + b·ω: E = π + 2π/3 b·n, whatever n is.
        let b = DVec3::new(0.3, -0.2, 0.4);
        let found = gathered(4000, |w| (1.0 + b.dot(w), 1.0));
        assert!((found.irradiance.x - (PI + TAU / 3.0 * b.z)).abs() < 2e-3);
        for (step, exact) in [(X, 0.3), (Y, -0.2)] {
            let by = found.by_turning.along(step).x;
            assert!((by - TAU / 3.0 * exact).abs() < 2e-3, "{by} along {step}");
        }
    }

    /// The light of an even sky on a floor before a black wall of height 1 without end, as far from it as `d`, of E₀ = π.
    fn wall(d: f64) -> impl Fn(DVec3) -> (f64, f64) {
        move |w: DVec3| match w.x < 0.0 && -w.z / w.x * d < 1.0 {
            true => (0.0, -d / w.x),
            false => (1.0, f64::INFINITY),
        }
    }

    #[test]
    fn light_before_a_wall_grows_as_its_closed_form_does() {
        for d in [0.5f64, 1.0, 2.0] {
            let found = gathered(100_000, wall(d));
            let length = (d * d + 1.0).sqrt();
            let (exact, slope) = (PI * 0.5 * (1.0 + d / length), PI * 0.5 / (length * length * length));
            assert!((found.irradiance.x - exact).abs() < 3e-3 * exact, "{d}: {} {exact}", found.irradiance.x);
            let by = found.by_moving.along(X).x;
            assert!((by - slope).abs() < 0.015 * slope, "{d}: {by}, truly {slope}");
            assert!(found.by_moving.along(Y).x.abs() < 1e-9);
        }
    }
}
