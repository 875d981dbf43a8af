//! What the single bounce of rough glass loses, and where further bounces take it: Kulla & Conty (2017) for both sides of a boundary. Knows
//! no material, only GGX's α, the index, cosines and the share that a silver coat reflects first.
//!
//! Of light seen from one side, 1 − E(μ) is what one facet neither reflects nor lets through past its neighbours. A part c of it is sent back by
//! c (1 − E(μo))(1 − E(μi)) / π(1 − Ē), the others to the far side by (1 − c)(1 − E(μo))(1 − E′(μi)) / π(1 − Ē′), primes for that side.
//! Both ways through are the same but for the squared index where (1 − c)(1 − Ē) = η² (1 − c′)(1 − Ē′), η seen from the rarer
//! side. There c is taken to be the mean share that a facet reflects; so nearly all that the denser side loses is sent back.

use super::losses::{DENSER, RARER, SILVERED};
use super::{Losses, Lost, split};
use crate::scene::Rgb;
use crate::world::bsdf::fresnel;
use std::f64::consts::PI;

/// Rows of the table: α = (j/9)². Columns: μ = (i/11)². Layers: η = (1 + s)/(1 − s), s = k/16, the index of the denser side over the rarer.
const ROWS: usize = 10;
const COLUMNS: usize = 12;
const LAYERS: usize = 9;

/// Further bounces at a boundary, seen from one side.
#[derive(Clone, Copy, Debug)]
pub struct Glass {
    known: Known,
    /// Of the side it is seen from: 0 the rarer, 1 the denser.
    side: usize,
    silver: Rgb,
    /// 1 − c.
    through: Rgb,
}

/// What is lost, by its own sums or by the table.
#[derive(Clone, Copy, Debug)]
enum Known {
    Own(&'static Losses),
    Table { cell: Cell, silvered: Lost },
}

/// A roughness and an index, between rows and layers of the table.
#[derive(Clone, Copy, Debug)]
struct Cell {
    row: (usize, f64),
    layer: (usize, f64),
}

impl Glass {
    /// Of this α, for an index beyond the boundary over that on the side it is seen from; `silver` is reflected before all else. Where nothing
    /// else is known, a table tells what is lost, for indices up to 3.
    pub fn new(alpha: f64, eta: f64, silver: Rgb, own: Option<&'static Losses>) -> Glass {
        let (side, denser) = if eta < 1.0 { (DENSER, 1.0 / eta) } else { (RARER, eta) };
        let known = match own {
            Some(losses) => Known::Own(losses),
            None => Known::Table { cell: Cell::of(alpha, denser), silvered: Lost::by(alpha) },
        };
        let silver = silver.clamp(Rgb::ZERO, Rgb::ONE);
        let mut glass = Glass { known, side, silver, through: Rgb::ZERO };
        let mean = silver + (Rgb::ONE - silver) * fresnel::mean_of_dielectric(denser);
        let [rarer, dense] = [RARER, DENSER].map(|side| glass.on_average(side));
        let part = if side == RARER { Rgb::ONE } else { rarer / (dense * (denser * denser)) };
        glass.through = if dense.min_element() > 0.0 { (Rgb::ONE - mean) * part } else { Rgb::ZERO };
        glass
    }

    /// Share of light from all around on this side that further bounces send to a direction of this side.
    pub fn sent_back(&self, cos_o: f64) -> Rgb {
        (Rgb::ONE - self.through) * self.lost(self.side, cos_o)
    }

    /// The same of light from all around beyond.
    pub fn let_through(&self, cos_o: f64) -> Rgb {
        self.through * self.lost(self.side, cos_o)
    }

    /// Further bounces as a lobe on this side, 1/sr, by two cosines to the normal.
    pub fn back(&self, cos_o: f64, cos_i: f64) -> Rgb {
        self.sent_back(cos_o) * self.spread(self.side, cos_i)
    }

    /// As a lobe from beyond; `cos_i` is to the normal of that side. Radiance is not scaled by the squared index.
    pub fn through(&self, cos_o: f64, cos_i: f64) -> Rgb {
        self.let_through(cos_o) * self.spread(1 - self.side, cos_i)
    }

    /// A density over a side, its integral with the cosine 1.
    fn spread(&self, side: usize, cosine: f64) -> Rgb {
        let all = self.on_average(side);
        if all.min_element() > 0.0 { self.lost(side, cosine) / (PI * all) } else { Rgb::ZERO }
    }

    fn lost(&self, side: usize, cosine: f64) -> Rgb {
        let cosine = cosine.clamp(0.0, 1.0);
        self.mixed(side, |curve| match &self.known {
            Known::Own(losses) => losses.at(curve, cosine),
            Known::Table { silvered, .. } if curve == SILVERED => silvered.at(cosine),
            Known::Table { cell, .. } => cell.at(curve, cosine),
        })
    }

    fn on_average(&self, side: usize) -> Rgb {
        self.mixed(side, |curve| match &self.known {
            Known::Own(losses) => losses.on_average(curve),
            Known::Table { silvered, .. } if curve == SILVERED => silvered.on_average(),
            Known::Table { cell, .. } => cell.on_average(curve),
        })
    }

    /// By the curve of a side and, where there is silver, that of what reflects all.
    fn mixed(&self, side: usize, of: impl Fn(usize) -> f64) -> Rgb {
        if self.silver == Rgb::ZERO {
            return Rgb::splat(of(side));
        }
        (Rgb::ONE - self.silver) * of(side) + self.silver * of(SILVERED)
    }
}

impl Cell {
    fn of(alpha: f64, denser: f64) -> Cell {
        let s = ((denser - 1.0) / (denser + 1.0)).min((LAYERS - 1) as f64 / 16.0);
        let layer = split(s * 16.0 / (LAYERS - 1) as f64, LAYERS);
        Cell { row: split(alpha.clamp(0.0, 1.0).sqrt(), ROWS), layer }
    }

    fn at(&self, side: usize, cosine: f64) -> f64 {
        let (i, part) = split(cosine.sqrt(), COLUMNS);
        let along = |row: &[f32; COLUMNS]| f64::from(row[i]) + part * f64::from(row[i + 1] - row[i]);
        self.between(|layer, row| along(&LOST[side][layer][row]))
    }

    fn on_average(&self, side: usize) -> f64 {
        self.between(|layer, row| f64::from(MEAN[side][layer][row]))
    }

    fn between(&self, at: impl Fn(usize, usize) -> f64) -> f64 {
        let mix = |a: f64, b: f64, part: f64| a + part * (b - a);
        let ((row, down), (layer, deep)) = (self.row, self.layer);
        let in_layer = |layer| mix(at(layer, row), at(layer, row + 1), down);
        mix(in_layer(layer), in_layer(layer + 1), deep)
    }
}

include!("table.rs");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Fresnel;
    use crate::world::bsdf::fresnel::{dielectric, reflect, refract};
    use crate::world::bsdf::lobes::Ggx;
    use crate::world::even::grid;
    use glam::DVec3;

    /// What one facet reflects and lets through, by facets chosen evenly.
    fn first(alpha: f64, eta: f64, cosine: f64) -> f64 {
        let (ggx, n) = (Ggx { n: DVec3::Z, alpha }, 400);
        let wo = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let by = |h: DVec3| {
            let share = dielectric(wo.dot(h).clamp(0.0, 1.0), eta);
            let through = refract(wo, h, eta).map_or(0.0, |wi| ggx.carried(cosine, -wi.z));
            share * ggx.carried(cosine, reflect(wo, h).z) + (1.0 - share) * through
        };
        grid(n).map(|u| by(ggx.visible_normal(wo, u))).sum::<f64>() / f64::from(n * n)
    }

    #[test]
    fn nothing_is_lost_from_either_side() {
        for (alpha, ior) in [(0.1, 1.5), (0.2, 1.33), (0.4, 1.5), (0.6, 2.0), (0.85, 1.2), (1.0, 1.5)] {
            let own = Losses::of(alpha, ior, Fresnel::Exact);
            for (eta, cosine) in
                [ior, 1.0 / ior].into_iter().flat_map(|e| [1.0, 0.8, 0.5, 0.2].map(|c| (e, c)))
            {
                for (own, off) in [(None, 0.012), (Some(own), 4e-3)] {
                    let glass = Glass::new(alpha, eta, Rgb::ZERO, own);
                    let further = (glass.sent_back(cosine) + glass.let_through(cosine)).x;
                    let all = first(alpha, eta, cosine) + further;
                    assert!((all - 1.0).abs() < off, "α {alpha}, η {eta}, cos {cosine}: {all}");
                }
            }
        }
    }

    #[test]
    fn lobes_carry_what_they_should_and_the_same_both_ways() {
        let (alpha, eta, silver) = (0.6, 1.5, Rgb::new(0.0, 0.2, 0.9));
        let own = Losses::of(alpha, eta, Fresnel::Exact);
        for own in [None, Some(own)] {
            let sides = [eta, 1.0 / eta].map(|eta| Glass::new(alpha, eta, silver, own));
            lobes_carry_what_they_should(&sides, eta);
        }
    }

    fn lobes_carry_what_they_should([outside, inside]: &[Glass; 2], eta: f64) {
        let n = 2000;
        let over = |lobe: &dyn Fn(f64) -> Rgb| -> Rgb {
            let mu = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n));
            mu.map(|mu| lobe(mu) * (2.0 * PI * mu)).sum::<Rgb>() / f64::from(n)
        };
        for glass in [outside, inside] {
            let (back, through) = (over(&|mu| glass.back(0.4, mu)), over(&|mu| glass.through(0.4, mu)));
            assert!((back - glass.sent_back(0.4)).abs().max_element() < 0.01 * back.max_element());
            assert!((through - glass.let_through(0.4)).abs().max_element() < 0.01 * through.max_element());
            let off = glass.back(0.3, 0.7) - glass.back(0.7, 0.3);
            assert!(off.abs().max_element() < 1e-15);
        }
        let (there, back) = (outside.through(0.3, 0.7), inside.through(0.7, 0.3) * (eta * eta));
        assert!((there - back).abs().max_element() < 1e-12, "{there} and {back}");
    }
}
