//! Kinds that are not built yet: their properties are checked and documented all the same.

use crate::lang::table::{Kind, Property, Role, Type};

const ANY: &[&[Type]] = &[&[Type::Unbuilt]];

const fn unbuilt(
    name: &'static str,
    doc: &'static str,
    example: &'static str,
    role: Role,
    own: &'static [Property],
) -> Kind {
    Kind { name, doc, example, role, own, children: false, open: false, build: None }
}

const fn with_children(kind: Kind) -> Kind {
    Kind { children: true, ..kind }
}

const fn open(kind: Kind) -> Kind {
    Kind { open: true, ..kind }
}

/// A skinned surface.
pub static SKIN: Kind = unbuilt(
    "skin",
    "A surface that bends with a skeleton.",
    "spline limb { natural x, y, z }\nskin { surface tube { along limb  radius 0.5 }  skeleton arm  pose touch }",
    Role::Object,
    &[
        Property::new("surface", &[&[Type::Object]], "", "any mesh-like object, in rest position").required(),
        Property::new("skeleton", ANY, "", "the skeleton that moves it").required(),
        Property::new("pose", ANY, "", "the pose it takes; the rest pose by default"),
        Property::new(
            "weights",
            &[&[Type::Word(&["rigid", "smooth"])], &[Type::List], &[Type::Function]],
            "smooth",
            "how much each joint moves each vertex: by rule, as a list for each vertex, or a function of the point",
        ),
        Property::new("influences", &[&[Type::Integer { min: 1 }]], "4", "most joints that move one vertex"),
        Property::new(
            "blend",
            &[&[Type::Word(&["linear", "dual_quaternion"])]],
            "linear",
            "how the joints' motions are mixed",
        ),
        Property::new("show", &[&[Type::Word(&["bones"])]], "", "draws the skeleton"),
    ],
);

/// A glTF model.
pub static MODEL: Kind = unbuilt(
    "model",
    "A glTF 2.0 model with its hierarchy, materials, textures and skins.",
    "model { file \"man.glb\"  at 0.6 }",
    Role::Object,
    &[
        Property::new("file", &[&[Type::Text]], "", "a .glb or .gltf file").required(),
        Property::new("clip", &[&[Type::Text]], "", "the animation; the first by default"),
        Property::new("at", &[&[Type::NUMBER]], "0", "the moment of the clip, in seconds"),
        Property::new("pose", ANY, "", "a pose, instead of a clip"),
        Property::new("show", &[&[Type::Word(&["bones"])]], "", "draws the skeleton"),
    ],
);

/// A skeleton.
pub static SKELETON: Kind = with_children(unbuilt(
    "skeleton",
    "A tree of joints.",
    "skeleton arm { joint shoulder { hinge z  joint elbow { offset <5, 0, 0>  hinge z  tip hand { offset <4, 0, 0> } } } }",
    Role::Value,
    &[Property::new("file", &[&[Type::Text]], "", "a .bvh file of motion capture")],
));

/// A joint.
pub static JOINT: Kind = with_children(unbuilt(
    "joint",
    "A joint of a skeleton, with what it may do, its angles at rest, and the joints and tips that hang on it.",
    "skeleton s { joint elbow { offset <5, 0, 0>  hinge z  angle 50  limits 0, 150 } }",
    Role::Part,
    &[
        Property::new("offset", &[&[Type::Vector3]], "<0, 0, 0>", "from the joint above it, in scene units"),
        Property::new("fixed", &[&[]], "", "does not move"),
        Property::new("hinge", &[&[Type::Direction]], "", "turns about this axis"),
        Property::new("universal", &[&[Type::Direction, Type::Direction]], "", "turns about two axes"),
        Property::new("ball", &[&[]], "", "turns freely, by `angles`"),
        Property::new("slide", &[&[Type::Direction]], "", "moves along this axis"),
        Property::new("free", &[&[]], "", "moves and turns freely"),
        Property::new("angle", &[&[Type::NUMBER]], "0", "at rest, in degrees (of a slide, in scene units)"),
        Property::new("angles", &[&[Type::Vector3], &[Type::Vector2]], "<0, 0, 0>", "at rest, in degrees"),
        Property::new("limits", &[&[Type::NUMBER, Type::NUMBER]], "", "least and most, in degrees"),
    ],
));

/// The end of a chain.
pub static TIP: Kind = unbuilt(
    "tip",
    "The end of a chain of joints: what reaches for things.",
    "skeleton s { joint wrist { hinge z  tip hand { offset <1, 0, 0> } } }",
    Role::Part,
    &[Property::new("offset", &[&[Type::Vector3]], "<0, 0, 0>", "from its joint, in scene units")],
);

/// A pose.
pub static POSE: Kind = open(unbuilt(
    "pose",
    "Angles for the joints of a skeleton, given or found by inverse kinematics. A joint's name is a property.",
    "pose touch { of arm  reach hand, <6, 3, 0>  method dls }",
    Role::Value,
    &[
        Property::new("of", ANY, "", "the skeleton").required(),
        Property::new(
            "reach",
            &[&[Type::Label, Type::Vector3]],
            "",
            "a tip, and the point where it should be",
        )
        .repeats(),
        Property::new("weight", &[&[Type::NON_NEGATIVE]], "1", "of the target before it").repeats(),
        Property::new("toward", &[&[Type::Direction]], "", "where the tip before it should point").repeats(),
        Property::new(
            "method",
            &[&[Type::Word(&["jacobian_transpose", "pseudo_inverse", "dls", "ccd"])]],
            "dls",
            "how the angles are found",
        ),
        Property::new("iterations", &[&[Type::Integer { min: 1 }]], "200", "most steps"),
        Property::new(
            "tolerance",
            &[&[Type::Positive]],
            "1e-9",
            "distance from the target that is good enough",
        ),
        Property::new("at", &[&[Type::NUMBER]], "0", "the moment of motion capture, in seconds"),
    ],
));
