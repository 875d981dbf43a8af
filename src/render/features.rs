//! What may be kept of a pixel beside its radiance, for layers of an EXR file: what the camera's rays meet first, and how sure the radiance is. Nothing of it is found out unless it is asked for. Knows neither files nor tracers.

use crate::diag::Span;
use crate::scene::Rgb;
use crate::world::bsdf::Bsdf;
use crate::world::{Hit, Ray, World};
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
    fn look(self) -> bool {
        self.0 & !(1 << Layer::Variance as u8) != 0
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
    /// Objects met, with their counts of samples.
    sources: Vec<(Source, u32)>,
}

impl FeatureSum {
    /// Takes a camera sample: its ray, where there is one, and the radiance along it.
    pub fn add(&mut self, asked: Layers, world: &World, ray: Option<&Ray>, radiance: Rgb) {
        self.samples += 1;
        if asked.has(Layer::Variance) && radiance.is_finite() {
            self.moments.add(radiance);
        }
        let Some(ray) = ray.filter(|_| asked.look()) else { return };
        let Some(hit) = world.closest(ray) else { return };
        self.meet(world, ray, &hit);
        if asked.has(Layer::Source) {
            self.count(world, &hit);
        }
    }

    fn meet(&mut self, world: &World, ray: &Ray, hit: &Hit<'_>) {
        self.hits += 1;
        self.depth += hit.t * ray.direction.length();
        self.position += hit.point;
        // What has no value is magenta in the picture, and has no albedo here.
        if let Ok(bsdf) = Bsdf::at(world, hit, ray) {
            self.albedo += bsdf.albedo();
            self.normal += bsdf.normal;
        }
    }

    fn count(&mut self, world: &World, hit: &Hit<'_>) {
        let Some(found) = world.provenance(hit.primitive) else { return };
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
    fn layers_are_a_set() {
        let some: Layers = [Layer::Depth, Layer::Source, Layer::Depth].into_iter().collect();
        let has = Layer::ALL.map(|layer| some.has(layer));
        assert_eq!(has, [false, false, true, false, false, true]);
        assert!(Layers::NONE.is_empty() && !some.is_empty());
        assert!(some.look() && !Layers::NONE.with(Layer::Variance).look());
    }
}
