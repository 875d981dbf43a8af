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
