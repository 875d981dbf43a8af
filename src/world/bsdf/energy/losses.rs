//! What the single bounce of one rough boundary loses, found by adding up facets: for glass whose roughness and index are the same
//! everywhere. A ray inside a dense ball meets its boundary dozens of times, and what a table for all glass is wrong by adds up.

use super::place;
use crate::scene::Fresnel;
use crate::world::bsdf::fresnel::{dielectric, dielectric_schlick, reflect, refract};
use crate::world::bsdf::lobes::Ggx;
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::sync::{LazyLock, Mutex, OnceLock, PoisonError};

/// Values of a curve, over μ = tα / (1 + α − t), t = (i/63)².
const NODES: usize = 64;

/// Facets of each value.
const FACETS: u32 = 1 << 12;

/// Cosines by which a mean is taken.
const COSINES: u32 = 4096;

/// Losses of one boundary, each curve found when it is first asked for.
#[derive(Debug)]
pub struct Losses {
    alpha: f64,
    /// Index of the denser side over the rarer.
    denser: f64,
    law: Fresnel,
    curves: [OnceLock<Curve>; 3],
}

/// Curves of a boundary: seen from the rarer side, from the denser, and as if it reflected all.
pub const RARER: usize = 0;
/// See [`RARER`].
pub const DENSER: usize = 1;
/// See [`RARER`].
pub const SILVERED: usize = 2;

/// 1 − E(μ) by cosines, and its mean by the cosine.
#[derive(Debug)]
struct Curve {
    at: [f64; NODES],
    mean: f64,
}

/// What makes a boundary: α, the index of the denser side over the rarer (their bits), and whether by Schlick.
type Key = (u64, u64, bool);

static KNOWN: LazyLock<Mutex<HashMap<Key, &'static Losses>>> = LazyLock::new(Mutex::default);

impl Losses {
    /// Of a boundary of this α > 0 and index; kept as long as the program runs, since scenes have few and frames have them again.
    pub fn of(alpha: f64, ior: f64, law: Fresnel) -> &'static Losses {
        let denser = if ior < 1.0 { 1.0 / ior } else { ior };
        let key = (alpha.to_bits(), denser.to_bits(), law == Fresnel::Schlick);
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        known
            .entry(key)
            .or_insert_with(|| Box::leak(Box::new(Losses { alpha, denser, law, curves: Default::default() })))
    }

    /// 1 − E(μ) of one of the curves.
    pub fn at(&self, curve: usize, cosine: f64) -> f64 {
        self.curve(curve).at(place(self.alpha, cosine, NODES))
    }

    /// Its mean.
    pub fn on_average(&self, curve: usize) -> f64 {
        self.curve(curve).mean
    }

    fn curve(&self, curve: usize) -> &Curve {
        self.curves[curve].get_or_init(|| {
            Curve::new(self.alpha, |ggx, wo, facet| match curve {
                RARER => self.left(self.denser, ggx, wo, facet),
                DENSER => self.left(1.0 / self.denser, ggx, wo, facet),
                _ => ggx.carried(wo.z, reflect(wo, facet).z),
            })
        })
    }

    /// What a facet mirrors and lets through of light seen from a direction, by the index beyond it.
    fn left(&self, eta: f64, ggx: Ggx, wo: DVec3, facet: DVec3) -> f64 {
        let cosine = wo.dot(facet).clamp(0.0, 1.0);
        let share = match self.law {
            Fresnel::Schlick => dielectric_schlick(cosine, eta),
            Fresnel::Exact | Fresnel::None => dielectric(cosine, eta),
        };
        let through = refract(wo, facet, eta).map_or(0.0, |wi| ggx.carried(wo.z, -wi.z));
        share * ggx.carried(wo.z, reflect(wo, facet).z) + (1.0 - share) * through
    }
}

impl Curve {
    /// By what is left of light seen from a direction by a facet.
    fn new(alpha: f64, left: impl Fn(Ggx, DVec3, DVec3) -> f64) -> Curve {
        let ggx = Ggx { n: DVec3::Z, alpha };
        let lost = |i: usize| {
            let root = i as f64 / (NODES - 1) as f64;
            let t = root * root;
            let cosine = (t * alpha / (1.0 + alpha - t)).clamp(f64::EPSILON, 1.0);
            let wo = DVec3::new(((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, cosine);
            let sum: f64 = (0..FACETS).map(|k| left(ggx, wo, ggx.visible_normal(wo, lattice(k)))).sum();
            (1.0 - sum / f64::from(FACETS)).max(0.0)
        };
        let mut curve = Curve { at: std::array::from_fn(lost), mean: 0.0 };
        // Most of a curve lies near the horizon.
        let weighed = |i| {
            let v = (f64::from(i) + 0.5) / f64::from(COSINES);
            curve.at(place(alpha, v * v, NODES)) * (4.0 * v * v * v)
        };
        curve.mean = (0..COSINES).map(weighed).sum::<f64>() / f64::from(COSINES);
        curve
    }

    fn at(&self, (i, part): (usize, f64)) -> f64 {
        self.at[i] + part * (self.at[i + 1] - self.at[i])
    }
}

/// Points of the unit square that lie evenly, and in no rows: where light is reflected as a whole, a curve has edges.
fn lattice(k: u32) -> DVec2 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    DVec2::new((f64::from(k) * GOLDEN).fract(), (f64::from(k) + 0.5) / f64::from(FACETS))
}
