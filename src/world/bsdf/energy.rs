//! What a rough mirror's single bounce loses, and what further bounces between its facets bring back: Kulla & Conty, *Revisiting
//! Physically Based Shading at Imageworks* (2017). Knows no material, only GGX's α, cosines and mean Fresnel shares.
//!
//! Of a lobe that reflects all, E(μ) is the share of light that leaves at the first bounce. What is left, 1 − E(μ), is sent on by
//! (1 − E(μo))(1 − E(μi)) / π(1 − Ē): the same both ways, and together with the first bounce it is 1 from everywhere. Facets that reflect a
//! share F̄ on average take their part at every further bounce, by F̄²Ē / (1 − F̄(1 − Ē)).

mod glass;
mod losses;

use crate::scene::Rgb;
pub use glass::Glass;
pub use losses::Losses;
use std::f64::consts::{LN_2, PI};

/// Columns of the table: μ = tα / (1 + α − t), t = (i/23)². What is lost is largest about μ = α and looks alike there for all small α.
const COLUMNS: usize = 24;

/// Rows of the table: α = (j/15)².
const ROWS: usize = 16;

/// How many mean values: twice as close, since the table between two rows is not that of their means.
const MEANS: usize = 2 * ROWS - 1;

/// A roughness, between two rows of the table.
#[derive(Clone, Copy, Debug)]
pub struct Lost {
    alpha: f64,
    row: usize,
    /// How far to the next row, 0 … 1.
    part: f64,
}

impl Lost {
    /// By a lobe of this α, in 0 … 1; beyond it as by 1.
    pub fn by(alpha: f64) -> Lost {
        let alpha = alpha.clamp(0.0, 1.0);
        let (row, part) = split(alpha.sqrt(), ROWS);
        Lost { alpha, row, part }
    }

    /// 1 − E(μ): the share that does not leave at the first bounce; 0 … 1, of a cosine in 0 … 1. Within 0.0025 of the integral.
    pub fn at(&self, cosine: f64) -> f64 {
        if self.alpha <= 0.0 {
            return 0.0;
        }
        let cosine = cosine.clamp(0.0, 1.0);
        let (i, part) = place(self.alpha, cosine, COLUMNS);
        let along = |row: &[f64; COLUMNS]| row[i] + part * (row[i + 1] - row[i]);
        self.between(along(&LOST[self.row]), along(&LOST[self.row + 1]))
    }

    /// 1 − Ē: the mean over all directions by their cosines.
    pub fn on_average(&self) -> f64 {
        let (i, part) = split(self.alpha.sqrt(), MEANS);
        MEAN[i] + part * (MEAN[i + 1] - MEAN[i])
    }

    /// The lobe of all further bounces between facets that reflect `mean` on average (linear RGB, 0 … 1): a BRDF, 1/sr, for two
    /// cosines.
    pub fn lobe(&self, mean: Rgb, cos_o: f64, cos_i: f64) -> Rgb {
        let all = self.on_average();
        if all <= 0.0 {
            return Rgb::ZERO;
        }
        self.share(mean) * (self.at(cos_o) * self.at(cos_i) / (PI * all))
    }

    /// What is sent on of the light that the first bounce loses.
    pub fn share(&self, mean: Rgb) -> Rgb {
        let lost = self.on_average();
        mean * mean * (1.0 - lost) / (Rgb::ONE - mean * lost)
    }

    fn between(&self, row: f64, next: f64) -> f64 {
        row + self.part * (next - row)
    }
}

/// Where a cosine lies among `n` points over μ = tα / (1 + α − t), t = (i/(n − 1))².
fn place(alpha: f64, cosine: f64, n: usize) -> (usize, f64) {
    split((cosine * (1.0 + alpha) / (cosine + alpha)).sqrt(), n)
}

/// The cell of `n` points over 0 … 1 that holds x, and how far in it x is.
fn split(x: f64, n: usize) -> (usize, f64) {
    let x = x * (n - 1) as f64;
    let i = (x as usize).min(n - 2);
    (i, x - i as f64)
}

/// 1 − E(μ), by rows of α and columns of μ; each the mean over 250,000 facets, the smallest α without any loss.
#[rustfmt::skip]
const LOST: [[f64; COLUMNS]; ROWS] = [
    [0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000,
     0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000, 0.00000],
    [0.00000, 0.00047, 0.00159, 0.00362, 0.00649, 0.01025, 0.01496, 0.02067, 0.02745, 0.03535, 0.04440, 0.05456,
     0.06569, 0.07743, 0.08910, 0.09950, 0.10675, 0.10820, 0.10076, 0.08226, 0.05423, 0.02483, 0.00558, 0.00000],
    [0.00000, 0.00039, 0.00157, 0.00358, 0.00640, 0.01012, 0.01477, 0.02040, 0.02709, 0.03488, 0.04380, 0.05383,
     0.06482, 0.07647, 0.08811, 0.09865, 0.10628, 0.10850, 0.10228, 0.08526, 0.05831, 0.02857, 0.00747, 0.00000],
    [0.00000, 0.00039, 0.00156, 0.00354, 0.00634, 0.01001, 0.01460, 0.02017, 0.02676, 0.03444, 0.04323, 0.05312,
     0.06398, 0.07553, 0.08720, 0.09798, 0.10625, 0.10966, 0.10533, 0.09067, 0.06560, 0.03562, 0.01172, 0.00202],
    [0.00000, 0.00040, 0.00159, 0.00362, 0.00648, 0.01023, 0.01491, 0.02058, 0.02729, 0.03511, 0.04407, 0.05403,
     0.06468, 0.07607, 0.08770, 0.09872, 0.10770, 0.11258, 0.11064, 0.09917, 0.07706, 0.04774, 0.02072, 0.00624],
    [0.00000, 0.00043, 0.00175, 0.00396, 0.00709, 0.01119, 0.01631, 0.02244, 0.02908, 0.03679, 0.04561, 0.05554,
     0.06653, 0.07803, 0.08986, 0.10139, 0.11143, 0.11809, 0.11883, 0.11108, 0.09290, 0.06553, 0.03597, 0.01455],
    [0.00000, 0.00052, 0.00210, 0.00476, 0.00852, 0.01336, 0.01852, 0.02476, 0.03213, 0.04042, 0.04962, 0.05997,
     0.07103, 0.08299, 0.09528, 0.10748, 0.11853, 0.12698, 0.13080, 0.12723, 0.11398, 0.09032, 0.05989, 0.03238],
    [0.00000, 0.00068, 0.00275, 0.00623, 0.01077, 0.01583, 0.02212, 0.02927, 0.03742, 0.04646, 0.05655, 0.06752,
     0.07935, 0.09195, 0.10504, 0.11817, 0.13058, 0.14106, 0.14791, 0.14885, 0.14124, 0.12302, 0.09487, 0.06284],
    [0.00000, 0.00094, 0.00378, 0.00841, 0.01347, 0.02007, 0.02739, 0.03583, 0.04525, 0.05561, 0.06688, 0.07907,
     0.09212, 0.10587, 0.12015, 0.13462, 0.14868, 0.16146, 0.17157, 0.17713, 0.17567, 0.16455, 0.14209, 0.11006],
    [0.00000, 0.00132, 0.00528, 0.01070, 0.01756, 0.02549, 0.03462, 0.04483, 0.05599, 0.06813, 0.08118, 0.09511,
     0.10985, 0.12530, 0.14131, 0.15761, 0.17377, 0.18914, 0.20272, 0.21304, 0.21804, 0.21513, 0.20150, 0.17548],
    [0.00000, 0.00183, 0.00726, 0.01390, 0.02252, 0.03257, 0.04388, 0.05630, 0.06977, 0.08423, 0.09959, 0.11583,
     0.13284, 0.15055, 0.16883, 0.18748, 0.20621, 0.22455, 0.24183, 0.25699, 0.26852, 0.27431, 0.27155, 0.25704],
    [0.00000, 0.00249, 0.00913, 0.01798, 0.02874, 0.04128, 0.05518, 0.07033, 0.08661, 0.10390, 0.12211, 0.14117,
     0.16099, 0.18149, 0.20256, 0.22406, 0.24579, 0.26746, 0.28862, 0.30862, 0.32647, 0.34073, 0.34931, 0.34924],
    [0.00000, 0.00331, 0.01148, 0.02260, 0.03609, 0.05147, 0.06849, 0.08685, 0.10638, 0.12698, 0.14851, 0.17085,
     0.19393, 0.21766, 0.24194, 0.26667, 0.29173, 0.31693, 0.34202, 0.36664, 0.39027, 0.41209, 0.43089, 0.44483],
    [0.00000, 0.00430, 0.01435, 0.02806, 0.04451, 0.06322, 0.08368, 0.10565, 0.12888, 0.15317, 0.17837, 0.20435,
     0.23101, 0.25826, 0.28602, 0.31419, 0.34269, 0.37142, 0.40026, 0.42903, 0.45752, 0.48539, 0.51212, 0.53694],
    [0.00000, 0.00546, 0.01770, 0.03420, 0.05397, 0.07631, 0.10062, 0.12654, 0.15375, 0.18201, 0.21115, 0.24099,
     0.27141, 0.30231, 0.33360, 0.36519, 0.39702, 0.42902, 0.46114, 0.49330, 0.52544, 0.55745, 0.58923, 0.62059],
    [0.00000, 0.00679, 0.02114, 0.04089, 0.06438, 0.09064, 0.11908, 0.14920, 0.18062, 0.21304, 0.24624, 0.28001,
     0.31420, 0.34869, 0.38337, 0.41814, 0.45293, 0.48770, 0.52237, 0.55691, 0.59129, 0.62547, 0.65943, LN_2],
];

/// 1 − Ē at α = (j/30)², of the table as it is read.
#[rustfmt::skip]
const MEAN: [f64; MEANS] = [
    0.00000, 0.00004, 0.00030, 0.00081, 0.00169, 0.00404, 0.00685, 0.01167, 0.01702, 0.02526, 0.03386, 0.04690, 0.05989, 0.07795, 0.09559, 0.11880,
    0.14129, 0.16919, 0.19623, 0.22788, 0.25866, 0.29273, 0.32605, 0.36106, 0.39551, 0.43006, 0.46424, 0.49718, 0.52992, 0.56042, 0.59085,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::bsdf::fresnel::reflect;
    use crate::world::bsdf::lobes::Ggx;
    use crate::world::even::grid;
    use glam::DVec3;

    /// 1 − E by facets chosen evenly.
    fn integrated(alpha: f64, cosine: f64) -> f64 {
        let (ggx, n) = (Ggx { n: DVec3::Z, alpha }, 256);
        let wo = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let carried = grid(n).map(|u| ggx.carried(cosine, reflect(wo, ggx.visible_normal(wo, u)).z));
        1.0 - carried.sum::<f64>() / f64::from(n * n)
    }

    #[test]
    fn the_table_is_the_integral_at_its_points_and_between_them() {
        for alpha in [0.03, 0.05, 0.09, 0.2, 0.35, 0.6, 0.85, 1.0] {
            for cosine in [0.004, 0.02, 0.07, 0.15, 0.4, 0.7, 1.0] {
                let (told, true_) = (Lost::by(alpha).at(cosine), integrated(alpha, cosine));
                assert!((told - true_).abs() < 3e-3, "α {alpha}, cos {cosine}: {told}, not {true_}");
            }
        }
    }

    #[test]
    fn means_are_those_of_the_table() {
        for alpha in [0.05, 0.1, 0.3, 0.5, 0.8, 1.0] {
            let (lost, n) = (Lost::by(alpha), 2000);
            let mu = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n));
            let mean = mu.map(|c| 2.0 * c * lost.at(c)).sum::<f64>() / f64::from(n);
            assert!(
                (mean - lost.on_average()).abs() < 0.01 * mean,
                "α {alpha}: {} and {mean}",
                lost.on_average()
            );
        }
    }

    #[test]
    fn smooth_mirrors_lose_nothing_and_black_facets_bring_nothing_back() {
        assert_eq!(Lost::by(0.0).lobe(Rgb::ONE, 0.5, 0.5), Rgb::ZERO);
        assert_eq!(Lost::by(0.7).lobe(Rgb::ZERO, 0.5, 0.5), Rgb::ZERO);
        assert_eq!(Lost::by(0.7).share(Rgb::ONE), Rgb::ONE);
    }
}
