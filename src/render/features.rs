//! What may be kept of a pixel beside its radiance, for layers of an EXR file: what the camera's rays meet first, and how sure the radiance is. Nothing of it is found out unless it is asked for. Knows no files;
//! tracers tell what they see anyway.

use crate::diag::Span;
use crate::scene::Rgb;
use crate::world::bsdf::Bsdf;
use crate::world::{Hit, PrimitiveId, Ray, World};
use glam::DVec3;

/// Something that is kept of each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Share of light that the surface sends on, linear RGB; 0 where nothing is met.
    Albedo,
    /// Unit shading normal on the side that is seen, in world space; 0 where nothing is met. The mean of several is shorter.
    Normal,
    /// Distance along the ray, in scene units, of the samples that meet something; infinite where none does.
    Depth,
    /// Point in world space, of the samples that meet something; 0 where none does.
    Position,
    /// Of the pixel's mean radiance, for each channel: s² / n of n samples taken as independent. Even samples err less than it says.
    Variance,
    /// The number of the object that most samples meet, 0 for none; the metadata tell which it is.
    Source,
}

impl Layer {
    /// All of them.
    pub const ALL: [Layer; 6] =
        [Layer::Albedo, Layer::Normal, Layer::Depth, Layer::Position, Layer::Variance, Layer::Source];
}

/// Which layers are asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layers(u8);

impl Layers {
    /// None of them.
    pub const NONE: Layers = Layers(0);

    /// What [`super::denoise`] goes by: more than is ever written into a file.
    pub const GUIDES: Layers = Layers(
        Self::SPREAD
            | 1 << Layer::Albedo as u8
            | 1 << Layer::Normal as u8
            | 1 << Layer::Position as u8
            | 1 << Layer::Variance as u8,
    );

    /// How features differ within a pixel, and its two parts.
    const SPREAD: u8 = 1 << 7;

    /// These and others.
    pub const fn and(self, others: Layers) -> Layers {
        Layers(self.0 | others.0)
    }

    /// These and another.
    pub const fn with(self, layer: Layer) -> Layers {
        Layers(self.0 | 1 << layer as u8)
    }

    /// True where it is among them.
    pub fn has(self, layer: Layer) -> bool {
        self.0 & 1 << layer as u8 != 0
    }

    /// True where nothing is asked for.
    pub fn is_empty(self) -> bool {
        self == Layers::NONE
    }

    /// True where it must be found out what the camera's rays meet.
    pub fn look(self) -> bool {
        self.0 & !(1 << Layer::Variance as u8) != 0
    }

    /// True where guides are kept.
    fn guides(self) -> bool {
        self.0 & Self::SPREAD != 0
    }
}

impl FromIterator<Layer> for Layers {
    fn from_iter<I: IntoIterator<Item = Layer>>(layers: I) -> Self {
        layers.into_iter().fold(Layers::NONE, Layers::with)
    }
}

/// What is kept of a pixel, as [`Layer`] tells it. Zeros of what is not asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "each is told at its layer")]
pub struct Features {
    pub albedo: Rgb,
    pub normal: DVec3,
    pub depth: f64,
    pub position: DVec3,
    pub variance: Rgb,
    /// 1 + its index in [`super::film::Film::sources`]; 0 for none.
    pub source: u32,
    /// Two parts of the pixel's samples, where guides are kept.
    pub halves: Halves,
    /// Variances of the means of albedo, normal and position, summed over their components, where guides are kept.
    pub spread: DVec3,
}

/// The mean of a first part of a pixel's samples, about half of them and as even as all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Halves {
    /// Mean radiance of the first part.
    pub first: Rgb,
    /// Its share of the samples, 1/3 … 2/3; 0 where there are not two samples.
    pub share: f64,
}

/// An object of the scene, as its text made it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// The block or `with` that made it.
    pub span: Span,
    /// Its `name`, where it has one.
    pub name: Option<Box<str>>,
}

impl Source {
    /// Orders by place in the text, then by name.
    pub fn order(&self, other: &Source) -> std::cmp::Ordering {
        let key = |s: &Source| (s.span.source.0, s.span.start, s.span.end);
        key(self).cmp(&key(other)).then_with(|| self.name.cmp(&other.name))
    }
}

/// What the camera's ray of one sample met first.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Distance along the ray, in scene units.
    depth: f64,
    position: DVec3,
    primitive: PrimitiveId,
    /// Zeros where the material has no value.
    albedo: Rgb,
    normal: DVec3,
}

/// What a tracer tells of a sample.
#[derive(Clone, Copy, Debug, Default)]
pub enum First {
    /// Nobody asks.
    #[default]
    Unasked,
    /// Nothing was met so far.
    Awaited,
    /// This was.
    Seen(Seen),
}

impl First {
    /// Takes what a ray met, where it is the first.
    #[inline]
    pub fn meet(&mut self, ray: &Ray, hit: &Hit<'_>) {
        if let First::Awaited = self {
            let depth = hit.t * ray.direction.length();
            let (position, primitive) = (hit.point, hit.primitive);
            *self = First::Seen(Seen { depth, position, primitive, albedo: Rgb::ZERO, normal: DVec3::ZERO });
        }
    }

    /// Takes what that is made of.
    #[inline]
    pub fn look(&mut self, bsdf: &Bsdf) {
        if let First::Seen(seen) = self
            && seen.normal == DVec3::ZERO
        {
            (seen.albedo, seen.normal) = (bsdf.albedo(), bsdf.normal);
        }
    }
}

/// The features of one pixel's samples on the way to their means, summed in the order of the samples.
#[derive(Clone, Debug, Default)]
pub struct FeatureSum {
    samples: u32,
    hits: u32,
    albedo: Rgb,
    normal: DVec3,
    depth: f64,
    position: DVec3,
    moments: Moments,
    parts: Parts,
    /// Of albedo, normal and position, over all samples.
    spread: [Moments; 3],
    /// Objects met, with their counts of samples.
    sources: Vec<(Source, u32)>,
}

impl FeatureSum {
    /// Takes a camera sample: what its ray met first, and the radiance along it.
    pub fn add(&mut self, asked: Layers, world: &World, first: First, radiance: Rgb) {
        self.samples += 1;
        if asked.has(Layer::Variance) && radiance.is_finite() {
            self.moments.add(radiance);
        }
        if asked.guides() && radiance.is_finite() {
            self.parts.add(radiance);
        }
        if !asked.look() {
            return;
        }
        let seen = if let First::Seen(seen) = first { Some(seen) } else { None };
        if let Some(seen) = &seen {
            self.meet(seen);
            if asked.has(Layer::Source) {
                self.count(world, seen.primitive);
            }
        }
        if asked.guides() {
            let looks = seen.map_or([Rgb::ZERO; 2], |seen| [seen.albedo, seen.normal]);
            looks.into_iter().zip(&mut self.spread).for_each(|(x, moments)| moments.add(x));
            seen.into_iter().for_each(|seen| self.spread[2].add(seen.position));
        }
    }

    fn meet(&mut self, seen: &Seen) {
        self.hits += 1;
        self.depth += seen.depth;
        self.position += seen.position;
        self.albedo += seen.albedo;
        self.normal += seen.normal;
    }

    fn count(&mut self, world: &World, primitive: PrimitiveId) {
        let Some(found) = world.provenance(primitive) else { return };
        let source = Source { span: found.span, name: found.name };
        match self.sources.iter_mut().find(|(known, _)| *known == source) {
            Some((_, count)) => *count += 1,
            None => self.sources.push((source, 1)),
        }
    }

    /// The means, and the object that most samples met (of several the first), which is still without a number.
    pub fn features(&self) -> (Features, Option<&Source>) {
        let (all, hits) = (f64::from(self.samples.max(1)), f64::from(self.hits.max(1)));
        let features = Features {
            albedo: self.albedo / all,
            normal: self.normal / all,
            depth: if self.hits == 0 { f64::INFINITY } else { self.depth / hits },
            position: self.position / hits,
            variance: self.moments.variance_of_mean(),
            source: 0,
            halves: self.parts.halves(),
            spread: DVec3::from(self.spread.map(|m| m.variance_of_mean().element_sum())),
        };
        let most = self.sources.iter().rev().max_by_key(|(_, count)| *count);
        (features, most.map(|(source, _)| source))
    }
}

/// Mean and squared deviations of samples, found one by one (Welford, *Technometrics* 4, 1962): no cancellation.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    n: u32,
    mean: Rgb,
    squares: Rgb,
}

impl Moments {
    fn add(&mut self, x: Rgb) {
        self.n += 1;
        let off = x - self.mean;
        self.mean += off / f64::from(self.n);
        self.squares += off * (x - self.mean);
    }

    /// s² / n; of fewer than two samples nothing is known, and it is 0.
    fn variance_of_mean(self) -> Rgb {
        let n = f64::from(self.n);
        if self.n < 2 { Rgb::ZERO } else { self.squares / ((n - 1.0) * n) }
    }
}

/// Samples summed as they come, with the sums after the last two powers of two: where either part of them is as even as all.
#[derive(Clone, Copy, Debug, Default)]
struct Parts {
    n: u32,
    sum: Rgb,
    marks: [(u32, Rgb); 2],
}

impl Parts {
    fn add(&mut self, x: Rgb) {
        if self.n.is_power_of_two() {
            self.marks = [self.marks[1], (self.n, self.sum)];
        }
        self.n += 1;
        self.sum += x;
    }

    /// Cut where it is nearest to the middle.
    fn halves(&self) -> Halves {
        let [before, last] = self.marks;
        let (n, sum) = if last.0 + before.0 <= self.n { last } else { before };
        if n == 0 {
            Halves::default()
        } else {
            Halves { first: sum / f64::from(n), share: f64::from(n) / f64::from(self.n) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variance_of_a_mean_is_that_of_its_samples_over_their_number() {
        let mut moments = Moments::default();
        [1.0, 2.0, 4.0, 9.0].into_iter().for_each(|x| moments.add(Rgb::splat(x + 1e6)));
        // Squares of −3, −2, 0, 5 are 38 together.
        assert!((moments.variance_of_mean() - Rgb::splat(38.0 / 3.0 / 4.0)).abs().max_element() < 1e-8);
        assert_eq!(Moments { n: 1, ..moments }.variance_of_mean(), Rgb::ZERO);
    }

    #[test]
    fn parts_are_cut_at_a_power_of_two_near_the_middle() {
        let share = |n: u32| {
            let mut parts = Parts::default();
            (0..n).for_each(|i| parts.add(Rgb::splat(f64::from(i))));
            let Halves { first, share } = parts.halves();
            let cut = share * f64::from(n);
            assert!(n < 2 || (first.x - (cut - 1.0) / 2.0).abs() < 1e-12, "{n}: {first} of the first {cut}");
            cut.round() as u32
        };
        assert_eq!([1, 2, 3, 4, 5, 6, 8, 12, 13, 16, 100].map(share), [0, 1, 2, 2, 2, 4, 4, 8, 8, 8, 64]);
        assert!((2..3000).all(|n| (n..3 * n).contains(&(3 * share(n))) && 3 * share(n) <= 2 * n));
    }

    #[test]
    fn layers_are_a_set() {
        let some: Layers = [Layer::Depth, Layer::Source, Layer::Depth].into_iter().collect();
        let has = Layer::ALL.map(|layer| some.has(layer));
        assert_eq!(has, [false, false, true, false, false, true]);
        assert!(Layers::NONE.is_empty() && !some.is_empty());
        assert!(some.look() && !Layers::NONE.with(Layer::Variance).look());
    }
}
