//! The kind `skin`: a surface that bends with a skeleton. Faults that need no vertices are said here; the kernels and the world do the rest.

pub(super) mod bones;
mod weights;

use super::shapes::finish;
use crate::diag::{Code, Diagnostic, Span};
use crate::geometry::skin::{Blend, Motion};
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Reported, Role, Type};
use crate::lang::value::Value;
use crate::math::Affine;
use crate::scene::{Armature, Node, Object, Shape, Skin, SkinSurface, Stance, Weights};
use std::sync::Arc;

/// A skinned surface.
pub static SKIN: Kind = Kind {
    name: "skin",
    doc: "A surface that bends with a skeleton. `surface` stands where the skeleton's joints are at rest. A patch, tube, lathe or extrude is cut \
          into triangles as finely as the picture and its motion ask; a mesh keeps its vertices. Patterns stay where they are at rest.",
    example: "skeleton arm { joint upper { hinge z  joint lower { offset <2, 0, 0>  hinge z  tip hand { offset <2, 0, 0> } } } }\n\
              spline limb { natural arm.upper.position, arm.lower.position, arm.hand }\n\
              pose bent { of arm  lower 60 }\n\
              skin { surface tube { along limb  radius 0.4 }  skeleton arm  pose bent }",
    role: Role::Object,
    own: &[
        Property::new(
            "surface",
            &[&[Type::Object]],
            "",
            "a mesh, patch, tube, lathe or extrude in rest position, or a group of them",
        )
        .required(),
        Property::new("skeleton", &[&[Type::Skeleton]], "", "the skeleton that moves it").required(),
        Property::new("pose", &[&[Type::Pose]], "", "the pose it takes; the rest pose by default"),
        Property::new(
            "weights",
            &[&[Type::Word(&["rigid", "smooth"])], &[Type::List], &[Type::Function]],
            "smooth",
            "how much each joint moves each point: `rigid`, all by the nearest bone; `smooth`, by (1/d − 1/R)⁴, d the distance from the joint's bones \
             and R that of the first joint that does not count any more; a list with a row for each vertex of a mesh; or a function of the point at \
             rest. A row has a weight of 0 or more for each joint in the order of `skeleton.joints`; those left out are 0, and all of a row add up to 1",
        ),
        Property::new(
            "influences",
            &[&[Type::Integer { min: 1 }]],
            "4",
            "of `smooth`: most joints that move one point; listed weights all count",
        ),
        Property::new(
            "blend",
            &[&[Type::Word(&["linear", "dual_quaternion"])]],
            "linear",
            "how the joints' motions are mixed: places averaged, so that half of a twist by α shrinks to cos(α/2); or turns averaged, so that \
             it keeps its width",
        ),
        Property::new(
            "tolerance",
            &[&[Type::Positive]],
            "",
            "largest distance of triangles from a bent curved surface, in scene units; by default under a quarter pixel",
        ),
        Property::new(
            "show",
            &[&[Type::Word(&["bones"])]],
            "",
            "`bones`: draws the skeleton in place of the surface",
        ),
    ],
    children: false,
    open: false,
    build: Some(skin),
};

fn skin(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let stance = stance(ctx, block)?;
    let surface = block.object("surface").expect("checked to be there");
    if block.has("show") {
        return finish(ctx, block, bones::drawn(&stance, block.span));
    }
    let skeleton = &stance.rig().skeleton;
    let weights = weights::of(ctx, block, skeleton.joints().len(), &surface)?;
    let making = Making {
        armature: Arc::new(armature(&stance)),
        weights,
        blend: blend(block),
        tolerance: block.number("tolerance"),
        at: block.place("surface"),
    };
    let mut whole = making.part(ctx, &surface, None)?;
    whole.span = block.span;
    super::common::apply_to_object(ctx, &mut whole, &block.given)?;
    Ok(Value::Object(Arc::new(whole)))
}

/// What of a skin a copy may have otherwise.
pub const CHANGEABLE: [&str; 3] = ["pose", "blend", "tolerance"];

/// A skin, bent otherwise. The pose must be of a skeleton that is at rest as the skin's.
pub fn changed(ctx: &mut dyn Context, block: &Block, skin: &Skin) -> Outcome<Arc<Skin>> {
    let mut copy = skin.clone();
    if let Some(Value::Pose(pose)) = block.value("pose") {
        let armature = armature(&Stance::Posed(pose.clone()));
        if armature.names != skin.armature.names || armature.bones != skin.armature.bones {
            let message = "this pose is one of another skeleton";
            let hint = "make the pose `of` the skeleton of the skin";
            return Err(block.fault(ctx, Code::BadProperty, "pose", message, hint));
        }
        copy.armature = Arc::new(armature);
    }
    if block.has("blend") {
        copy.blend = blend(block);
    }
    copy.tolerance = block.number("tolerance").or(skin.tolerance);
    Ok(Arc::new(copy))
}

fn blend(block: &Block) -> Blend {
    match block.word("blend") {
        Some("dual_quaternion") => Blend::DualQuaternion,
        _ => Blend::Linear,
    }
}

/// The skeleton in its pose, which must be one of it.
fn stance(ctx: &mut dyn Context, block: &Block) -> Outcome<Stance> {
    let Some(Value::Skeleton(rig)) = block.value("skeleton") else {
        unreachable!("checked to be a skeleton")
    };
    match block.value("pose") {
        None => Ok(Stance::Rest(rig.clone())),
        Some(Value::Pose(pose)) if pose.rig.skeleton == rig.skeleton => Ok(Stance::Posed(pose.clone())),
        Some(_) => {
            let message = "this pose is one of another skeleton";
            let said = Diagnostic::new(Code::BadProperty, block.place("pose"), message)
                .also(block.place("skeleton"), "the skin's skeleton is this")
                .hint("make the pose `of` the skeleton of the skin");
            Err(ctx.fail(said))
        }
    }
}

/// The bones at rest, and what the pose does to each joint.
fn armature(stance: &Stance) -> Armature {
    let rig = stance.rig();
    let (rest, posed) = (rig.rest.affines(), stance.placement().affines());
    Armature {
        names: rig.skeleton.joints().iter().map(|joint| joint.name.as_str().into()).collect(),
        bones: rig.rest.bones(&rig.skeleton),
        motions: rest.iter().zip(&posed).map(|(rest, posed)| Motion::new(rest, posed)).collect(),
    }
}

/// What all parts of a skin share.
struct Making {
    armature: Arc<Armature>,
    weights: Weights,
    blend: Blend,
    tolerance: Option<f64>,
    at: Span,
}

impl Making {
    /// An object bent: as it is, or each of its parts. `around` is the transform of the groups it is in.
    fn part(&self, ctx: &mut dyn Context, object: &Object, around: Option<Affine>) -> Outcome<Object> {
        let own = object.transform.as_deref().copied();
        let transform = [own, around].into_iter().flatten().reduce(|inner, outer| inner.then(&outer));
        let shape = match &object.shape {
            Shape::Mesh(mesh) => self.bent(SkinSurface::Mesh(mesh.clone()), transform),
            Shape::Surface(surface) => self.bent(SkinSurface::Curved(surface.clone()), transform),
            Shape::Group(nodes) => {
                let parts: Outcome<Vec<Node>> =
                    nodes.iter().map(|node| self.node(ctx, node, transform)).collect();
                Shape::Group(parts?.into())
            }
            _ => return Err(self.unbendable(ctx)),
        };
        Ok(Object { shape, transform: None, ..object.clone() })
    }

    fn node(&self, ctx: &mut dyn Context, node: &Node, around: Option<Affine>) -> Outcome<Node> {
        match node {
            Node::Object(object) => Ok(Node::Object(Arc::new(self.part(ctx, object, around)?))),
            Node::Light(_) => Err(self.unbendable(ctx)),
        }
    }

    fn bent(&self, surface: SkinSurface, transform: Option<Affine>) -> Shape {
        Shape::Skin(Arc::new(Skin {
            surface,
            transform,
            armature: self.armature.clone(),
            weights: self.weights.clone(),
            blend: self.blend,
            tolerance: self.tolerance,
        }))
    }

    fn unbendable(&self, ctx: &mut dyn Context) -> Reported {
        let message = "only a mesh, patch, tube, lathe or extrude bends with a skeleton, or a group of them";
        let hint = "a `lathe` or `tube` has the shape of a sphere, cone or cylinder, and bends";
        ctx.fail(Diagnostic::new(Code::BadProperty, self.at, message).hint(hint))
    }
}
