//! Functions of materials and lamps that run too long: what is made before a picture does not run them again and again.

use crate::stage::*;
use glam::DVec3;
use ogee::math::field::{Binary, FaultKind, FieldBuilder, Held, Register};
use ogee::render::film::Film;
use ogee::render::settings::ResolvedSettings;
use ogee::scene::assets::DiskLoader;
use ogee::scene::*;
use ogee::world::{World, WorldOptions};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const Y: DVec3 = DVec3::Y;

/// Gives back a number, and counts how often it does.
#[derive(Debug, Default)]
struct Counter(AtomicUsize);

impl Held for Counter {
    fn call(&self, from: &[f64], to: &mut [f64]) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed);
        to.copy_from_slice(from);
        true
    }
}

/// A grey by the steps of a tape, which get x, and counts its runs.
fn grey(counter: &Arc<Counter>, steps: impl FnOnce(&mut FieldBuilder, Register)) -> Texture {
    let mut builder = FieldBuilder::new(3);
    builder.set_turn_limit(3);
    let held = Arc::clone(counter) as Arc<dyn Held>;
    let x = builder.input(0);
    let x = builder.call_held(held, &[x], 1)[0];
    steps(&mut builder, x);
    let grey = builder.constant(0.7);
    let field = builder.finish(&[grey]).expect("a small tape");
    let kind = PatternKind::Function(Arc::new(SampledFunction::of_point(field)));
    Texture::Pattern(Arc::new(Pattern { kind, transform: None, span: SPAN }))
}

/// One that runs without end at all points whose x is more than `edge`.
fn endless(counter: &Arc<Counter>, edge: f64) -> Texture {
    grey(counter, |builder, x| {
        let edge = builder.constant(edge);
        let again = builder.binary(Binary::Less, edge, x);
        let turn = builder.label();
        builder.bind(turn);
        builder.jump_if_not_zero(again, turn);
    })
}

/// Such a material, which bends light beside if asked to.
fn paint(counter: &Arc<Counter>, edge: f64, is_clear: bool) -> Arc<Material> {
    let mut clear = Layers::DEFAULT;
    clear.transmit = Texture::number(0.5);
    let layers = is_clear.then(|| Box::new(clear));
    Arc::new(Material { diffuse: endless(counter, edge), layers, span: SPAN })
}

/// A picture of things in the sun.
fn in_the_sun(nodes: Vec<Node>, settings: &ResolvedSettings) -> Film {
    let options = WorldOptions { accelerator: settings.accelerator, ..WorldOptions::default() };
    let (world, _) = World::new(nodes.into_iter().chain([sun(-Y, 3.0)]).collect(), &options, &DiskLoader);
    picture(&world, &camera(Y + 4.0 * DVec3::Z, DVec3::ZERO, 40.0), settings)
}

fn by(tracer: TracerKind) -> ResolvedSettings {
    ResolvedSettings { tracer, ..settings([4, 3]) }
}

/// How often functions run for a picture by photons.
fn runs(counter: &Counter, nodes: Vec<Node>) -> usize {
    in_the_sun(nodes, &by(TracerKind::Photon));
    counter.0.load(Ordering::Relaxed)
}

/// A piece of the floor between two x.
fn floor(from: f64, to: f64) -> Shape {
    rect((from + to) / 2.0 * DVec3::X, (to - from) / 2.0 * DVec3::X, -DVec3::Z)
}

/// Pixels of the pictures, each of which runs a function once.
const PIXELS: usize = 12;

const EVERYWHERE: f64 = f64::NEG_INFINITY;

#[test]
fn photons_leave_a_material_alone_whose_function_runs_without_end() {
    for is_clear in [false, true] {
        let counter = Arc::default();
        let runs = runs(&counter, vec![object(floor(-1.0, 1.0), &paint(&counter, EVERYWHERE, is_clear))]);
        assert!(runs < PIXELS + 64, "{runs} runs, of which {PIXELS} pixels explain no more than one each");
    }
}

#[test]
fn photons_do_not_leave_a_lamp_whose_function_runs_without_end() {
    for is_aimed in [false, true] {
        let counter = Arc::default();
        let glows = Layers { emit: endless(&counter, EVERYWHERE), ..Layers::DEFAULT };
        let lamp = Material { diffuse: Texture::ZERO, layers: Some(Box::new(glows)), span: SPAN };
        let glass = is_aimed.then(|| object(sphere(DVec3::X, 0.2), &glass(1.5)));
        let lamp = object(floor(-1.0, 0.0), &Arc::new(lamp));
        let runs = runs(&counter, glass.into_iter().chain([lamp]).collect());
        assert!(
            runs < 8 * PIXELS + 64,
            "{runs} runs, of which pixels that are seen and lit explain few each"
        );
    }
}

#[test]
fn what_photons_leave_alone_is_told_where_it_is_seen() {
    let told = |tracer| {
        let half = object(floor(-1.0, 1.0), &paint(&Arc::default(), 0.0, false));
        in_the_sun(vec![half], &by(tracer)).report.undefined
    };
    let by_photons = told(TracerKind::Photon);
    assert_eq!(by_photons[0].kind, Some(FaultKind::TooManyTurns));
    assert_eq!(by_photons, told(TracerKind::Whitted));
}

#[test]
fn photons_leave_many_materials_alone_that_are_seldom_met_one_by_one() {
    let counter = Arc::default();
    let stripes = (-100..100).map(|i| {
        let from = f64::from(i) / 100.0;
        object(floor(from, from + 0.01), &paint(&counter, EVERYWHERE, false))
    });
    let runs = runs(&counter, stripes.collect());
    assert!(runs < PIXELS + 400, "{runs} runs for 200 materials");
}

#[test]
fn photons_go_on_to_a_material_whose_function_seldom_runs_without_end() {
    let runs = |edge| {
        let counter = Arc::default();
        runs(&counter, vec![object(floor(-1.0, 1.0), &paint(&counter, edge, false))])
    };
    let (all, seldom) = (runs(1.0), runs(0.999));
    assert!(all > 1000 && seldom == all, "{seldom} runs, {all} where there is an end everywhere");
}

#[test]
fn photons_go_on_to_a_material_whose_function_is_undefined_but_ends() {
    let counter = Arc::default();
    let undefined = grey(&counter, |builder, _| builder.fault(FaultKind::Undefined));
    let paint = Arc::new(Material { diffuse: undefined, layers: None, span: SPAN });
    let runs = runs(&counter, vec![object(floor(-1.0, 1.0), &paint)]);
    assert!(runs > 1000, "{runs} runs");
}

#[test]
fn what_photons_leave_alone_does_not_depend_on_threads_or_trees() {
    let of = |threads, accelerator| {
        let counter = Arc::default();
        let ball =
            |x, edge, is_clear| object(sphere(x * DVec3::X + Y, 0.3), &paint(&counter, edge, is_clear));
        let white = object(floor(-1.0, 1.0), &diffuse(0.7));
        let nodes = vec![white, ball(-0.7, -0.7, true), ball(0.0, 0.2, false), ball(0.7, 0.9, true)];
        let settings = ResolvedSettings { threads: Some(threads), accelerator, ..by(TracerKind::Photon) };
        (in_the_sun(nodes, &settings), counter.0.load(Ordering::Relaxed))
    };
    let one = of(1, Accelerator::Bvh);
    assert!(!one.0.report.undefined.is_empty());
    assert!([2, 3, 8].into_iter().all(|threads| of(threads, Accelerator::Bvh) == one));
    assert!([Accelerator::KdTree, Accelerator::None].into_iter().all(|tree| of(2, tree) == one));
}
