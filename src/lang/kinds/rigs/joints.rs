//! The kinds `joint` and `tip`: each is checked by itself, and waits as a part for the skeleton around it.

use super::part::{Part, Sort};
use super::{is_reserved, range};
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::skeleton::{Freedom, Limits, Turning};
use crate::lang::kinds::read::vector_of;
use crate::lang::kinds::shapes::conflict;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::lang::value::Value;
use glam::DVec3;
use std::rc::Rc;

const FLAG: &[&[Type]] = &[&[], &[Type::Bool]];

const FREEDOMS: [&str; 6] = ["fixed", "hinge", "universal", "ball", "slide", "free"];

/// Joints that hang on one another deeper than this are a mistake of a function that calls itself.
const DEEPEST: usize = 500;

/// What hangs on a joint or is a skeleton's root.
pub(super) const JOINTS: Property =
    Property::new("joint", &[&[Type::Part("joint")]], "", "a joint that hangs on this one, with its name")
        .repeats();

/// What ends a chain.
pub(super) const TIPS: Property =
    Property::new("tip", &[&[Type::Part("tip")]], "", "a tip that moves with this joint, with its name")
        .repeats();

/// A joint.
pub static JOINT: Kind = Kind {
    name: "joint",
    doc: "A joint of a skeleton, with what it may do, its angles at rest, and the joints and tips that hang on it. A point P of its frame is \
          at T(offset)·R(angle)·P in the frame of the joint above.",
    example: "skeleton s { joint elbow { offset <5, 0, 0>  hinge z  angle 50  limits 0, 150 } }",
    role: Role::Part,
    own: &[
        Property::new("offset", &[&[Type::Vector3]], "<0, 0, 0>", "from the joint above it, in scene units"),
        Property::new("fixed", FLAG, "", "does not move; what it is when no other freedom is given"),
        Property::new("hinge", &[&[Type::Direction]], "", "turns about this axis, by `angle`"),
        Property::new(
            "universal",
            &[&[Type::Direction, Type::Direction]],
            "",
            "turns about the first axis, and about the second within that, by `angles`",
        ),
        Property::new("ball", FLAG, "", "turns by `angles` about x, then y, then z, as `rotate` does"),
        Property::new("slide", &[&[Type::Direction]], "", "moves along this axis, by `angle` scene units"),
        Property::new("free", FLAG, "", "turns as `ball` does, then moves by `shift`"),
        Property::new(
            "angle",
            &[&[Type::NUMBER]],
            "0",
            "of a hinge at rest, in degrees; of a slide, in scene units",
        ),
        Property::new(
            "angles",
            &[&[Type::Vector3], &[Type::Vector2]],
            "",
            "at rest, in degrees: two of `universal`, three of `ball` and `free`; by default 0",
        ),
        Property::new("shift", &[&[Type::Vector3]], "<0, 0, 0>", "of a free joint at rest, in scene units"),
        Property::new(
            "limits",
            &[
                &[Type::NUMBER, Type::NUMBER],
                &[Type::Vector2, Type::Vector2],
                &[Type::Vector3, Type::Vector3],
            ],
            "",
            "least and most: degrees of each angle (numbers count for all of them), scene units of a slide",
        ),
        JOINTS,
        TIPS,
    ],
    children: false,
    open: false,
    build: Some(joint),
};

/// The end of a chain.
pub static TIP: Kind = Kind {
    name: "tip",
    doc: "The end of a chain of joints: what reaches for things. It points from its joint to itself.",
    example: "skeleton s { joint wrist { hinge z  tip hand { offset <1, 0, 0> } } }",
    role: Role::Part,
    own: &[Property::new("offset", &[&[Type::Vector3]], "<0, 0, 0>", "from its joint, in scene units")],
    children: false,
    open: false,
    build: Some(tip),
};

fn tip(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    part(ctx, block, Sort::Tip)
}

fn joint(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let freedom = freedom(ctx, block)?;
    let rest = rest(ctx, block, &freedom)?;
    let limits = limits(ctx, block, &freedom)?;
    check_rest(ctx, block, &rest, &limits)?;
    let parts = parts(block);
    let depth = 1 + parts.iter().map(|part| part.depth()).max().unwrap_or(0);
    if depth > DEEPEST {
        let message = format!("more than {DEEPEST} joints hang on one another");
        let said = Diagnostic::new(Code::TooDeep, block.kind_span, message);
        return Err(ctx.fail(said.hint("end the function that calls itself earlier")));
    }
    part(ctx, block, Sort::Joint { freedom, rest, limits, parts, depth })
}

fn part(ctx: &mut dyn Context, block: &Block, sort: Sort) -> Outcome {
    let kind = block.kind.name;
    let Some((name, name_span)) = &block.label else {
        let said =
            Diagnostic::new(Code::MissingProperty, block.kind_span, format!("a `{kind}` needs a name"))
                .hint(format!("write `{kind} elbow {{ … }}`"));
        return Err(ctx.fail(said));
    };
    if is_reserved(name) {
        let message =
            format!("a {kind} cannot be called `{name}`: a pose has a value or property of this name");
        let said = Diagnostic::new(Code::ReservedName, *name_span, message);
        return Err(ctx.fail(said.hint(format!("call it otherwise, as `{name}_`"))));
    }
    let offset = block.vector("offset").unwrap_or(DVec3::ZERO);
    Ok(Value::Part(Rc::new(Part { name: (&**name).into(), name_span: *name_span, offset, sort })))
}

/// The joints and tips that a block was given, in the order written.
pub(super) fn parts(block: &Block) -> Vec<Rc<Part>> {
    let values = block.given.iter().flat_map(|given| given.values.iter());
    let part = |(value, _): &(Value, Span)| match value {
        Value::Part(part) => Some(part.clone()),
        _ => None,
    };
    values.filter_map(part).collect()
}

/// Whether a freedom is given, and not `off`.
fn says(block: &Block, freedom: &str) -> bool {
    block.has(freedom) && !matches!(block.value(freedom), Some(Value::Bool(false)))
}

fn freedom(ctx: &mut dyn Context, block: &Block) -> Outcome<Freedom> {
    let given: Vec<&str> = FREEDOMS.into_iter().filter(|name| says(block, name)).collect();
    let name = match *given {
        [] => "fixed",
        [one] => one,
        [first, second, ..] => return Err(conflict(ctx, block, first, second)),
    };
    let axis = |i: usize| block.get(name).map_or(DVec3::ZERO, |given| vector_of(&given.values[i].0));
    Ok(match name {
        "hinge" => Freedom::Hinge(axis(0)),
        "universal" => Freedom::Universal(axis(0), axis(1)),
        "slide" => Freedom::Slide(axis(0)),
        "ball" => Freedom::Ball,
        "free" => Freedom::Free,
        _ => Freedom::Fixed,
    })
}

/// Which property gives a freedom's values at rest, and how many numbers that takes.
fn rest_property(freedom: &Freedom) -> (&'static str, usize) {
    match freedom {
        Freedom::Fixed => ("", 0),
        Freedom::Hinge(_) | Freedom::Slide(_) => ("angle", 1),
        Freedom::Universal(..) => ("angles", 2),
        Freedom::Ball | Freedom::Free | Freedom::Channels(_) => ("angles", 3),
    }
}

fn rest(ctx: &mut dyn Context, block: &Block, freedom: &Freedom) -> Outcome<Vec<f64>> {
    let (property, n) = rest_property(freedom);
    let takes_shift = *freedom == Freedom::Free;
    for other in ["angle", "angles", "shift"] {
        let fits = other == property || (other == "shift" && takes_shift);
        if block.has(other) && !fits {
            return Err(unfit(ctx, block, other, property));
        }
    }
    let shift = block.vector("shift").unwrap_or(DVec3::ZERO);
    let moves = if takes_shift { shift.to_array().to_vec() } else { Vec::new() };
    let turns = block.value(property).map_or(vec![0.0; n], components);
    if turns.len() != n {
        let message = format!("this joint has {n} angles, and `angles` gives {}", turns.len());
        return Err(block.fault(
            ctx,
            Code::BadProperty,
            "angles",
            message,
            "give as many as it turns about axes",
        ));
    }
    Ok([moves, turns].concat())
}

/// A property that a joint of this freedom does not have.
fn unfit(
    ctx: &mut dyn Context,
    block: &Block,
    given: &'static str,
    fit: &str,
) -> crate::lang::table::Reported {
    let freedom = FREEDOMS.into_iter().find(|name| says(block, name));
    let message = match freedom {
        Some(freedom) => format!("a joint with `{freedom}` takes no `{given}`"),
        None => format!("this joint takes no `{given}`: it says no freedom, and so it is fixed"),
    };
    let hint = match (freedom, fit) {
        (None, _) => "say what it may do: `hinge z`, or another freedom".into(),
        (_, "") => format!("leave `{given}` out"),
        (_, fit) => format!("it takes `{fit}`"),
    };
    block.fault(ctx, Code::ConflictingProperties, given, message, hint)
}

fn components(value: &Value) -> Vec<f64> {
    match value {
        Value::Number(x) => vec![*x],
        Value::Vector2(v) => v.to_array().to_vec(),
        Value::Vector3(v) => v.to_array().to_vec(),
        _ => unreachable!("checked to be a number or vector"),
    }
}

fn limits(ctx: &mut dyn Context, block: &Block, freedom: &Freedom) -> Outcome<Vec<Limits>> {
    let turnings = freedom.turnings();
    let mut limits = vec![Limits::NONE; turnings.len()];
    let Some(given) = block.get("limits") else { return Ok(limits) };
    let (low, high) = (components(&given.values[0].0), components(&given.values[1].0));
    let is_slide = matches!(freedom, Freedom::Slide(_));
    let limited: Vec<usize> =
        (0..turnings.len()).filter(|&k| is_slide || turnings[k] == Turning::Turn).collect();
    let n = limited.len();
    if n == 0 || (low.len() != 1 && low.len() != n) {
        let message = match n {
            0 => "a fixed joint has no limits".to_owned(),
            _ => format!("this joint has {n} angle{}, and `limits` is for {}", plural(n), low.len()),
        };
        return Err(block.fault(
            ctx,
            Code::BadProperty,
            "limits",
            message,
            "give a least and a most for each angle",
        ));
    }
    for (i, &k) in limited.iter().enumerate() {
        let of = |values: &[f64]| values[if values.len() == 1 { 0 } else { i }];
        limits[k] = Limits { low: of(&low), high: of(&high) };
        if limits[k].low > limits[k].high {
            let message =
                format!("the limits {} hold nothing", range(limits[k].low, limits[k].high, !is_slide));
            return Err(block.fault(ctx, Code::BadProperty, "limits", message, "give the lower one first"));
        }
    }
    Ok(limits)
}

fn plural(n: usize) -> &'static str {
    if n == 1 { "" } else { "s" }
}

fn check_rest(ctx: &mut dyn Context, block: &Block, rest: &[f64], limits: &[Limits]) -> Outcome<()> {
    let outside = rest.iter().zip(limits).find(|(value, limits)| !limits.hold(**value));
    let Some((value, Limits { low, high })) = outside else { return Ok(()) };
    let given = ["angle", "angles", "limits"].into_iter().find(|name| block.has(name)).unwrap_or("limits");
    let is_angle = !block.has("slide");
    let unit = if is_angle { "°" } else { "" };
    let message = format!(
        "at rest this joint is at {}{unit}, outside its limits {}",
        crate::lang::coerce::number(*value),
        range(*low, *high, is_angle)
    );
    let said = Diagnostic::new(Code::OutsideLimits, block.place(given), message)
        .also(block.place("limits"), "the limits are here")
        .hint(format!("the nearest is {}", crate::lang::coerce::number(value.clamp(*low, *high))));
    Err(ctx.fail(said))
}
