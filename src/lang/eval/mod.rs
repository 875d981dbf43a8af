//! Evaluation of a resolved program: a walk over its tree with values in slots. It knows no kind and no builtin by name; both
//! are looked up in their tables.
//!
//! An error ends the item it stands in, and evaluation goes on with the next; a name whose value failed is poison, whose
//! uses are silent. So every independent fault of a file is told in one run.

mod blocks;
mod calls;
mod carried;
mod context;
mod equal;
mod expressions;
mod fields;
mod guards;
mod items;
mod nested;
mod numbers;
pub mod operators;
mod plain;
mod report;
pub mod slots;
mod straight;
mod undo;
mod update;

pub(super) use equal::equal;
pub(super) use fields::{components, letters, place, swizzle};

use super::limits::Limits;
use super::resolve::load::Files;
use super::resolve::program::{FunctionId, Program, UnitId};
use super::table::{Outcome, Reported, Trace};
use super::value::{Given, Value};
use crate::diag::{Sink, SourceId, Span};
use crate::scene::assets::Loader;
use crate::scene::{Camera, Figure, Node, RenderSettings, Scene};
use carried::{Carried, Models};
use glam::DVec3;
use guards::Guards;
use nested::Nested;
use slots::{Captured, Slot};
use std::cell::Cell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::atomic::AtomicBool;
use undo::Undo;

/// What a run is given.
pub struct Run<'p> {
    /// The program.
    pub program: &'p Program,
    /// Its files, for paths and traces.
    pub files: &'p Files,
    /// The way files are read.
    pub loader: &'p dyn Loader,
    /// Who finds where rays meet objects.
    pub tracer: &'p dyn Trace,
    /// Guards.
    pub limits: Limits,
    /// `time` and `frame`.
    pub time: (f64, f64),
    /// How many bytes of stack this thread may use.
    pub stack: usize,
    /// The source whose items that are expressions are answered with their values, beside being placed.
    pub answers: Option<SourceId>,
    /// Asks the run to end soon.
    pub cancel: Option<&'p AtomicBool>,
}

/// What stays from run to run where a program grows.
#[derive(Default)]
pub struct Standing {
    /// Values of the top-level names of all units, by their global slots.
    pub globals: Vec<Slot>,
    units_done: Vec<bool>,
    /// What groups of groups come to, by the address of their children.
    nested: HashMap<*const Node, Nested>,
    undo: Option<Undo>,
    /// In an animation alone.
    carried: Option<Box<Carried>>,
}

/// Something that a run says by the way.
#[derive(Clone, Debug)]
pub enum Said {
    /// By `print`.
    Printed(String),
    /// The value of an expression that stands as an item of [`Run::answers`].
    Answer(Value),
    /// What the number answered last may be off by, where more than its last digit is known to be uncertain.
    Within(f64),
}

/// What a run gives.
#[derive(Default)]
pub struct Ran {
    /// What could be made.
    pub scene: Scene,
    /// What was said on the way, in order.
    pub said: Vec<Said>,
    /// What was tried, also where it failed.
    pub attempts: Attempts,
}

/// What a scene tried to make, so that nothing is called missing that only failed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Attempts {
    /// A top-level item of any sort failed.
    pub failed: bool,
    /// A camera or render block was tried.
    pub setting: bool,
}

/// Runs the first unit of a program.
pub fn run(run: &Run<'_>, standing: &mut Standing, sink: &mut Sink) -> Ran {
    let mut evaluator = Evaluator::new(run, std::mem::take(standing), sink);
    let (top, nodes) = evaluator.unit(UnitId(0));
    let ran = Ran {
        scene: Scene {
            nodes,
            cameras: top.cameras,
            render: top.render.unwrap_or_default(),
            figures: top.figures,
        },
        attempts: top.attempts,
        said: std::mem::take(&mut evaluator.said),
    };
    evaluator.standing.keep_models(evaluator.models);
    *standing = evaluator.standing;
    ran
}

/// Calls a function value from outside a program. Faults are in the sink.
pub fn call(
    run: &Run<'_>,
    standing: &mut Standing,
    function: &Value,
    arguments: &[Value],
    at: Span,
    sink: &mut Sink,
) -> Outcome {
    let mut evaluator = Evaluator::new(run, std::mem::take(standing), sink);
    let value = evaluator.call_with_values(function, arguments, at);
    *standing = evaluator.standing;
    value
}

/// What belongs to a scene as a whole.
#[derive(Default)]
struct Top {
    cameras: Vec<Camera>,
    render: Option<RenderSettings>,
    figures: Vec<Figure>,
    attempts: Attempts,
}

/// What items made so far.
struct Produced {
    around: Around,
    given: Vec<Given>,
    nodes: Vec<Node>,
    poisoned: Vec<(Rc<str>, Span)>,
    failed: bool,
}

impl Produced {
    fn new(around: Around) -> Self {
        Produced { around, given: Vec::new(), nodes: Vec::new(), poisoned: Vec::new(), failed: false }
    }
}

/// What is around items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Around {
    /// A file's top level.
    Top,
    /// A block's braces, a function's body, a `with`.
    Braces,
}

/// What items do to the items after them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flow {
    /// The next one runs.
    On,
    /// A function returns; its value is in [`Evaluator::returned`].
    Return,
}

/// A call that is running.
#[derive(Clone, Copy, Debug)]
struct Call {
    function: FunctionId,
    span: Span,
    base: usize,
}

struct Evaluator<'p> {
    run: &'p Run<'p>,
    program: &'p Program,
    stack: Vec<Slot>,
    /// Room for the properties of blocks, of each that another stands in.
    spare: Vec<Vec<Given>>,
    base: usize,
    captured: Option<Rc<Captured>>,
    standing: Standing,
    calls: Vec<Call>,
    returned: Option<Outcome>,
    /// A value that the fast path of numbers could not carry.
    spilled: Outcome,
    /// A vector on the fast path of vectors.
    vector: DVec3,
    /// Of the line that is running.
    registers: straight::Registers,
    /// What the last number of a member may be off by, where it said so.
    estimate: Option<f64>,
    top: Top,
    guards: Guards,
    sink: &'p mut Sink,
    said: Vec<Said>,
    /// Models whose files were asked for what stands in them.
    models: Models,
}

impl<'p> Evaluator<'p> {
    fn new(run: &'p Run<'p>, mut standing: Standing, sink: &'p mut Sink) -> Self {
        standing.globals.resize_with(run.program.globals.len(), Slot::default);
        standing.units_done.resize(run.program.units.len(), false);
        let models = standing.take_models();
        Evaluator {
            run,
            program: run.program,
            stack: Vec::new(),
            spare: Vec::new(),
            base: 0,
            captured: None,
            standing,
            calls: Vec::new(),
            returned: None,
            spilled: Err(Reported),
            vector: DVec3::ZERO,
            registers: [const { Cell::new(0.0) }; _],
            estimate: None,
            top: Top::default(),
            guards: Guards::new(&run.limits, run.stack),
            sink,
            said: Vec::new(),
            models,
        }
    }

    /// Runs a unit in a frame of its own: what belongs to the scene, and what it places.
    fn unit(&mut self, id: UnitId) -> (Top, Vec<Node>) {
        self.standing.units_done[id.0 as usize] = true;
        let unit = &self.program.units[id.0 as usize];
        let around = std::mem::take(&mut self.top);
        let (base, captured) = (self.base, self.captured.take());
        self.base = self.stack.len();
        self.stack.resize_with(self.base + unit.n_slots as usize, Slot::default);
        let mut out = Produced::new(Around::Top);
        self.items(&unit.body, &mut out);
        if id.0 != 0 {
            self.stack.truncate(self.base);
        }
        (self.base, self.captured) = (base, captured);
        let mut top = std::mem::replace(&mut self.top, around);
        top.attempts.failed |= out.failed;
        (top, out.nodes)
    }
}
