//! A scene once evaluated: plain data with spans. Nothing is loaded, tessellated or flattened here; the world does that
//! for what a picture needs. Colours are linear RGB.

pub mod assets;
pub mod camera;
pub mod light;
pub mod material;
pub mod model;
pub mod object;
pub mod rig;
pub mod settings;
pub mod skin;
mod solid;
pub mod surface;

pub use camera::{Camera, Projection};
pub use light::{Light, LightSource, Sky};
pub use material::{
    Filter, Fresnel, ImagePattern, Layers, Lobe, Material, Pattern, PatternKind, SampleInput,
    SampledFunction, Texture, Wrap,
};
pub use model::{ModelSource, Moment};
pub use object::{
    Cone, Csg, CsgOp, Disc, Hide, Implicit, MeshSource, Node, Object, Rect, Shape, Torus, Triangle,
};
pub use rig::{Figure, Motion, Pose, Reach, Rig, Stance};
pub use settings::{Accelerator, PixelFilter, RenderSettings, SamplerKind, ToneMap, TracerKind};
pub use skin::{Armature, Skin, SkinSurface, Weights, divided_weights, unusable_weights};
pub use solid::{open_mesh, solid_fault};
pub use surface::{
    Along, ExtrudeSource, LatheSource, PatchMethod, PatchNet, PatchSource, Radius, Surface, TubeSource,
};

/// A colour or any triple of linear RGB: red, green, blue.
pub type Rgb = glam::DVec3;

/// Everything a file says, in the order it says it.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Objects and lights at top level.
    pub nodes: Vec<Node>,
    /// Cameras; the first is used unless another is named.
    pub cameras: Vec<Camera>,
    /// What the `render` block says.
    pub render: RenderSettings,
    /// The skeletons and poses that it names, at top level.
    pub figures: Vec<Figure>,
}
