//! Functions of geometry: not built yet.

use crate::lang::table::{Builtin, BuiltinBody::*, Parameter};

/// The family.
pub static ALL: &[Builtin] = &[
    Builtin::new(
        "trace",
        &[
            Parameter::new("object", "an object"),
            Parameter::new("origin", "a 3-vector"),
            Parameter::new("direction", "a 3-vector"),
        ],
        NotBuilt,
        "The hits of a ray with an object in order, each with `.t .point .normal .uv`.",
        ("trace(ball, <0, 0, 5>, -z)", ""),
    ),
    Builtin::new(
        "roots",
        &[Parameter::new("c0", "a number")],
        NotBuilt,
        "The real roots of the polynomial c0 + c1·t + c2·t² + …, in order.",
        ("roots(-1, 0, 1)", ""),
    )
    .variadic(),
    Builtin::new(
        "curve",
        &[
            Parameter::new("f", "a function"),
            Parameter::new("a", "a number"),
            Parameter::new("b", "a number"),
        ],
        NotBuilt,
        "The curve of a function over a … b.",
        ("curve(t => <t, t^2, 0>, 0, 1)", ""),
    ),
    Builtin::new(
        "weights_of",
        &[Parameter::new("joint", "a joint's name, in quotation marks")],
        NotBuilt,
        "A pattern that colours a skin by a joint's influence.",
        ("weights_of(\"elbow\")", ""),
    ),
];
