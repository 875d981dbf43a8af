//! Makers of patterns: rules that give a colour or number at each point of a surface.

use crate::diag::{Code, Diagnostic, Span};
use crate::lang::check;
use crate::lang::coerce;
use crate::lang::table::{Arguments, Builtin, BuiltinBody::*, Context, Gives, Outcome, Parameter, Type};
use crate::lang::value::Value;
use crate::scene::assets::image::Picture;
use crate::scene::{Filter, ImagePattern, Pattern, PatternKind, SampleInput, Texture, Wrap};
use std::sync::Arc;

const TWO: &[Parameter] = &[
    Parameter::new("a", "a colour, a number, a pattern or a function"),
    Parameter::new("b", "a colour, a number, a pattern or a function"),
];

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "checker",
        TWO,
        General(|ctx, arguments| of_two(ctx, arguments, PatternKind::Checker)),
        "Unit cubes in alternation, one of them `a` and centred on the origin.",
        ("checker(white, 0.3)", "a pattern"),
    ),
    Builtin::new(
        "stripes",
        TWO,
        General(|ctx, arguments| {
            let textures = textures(ctx, arguments, 0)?;
            made(ctx, PatternKind::Stripes(textures), arguments.span)
        }),
        "Slabs one unit thick across the x axis in turn, the first centred on the origin.",
        ("stripes(red, white, blue)", "a pattern"),
    )
    .variadic(),
    Builtin::new(
        "gradient",
        TWO,
        General(|ctx, arguments| of_two(ctx, arguments, PatternKind::Gradient)),
        "From `a` at y = 0 to `b` at y = 1; beyond, the nearer of them.",
        ("gradient(navy, white)", "a pattern"),
    ),
    Builtin::new(
        "ramp",
        &[
            Parameter::new("pattern", "a number, a pattern or a function"),
            Parameter::new("stop", "a list [t, colour]"),
        ],
        General(ramp),
        "The luminance of a pattern through stops: each a list of a position and a colour, linear between, constant beyond.",
        ("ramp(gradient(0, 1), [0, red], [0.5, white], [1, blue])", "a pattern"),
    )
    .variadic(),
    Builtin::new(
        "image",
        &[
            Parameter::new("file", "a text"),
            Parameter::new("wrap", "\"repeat\", \"clamp\" or \"mirror\"").or("\"repeat\""),
            Parameter::new("filter", "\"bilinear\" or \"nearest\"").or("\"bilinear\""),
        ],
        General(image),
        "A picture by (u, v), (0, 0) at its bottom left: PNG, JPEG, TGA, BMP, HDR or EXR. Colours are decoded from sRGB; for \
         properties that are numbers, and for normal maps, it is read as it is.",
        ("image(\"wood.png\", wrap: \"mirror\")", ""),
    ),
    Builtin::new(
        "from_hit",
        &[Parameter::new("f", "a function of one parameter")],
        General(from_hit),
        "A pattern from a function of the whole hit: `h.p` the point in the world, `h.n` the normal, `h.uv`, `h.t` \
         the distance along the ray.",
        ("from_hit(h => abs(h.n))", "a pattern"),
    ),
    Builtin::new(
        "weights_of",
        &[Parameter::new("joint", "a joint's name, bare or as a text")  .bare()],
        General(weights_of),
        "How much a joint moves each point of a skin, 0 to 1; 0 on what is no skin. In a `ramp`, a heat map.",
        ("ramp(weights_of(elbow), [0, navy], [0.5, yellow], [1, red])", "a pattern"),
    ),
    Builtin::new(
        "marble",
        TWO_OR,
        General(|ctx, arguments| of_two(ctx, arguments, PatternKind::Marble)),
        "Veins: from `a` to `b` and back once a unit along x, displaced by four octaves of noise.",
        ("marble(white, gray)", "a pattern"),
    ),
    Builtin::new(
        "wood",
        TWO_OR,
        General(|ctx, arguments| of_two(ctx, arguments, PatternKind::Wood)),
        "Rings about the y axis, one unit thick, each from `a` within to `b` without, a tenth of a unit out of round.",
        ("wood(maroon, olive)", "a pattern"),
    ),
];

const TWO_OR: &[Parameter] = &[
    Parameter::new("a", "a colour, a number, a pattern or a function").or("white"),
    Parameter::new("b", "a colour, a number, a pattern or a function").or("gray"),
];

/// The pattern that a function's bare name stands for in a texture's place: `noise`.
pub fn of_builtin(builtin: &Builtin, span: Option<Span>) -> Option<Pattern> {
    let span = span.unwrap_or(Span::new(crate::diag::SourceId(0), 0, 0));
    let kind = PatternKind::Noise(Texture::ZERO, Texture::number(1.0));
    (builtin.name == "noise").then_some(Pattern { kind, transform: None, span })
}

/// Patterns in a pattern, at most, each as often as it is written: every point of a surface may ask for all of them, one inside
/// the other.
const MOST_PATTERNS: usize = 1000;

fn made(ctx: &mut dyn Context, kind: PatternKind, span: Span) -> Outcome {
    let pattern = Pattern { kind, transform: None, span };
    let mut left = MOST_PATTERNS;
    if !fits(&pattern, &mut left) {
        let said = Diagnostic::new(
            Code::TooDeep,
            span,
            format!("this pattern is made of more than {MOST_PATTERNS} patterns"),
        )
        .label("one too many here")
        .hint("a function of the point, `p => …`, or a picture does with one what many patterns do together");
        return Err(ctx.fail(said));
    }
    Ok(Value::Pattern(Arc::new(pattern)))
}

/// Takes the patterns of a pattern from what is left; false where that is not enough.
fn fits(pattern: &Pattern, left: &mut usize) -> bool {
    if *left == 0 {
        return false;
    }
    *left -= 1;
    pattern.kind.parts().iter().all(|texture| match texture {
        Texture::Constant(_) => true,
        Texture::Pattern(inner) => fits(inner, left),
    })
}

fn textures(ctx: &mut dyn Context, arguments: &Arguments<'_>, from: usize) -> Outcome<Vec<Texture>> {
    let mut found = Vec::new();
    let mut outcome = Ok(());
    for i in from..arguments.values.len() {
        match texture(ctx, &arguments.values[i], arguments.spans[i]) {
            Ok(texture) => found.push(texture),
            Err(reported) => outcome = Err(reported),
        }
    }
    outcome.map(|()| found)
}

/// A pattern made of two textures.
fn of_two(
    ctx: &mut dyn Context,
    arguments: &Arguments<'_>,
    kind: fn(Texture, Texture) -> PatternKind,
) -> Outcome {
    let mut both = textures(ctx, arguments, 0)?.into_iter();
    let mut next = || both.next().unwrap_or(Texture::ZERO);
    let (a, b) = (next(), next());
    made(ctx, kind(a, b), arguments.span)
}

fn texture(ctx: &mut dyn Context, value: &Value, span: Span) -> Outcome<Texture> {
    let mut value = value.clone();
    check::coerce_or_report(ctx, "", &[Type::Texture], &mut value, span)?;
    Ok(coerce::texture(&value).expect("just made one"))
}

fn ramp(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let source = texture(ctx, &arguments.values[0], arguments.spans[0])?;
    let mut stops = Vec::new();
    for (value, span) in arguments.values.iter().zip(arguments.spans).skip(1) {
        stops.push(stop(ctx, value, *span)?);
    }
    if let Some(i) = (1..stops.len()).find(|i| stops[*i].0 < stops[i - 1].0) {
        let said = Diagnostic::new(
            Code::Undefined,
            arguments.spans[i + 1],
            format!(
                "the stops of a `ramp` must be in order, and {} comes after {}",
                stops[i].0,
                stops[i - 1].0
            ),
        )
        .also(arguments.spans[i], "the greater one is here")
        .hint("sort the stops by their positions");
        return Err(ctx.fail(said));
    }
    made(ctx, PatternKind::Ramp(source, stops), arguments.span)
}

fn stop(ctx: &mut dyn Context, value: &Value, span: Span) -> Outcome<(f64, Texture)> {
    if let Value::List(list) = value
        && let [Value::Number(t), colour] = &list[..]
        && t.is_finite()
    {
        return Ok((*t, texture(ctx, colour, span)?));
    }
    let said = Diagnostic::new(
        Code::TypeMismatch,
        span,
        format!(
            "a stop of a `ramp` is a list of a position and a colour, and this is {}",
            coerce::shown(value)
        ),
    )
    .hint("write `[0.5, white]`");
    Err(ctx.fail(said))
}

fn image(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let Value::Text(written) = &arguments.values[0] else {
        let builtin = super::find("image").expect("a function of the table");
        return Err(ctx.fail(super::wrong_argument(builtin, 0, &arguments.values[0], arguments.spans[0])));
    };
    let span = arguments.spans[0];
    let wrap = choice(
        ctx,
        arguments,
        1,
        "wrap",
        &[("repeat", Wrap::Repeat), ("clamp", Wrap::Clamp), ("mirror", Wrap::Mirror)],
    )?;
    let filter =
        choice(ctx, arguments, 2, "filter", &[("bilinear", Filter::Bilinear), ("nearest", Filter::Nearest)])?;
    let path = crate::lang::kinds::existing_file(ctx, written, span)?;
    let pattern = ImagePattern { path, wrap, filter, colour: true, span, picture: Picture::default() };
    made(ctx, PatternKind::Image(pattern), arguments.span)
}

/// One of some words, quoted as arguments are.
fn choice<T: Copy>(
    ctx: &mut dyn Context,
    arguments: &Arguments<'_>,
    i: usize,
    name: &str,
    choices: &[(&str, T)],
) -> Outcome<T> {
    if let Value::Text(text) = &arguments.values[i]
        && let Some((_, chosen)) = choices.iter().find(|(word, _)| *word == &**text)
    {
        return Ok(*chosen);
    }
    let words: Vec<String> = choices.iter().map(|(word, _)| format!("\"{word}\"")).collect();
    let said = Diagnostic::new(
        Code::UnknownWord,
        arguments.spans[i],
        format!(
            "`{name}` takes {}, not {}",
            coerce::listed(&words, "or"),
            crate::lang::display::display(&arguments.values[i])
        ),
    );
    Err(ctx.fail(match &arguments.values[i] {
        Value::Text(text) => said.did_you_mean(text, choices.iter().map(|(word, _)| *word)),
        _ => said,
    }))
}

fn weights_of(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let (Value::Text(joint) | Value::Word(joint)) = &arguments.values[0] else {
        let builtin = super::find("weights_of").expect("a function of the table");
        return Err(ctx.fail(super::wrong_argument(builtin, 0, &arguments.values[0], arguments.spans[0])));
    };
    made(ctx, PatternKind::Weight((**joint).into()), arguments.span)
}

fn from_hit(ctx: &mut dyn Context, arguments: &Arguments<'_>) -> Outcome {
    let function =
        ctx.sampled(&arguments.values[0], SampleInput::Hit, Gives::Components(&[1, 3]), arguments.spans[0])?;
    made(ctx, PatternKind::Function(function), arguments.span)
}
