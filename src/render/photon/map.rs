//! Photons in a balanced kd-tree, and the light that they bring to a point: the nearest k on surfaces that face alike, the
//! farthest of which only says how large the disc is. With k − 1 in the sum the estimate is right on average where photons are even
//! (Jensen, *Realistic Image Synthesis Using Photon Mapping*, 2001, §7; the correction after Mack & Rosenblatt, 1979).

use crate::render::tiles::Watch;
use crate::scene::Rgb;
use glam::{DVec3, Vec3};
use std::cell::RefCell;
use std::cmp::Ordering;

/// Light that arrived somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    /// Where.
    pub position: DVec3,
    /// Unit vector to where it came from.
    pub from: Vec3,
    /// Unit geometric normal of the surface, on the side it came from.
    pub normal: Vec3,
    /// W per colour channel.
    pub power: Vec3,
    /// Segments from its lamp.
    pub segment: u32,
    /// The axis that cuts its part of the tree.
    axis: u8,
}

impl Photon {
    /// A photon not yet in a tree.
    pub fn new(position: DVec3, from: DVec3, normal: DVec3, power: Rgb, segment: u32) -> Photon {
        Photon {
            position,
            from: from.as_vec3(),
            normal: normal.as_vec3(),
            power: power.as_vec3(),
            segment,
            axis: 0,
        }
    }
}

/// Photons, ready to be asked. The root of a part of the list is its middle.
#[derive(Debug, Default)]
pub struct Map {
    photons: Vec<Photon>,
}

/// What is asked of a map.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// Where.
    pub point: DVec3,
    /// Unit geometric normal there.
    pub normal: DVec3,
    /// Whether photons that came from behind count too.
    pub both_sides: bool,
    /// Photons beyond this distance do not count.
    pub radius: f64,
    /// Photons taken at most, the one that only measures counted.
    pub most: usize,
    /// Photons of longer ways do not count.
    pub segments: u32,
}

/// Surfaces that differ by more than this (a cosine, about 26°) do not share photons.
const ALIKE: f32 = 0.9;

/// Photons of which the spacing is measured.
const PROBES: usize = 512;

/// Lists shorter than this are built by the thread that has them.
const SERIAL: usize = 1 << 12;

thread_local! {
    /// The nearest so far, farthest first, kept between queries.
    static HEAP: RefCell<Vec<(f64, u32)>> = const { RefCell::new(Vec::new()) };
}

impl Map {
    /// A tree of photons. The same list gives the same tree on any number of threads. None where the work is called
    /// off.
    pub fn new(mut photons: Vec<Photon>, watch: Watch<'_>) -> Option<Map> {
        build(&mut photons, watch);
        watch.go_on()?;
        Some(Map { photons })
    }

    /// The middle one of the distances within which a photon of the map has `most` others, by a few hundred of them. None where
    /// there are too few to tell.
    pub fn spacing(&self, most: usize) -> Option<f64> {
        let most = most.min(self.photons.len());
        let step = (self.photons.len() / PROBES).max(1);
        let mut distances: Vec<f64> =
            self.photons.iter().step_by(step).filter_map(|p| self.reach(p, most)).collect();
        distances.sort_unstable_by(f64::total_cmp);
        distances.get(distances.len() / 2).copied()
    }

    fn reach(&self, photon: &Photon, most: usize) -> Option<f64> {
        let (point, normal) = (photon.position, photon.normal.as_dvec3());
        let query =
            Query { point, normal, both_sides: false, radius: f64::INFINITY, most, segments: u32::MAX };
        HEAP.with_borrow_mut(|heap| {
            self.nearest(&query, heap);
            (heap.len() == most).then(|| heap[0].0.sqrt())
        })
    }

    /// Leaves the nearest in a heap, farthest first.
    fn nearest(&self, query: &Query, heap: &mut Vec<(f64, u32)>) {
        heap.clear();
        Search { query, most: query.radius * query.radius, heap }.visit(&self.photons, 0);
    }

    /// The light near a point: `reflected` says what becomes of each photon's power, and the sum is divided by the disc. None where
    /// fewer than asked for lie within the radius and `sparse` is not wanted.
    pub fn gather(&self, query: &Query, sparse: bool, reflected: impl Fn(&Photon) -> Rgb) -> Option<Rgb> {
        HEAP.with_borrow_mut(|heap| {
            self.nearest(query, heap);
            let full = heap.len() == query.most;
            if !full && !sparse {
                return None;
            }
            // In the order of the map: a sum in the order of the heap would depend on how the tree was walked.
            let farthest = full.then(|| heap[0]);
            let squared = farthest.map_or(query.radius * query.radius, |(squared, _)| squared);
            heap.sort_unstable_by_key(|(_, index)| *index);
            let counted = heap.iter().filter(|(_, i)| farthest.is_none_or(|(_, last)| last != *i));
            let sum: Rgb = counted.map(|(_, i)| reflected(&self.photons[*i as usize])).sum();
            (squared > 0.0).then(|| sum / (std::f64::consts::PI * squared))
        })
    }
}

/// Cuts the longest side at the middle photon, and both halves in turn, unless that is called off.
fn build(photons: &mut [Photon], watch: Watch<'_>) {
    if photons.len() < 2 || watch.is_over() {
        return;
    }
    let axis = longest_side(photons);
    let middle = photons.len() / 2;
    photons.select_nth_unstable_by(middle, |a, b| in_order(a, b, axis));
    photons[middle].axis = axis as u8;
    let (low, high) = photons.split_at_mut(middle);
    let high = &mut high[1..];
    if low.len() < SERIAL {
        build(low, watch);
        build(high, watch);
    } else {
        rayon::join(|| build(low, watch), || build(high, watch));
    }
}

fn longest_side(photons: &[Photon]) -> usize {
    let bound = |pick: fn(DVec3, DVec3) -> DVec3| {
        photons.iter().map(|p| p.position).reduce(pick).unwrap_or(DVec3::ZERO)
    };
    let size = bound(DVec3::max) - bound(DVec3::min);
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}

/// By one coordinate, then by the others, then by what they carry: an order that no two photons that differ share.
fn in_order(a: &Photon, b: &Photon, axis: usize) -> Ordering {
    let by = |axis: usize| a.position[axis].total_cmp(&b.position[axis]);
    let rest = || {
        let carried = |p: &Photon| [p.power.x, p.power.y, p.power.z, p.from.x, p.from.y, p.from.z];
        let pairs = carried(a).into_iter().zip(carried(b));
        pairs.map(|(a, b)| a.total_cmp(&b)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
    };
    by(axis).then_with(|| by((axis + 1) % 3)).then_with(|| by((axis + 2) % 3)).then_with(rest)
}

/// A walk for the nearest.
struct Search<'a> {
    query: &'a Query,
    /// Squared distance beyond which none counts any more.
    most: f64,
    /// A heap, farthest first.
    heap: &'a mut Vec<(f64, u32)>,
}

impl Search<'_> {
    /// A part of the tree that begins at `first` in the map.
    fn visit(&mut self, part: &[Photon], first: usize) {
        let middle = part.len() / 2;
        let Some(photon) = part.get(middle) else { return };
        let axis = usize::from(photon.axis);
        let beside = self.query.point[axis] - photon.position[axis];
        let (low, high) = ((&part[..middle], first), (&part[middle + 1..], first + middle + 1));
        let (near, far) = if beside < 0.0 { (low, high) } else { (high, low) };
        self.visit(near.0, near.1);
        self.meet(photon, first + middle);
        if beside * beside <= self.most {
            self.visit(far.0, far.1);
        }
    }

    fn meet(&mut self, photon: &Photon, index: usize) {
        let squared = photon.position.distance_squared(self.query.point);
        let facing = photon.normal.dot(self.query.normal.as_vec3());
        let counts = squared <= self.most
            && photon.segment <= self.query.segments
            && (facing > ALIKE || self.query.both_sides && facing < -ALIKE);
        if !counts {
            return;
        }
        let found = (squared, index as u32);
        if self.heap.len() < self.query.most {
            self.heap.push(found);
            rise(self.heap);
        } else if farther(self.heap[0], found) {
            self.heap[0] = found;
            sink(self.heap);
        }
        if self.heap.len() == self.query.most {
            self.most = self.heap[0].0;
        }
    }
}

/// Equal distances are told apart by place, so that the k nearest are the same however they are found.
fn farther(a: (f64, u32), b: (f64, u32)) -> bool {
    a.0 > b.0 || (a.0 == b.0 && a.1 > b.1)
}

/// The last of a heap to its place.
fn rise(heap: &mut [(f64, u32)]) {
    let mut i = heap.len() - 1;
    while i > 0 && farther(heap[i], heap[(i - 1) / 2]) {
        heap.swap(i, (i - 1) / 2);
        i = (i - 1) / 2;
    }
}

/// The first of a heap to its place.
fn sink(heap: &mut [(f64, u32)]) {
    let mut i = 0;
    loop {
        let children = [2 * i + 1, 2 * i + 2].into_iter().filter(|c| *c < heap.len());
        let Some(child) = children.reduce(|a, b| if farther(heap[b], heap[a]) { b } else { a }) else {
            return;
        };
        if !farther(heap[child], heap[i]) {
            return;
        }
        heap.swap(i, child);
        i = child;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::sampler::mix;
    use std::sync::atomic::AtomicBool;

    fn unit(i: u64) -> f64 {
        (mix(i) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Photons of power 1 on the unit square of the plane z = 0.
    fn even(n: u64) -> Vec<Photon> {
        let at = |i| DVec3::new(unit(2 * i), unit(2 * i + 1), 0.0);
        (0..n).map(|i| Photon::new(at(i), DVec3::Z, DVec3::Z, Rgb::ONE, 1)).collect()
    }

    fn map_of(n: u64) -> Map {
        let watch = Watch { progress: &(), cancel: &AtomicBool::new(false) };
        Map::new(even(n), watch).expect("nobody calls it off")
    }

    fn query(point: DVec3, most: usize) -> Query {
        Query { point, normal: DVec3::Z, both_sides: false, radius: 1.0, most, segments: u32::MAX }
    }

    #[test]
    fn the_nearest_are_those_of_all() {
        let (photons, map) = (even(2000), map_of(2000));
        for i in 0..200 {
            let point = DVec3::new(unit(9000 + i), unit(9500 + i), 0.01);
            let mut all: Vec<f64> = photons.iter().map(|p| p.position.distance_squared(point)).collect();
            all.sort_by(f64::total_cmp);
            let found = map.gather(&query(point, 10), false, |_| Rgb::ONE).unwrap();
            assert_eq!(found.x, 9.0 / (std::f64::consts::PI * all[9]), "nine on the disc of the tenth");
        }
    }

    #[test]
    fn even_light_is_estimated_without_bias_and_varies_by_the_root_of_the_photons() {
        let n = 400_000;
        let map = map_of(n);
        for k in [8, 16, 64] {
            let points = 40_000 / k as u64 * 8;
            let of = |i| {
                let at = DVec3::new(0.1 + 0.8 * unit(1_000_000 + i), 0.1 + 0.8 * unit(2_000_000 + i), 0.0);
                map.gather(&query(at, k), false, |_| Rgb::ONE).unwrap().x / n as f64
            };
            let found: Vec<f64> = (0..points).map(of).collect();
            let mean = found.iter().sum::<f64>() / points as f64;
            // With k photons in the sum it would be 1/(k − 1) too much.
            assert!((mean - 1.0).abs() < 0.008, "{k}: {mean}");
            let squares = found.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
            let varies = (squares / points as f64).sqrt() * (k as f64 - 2.0).sqrt();
            assert!((varies - 1.0).abs() < 0.1, "{k}: {varies}");
        }
    }

    #[test]
    fn surfaces_that_face_elsewhere_and_longer_ways_do_not_count() {
        let map = map_of(100);
        let at = DVec3::new(0.5, 0.5, 0.0);
        let turned = Query { normal: -DVec3::Z, ..query(at, 4) };
        assert!(map.gather(&turned, false, |_| Rgb::ONE).is_none());
        let short = Query { segments: 0, ..query(at, 4) };
        assert_eq!(map.gather(&short, true, |_| Rgb::ONE), Some(Rgb::ZERO));
    }

    #[test]
    fn few_photons_are_told_from_many() {
        let map = map_of(3);
        let wide = Query { radius: 2.0, ..query(DVec3::new(0.5, 0.5, 0.0), 8) };
        assert!(map.gather(&wide, false, |_| Rgb::ONE).is_none());
        let sparse = map.gather(&wide, true, |_| Rgb::ONE).unwrap().x;
        assert!((sparse - 3.0 / (4.0 * std::f64::consts::PI)).abs() < 1e-12);
        assert!(Map::default().gather(&wide, true, |_| Rgb::ONE).is_some());
    }
}
