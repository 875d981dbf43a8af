//! Kinds that are not built yet: their properties are checked and documented all the same.

use crate::lang::table::{Kind, Property, Role, Type};

const fn unbuilt(
    name: &'static str,
    doc: &'static str,
    example: &'static str,
    role: Role,
    own: &'static [Property],
) -> Kind {
    Kind { name, doc, example, role, own, children: false, open: false, build: None }
}

/// A skinned surface.
pub static SKIN: Kind = unbuilt(
    "skin",
    "A surface that bends with a skeleton.",
    "skeleton arm { joint elbow { hinge z  tip hand { offset <5, 0, 0> } } }\npose bent { of arm  elbow 40 }\n\
     spline limb { natural <0, 0, 0>, <2, 0, 0>, <5, 0, 0> }\nskin { surface tube { along limb  radius 0.5 }  skeleton arm  pose bent }",
    Role::Object,
    &[
        Property::new("surface", &[&[Type::Object]], "", "any mesh-like object, in rest position").required(),
        Property::new("skeleton", &[&[Type::Skeleton]], "", "the skeleton that moves it").required(),
        Property::new("pose", &[&[Type::Pose]], "", "the pose it takes; the rest pose by default"),
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
        Property::new("pose", &[&[Type::Pose]], "", "a pose, instead of a clip"),
        Property::new("show", &[&[Type::Word(&["bones"])]], "", "draws the skeleton"),
    ],
);
