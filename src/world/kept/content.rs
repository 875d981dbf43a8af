//! What something is made of, number by number and bit by bit, so that the same can be told in another frame. Lists tell their lengths, so
//! that no two contents are written alike.

use crate::geometry::curve::Curve;
use crate::geometry::measured::{Made, Measured};
use crate::geometry::mesh::Mesh;
use crate::geometry::patch::{Layout, Patch};
use crate::geometry::skin::{Influences, Motion};
use crate::geometry::surface::tube::Caps;
use crate::math::field::Field;
use crate::math::{Affine, Point};
use crate::scene::{
    Along, Armature, ExtrudeSource, LatheSource, MeshSource, PatchMethod, PatchNet, PatchSource, Radius,
    SampledFunction, Skin, SkinSurface, Surface, TubeSource, Weights,
};
use glam::{DMat3, DVec3};
use std::path::Path;

/// What is made of a content: each has a type of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::world) enum Of {
    /// Triangles with their tree, of a mesh.
    Mesh,
    /// The same of a patch, as finely as it is seen.
    Tessellation,
    /// The same of a skin in its pose.
    Skin,
    /// What a skin's points weigh at rest.
    Weights,
    /// The kernel of a surface along curves.
    Swept,
    /// The cells of an implicit surface.
    Implicit,
}

impl Of {
    /// Whether it takes so long to make that one world asks for it again: cells take a quarter of a second, and a loop may write the same formula in
    /// each of its turns.
    pub fn is_dear(self) -> bool {
        match self {
            Of::Implicit => true,
            Of::Mesh | Of::Tessellation | Of::Skin | Of::Weights | Of::Swept => false,
        }
    }
}

/// What something is made of. Functions count as the same where they run the same steps on the same numbers.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(in crate::world) struct Content {
    of: Of,
    words: Vec<u64>,
    functions: Vec<Field>,
}

impl Content {
    pub fn new(of: Of) -> Content {
        Content { of, words: Vec::new(), functions: Vec::new() }
    }

    /// A count, a choice, a place in a text.
    pub fn word(&mut self, word: usize) {
        self.words.push(word as u64);
    }

    pub fn number(&mut self, x: f64) {
        self.words.push(x.to_bits());
    }

    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        self.words.extend(numbers.into_iter().map(f64::to_bits));
    }

    pub fn point(&mut self, p: DVec3) {
        self.numbers(p.to_array());
    }

    pub fn points(&mut self, points: &[DVec3]) {
        self.word(points.len());
        points.iter().for_each(|p| self.point(*p));
    }

    /// What may be missing.
    pub fn maybe<T>(&mut self, value: Option<T>, write: impl FnOnce(&mut Content, T)) {
        self.word(usize::from(value.is_some()));
        if let Some(value) = value {
            write(self, value);
        }
    }

    fn text(&mut self, bytes: &[u8]) {
        self.word(bytes.len());
        self.words.extend(bytes.iter().map(|b| u64::from(*b)));
    }

    fn path(&mut self, path: &Path) {
        self.text(path.as_os_str().as_encoded_bytes());
    }

    /// A function, with its places in the text: its faults are told there.
    pub fn function(&mut self, function: &SampledFunction) {
        let SampledFunction { field, input, span, sites } = function;
        self.word(*input as usize);
        self.word(sites.len());
        for place in sites.iter().chain([span]) {
            self.words.extend([place.source.0, place.start, place.end].map(u64::from));
        }
        self.functions.push(field.clone());
    }

    pub fn mesh(&mut self, mesh: &Mesh) {
        let Mesh { positions, normals, uvs, triangles, material_of_triangle } = mesh;
        self.points(positions);
        self.points(normals);
        self.word(uvs.len());
        self.numbers(uvs.iter().flat_map(|uv| uv.to_array()));
        self.word(triangles.len());
        self.words.extend(triangles.iter().flatten().map(|i| u64::from(*i)));
        self.word(material_of_triangle.len());
        self.words.extend(material_of_triangle.iter().map(|i| u64::from(*i)));
    }

    pub fn patch(&mut self, patch: &Patch) {
        match patch.layout() {
            Layout::Grid { rows, columns } => [1, rows, columns].map(|n| self.word(n)),
            Layout::Loose => [0; 3].map(|n| self.word(n)),
        };
        self.word(patch.pieces().len());
        patch.pieces().iter().flat_map(|piece| piece.points.iter().flatten()).for_each(|p| self.point(*p));
    }

    /// A surface along curves, or a patch; that of a file by its path.
    pub fn surface(&mut self, surface: &Surface) {
        match surface {
            Surface::Patch(PatchSource { net, method, tolerance }) => {
                self.word(0);
                match net {
                    PatchNet::Inline(patch) => self.maybe(Some(patch), Content::patch),
                    PatchNet::File { path, .. } => {
                        self.word(0);
                        self.path(path);
                    }
                }
                self.word(usize::from(*method == Some(PatchMethod::Direct)));
                self.maybe(*tolerance, Content::number);
            }
            Surface::Tube(tube) => self.tube(tube),
            Surface::Lathe(LatheSource { profile, angle }) => {
                self.word(2);
                self.curve(profile);
                self.number(*angle);
            }
            Surface::Extrude(ExtrudeSource { outline, along }) => {
                self.word(3);
                self.curve(outline);
                match along {
                    Along::Vector(v) => self.maybe(Some(*v), Content::point),
                    Along::Path(path) => {
                        self.word(0);
                        self.curve(path);
                    }
                }
            }
        }
    }

    fn tube(&mut self, tube: &TubeSource) {
        self.word(1);
        self.curve(&tube.along);
        match &tube.radius {
            Radius::Constant(radius) => self.maybe(Some(*radius), Content::number),
            Radius::Along(curve) => {
                self.word(0);
                self.curve(curve);
            }
        }
        self.word(match tube.caps {
            Caps::Round => 0,
            Caps::Flat => 1,
            Caps::Open => 2,
        });
    }

    fn curve<P: Point>(&mut self, curve: &Measured<P>) {
        match curve.made() {
            Made::Spline(spline) => {
                self.word(usize::from(spline.closed()));
                self.spline(spline);
            }
            Made::Function(path) => {
                self.word(2);
                self.word(path.panels().len());
                for (start, end, coefficients) in path.panels() {
                    self.numbers([start, end]);
                    coefficients.iter().for_each(|c| self.coordinates(c));
                }
            }
        }
    }

    fn spline<P: Point>(&mut self, spline: &Curve<P>) {
        self.word(spline.pieces().len());
        for piece in spline.pieces() {
            self.numbers([piece.start(), piece.end()]);
            for point in piece.exact_points() {
                self.coordinates(&point.hi);
                self.coordinates(&point.lo);
            }
        }
    }

    fn coordinates<P: Point>(&mut self, p: &P) {
        self.numbers((0..P::DIMENSION).map(|i| p.coordinate(i)));
    }

    /// A skin in its pose.
    pub fn skin(&mut self, skin: &Skin) {
        let Skin { surface, transform, armature, weights, blend, tolerance } = skin;
        match surface {
            SkinSurface::Mesh(source) => match &**source {
                MeshSource::Inline(mesh) => {
                    self.word(0);
                    self.mesh(mesh);
                }
                MeshSource::File { path, smooth, .. } => {
                    self.word(1);
                    self.path(path);
                    self.maybe(*smooth, |content, smooth| content.word(usize::from(smooth)));
                }
            },
            SkinSurface::Curved(surface) => {
                self.word(2);
                self.surface(surface);
            }
        }
        self.maybe(transform.as_ref(), Content::transform);
        self.bones(armature);
        self.poses(armature);
        self.weights(weights);
        self.word(*blend as usize);
        self.maybe(*tolerance, Content::number);
    }

    fn transform(&mut self, transform: &Affine) {
        self.matrix(&transform.linear);
        self.point(transform.translation);
        self.matrix(&transform.inverse_linear);
        self.point(transform.inverse_translation);
    }

    fn matrix(&mut self, matrix: &DMat3) {
        self.numbers(matrix.to_cols_array());
    }

    /// Where bones are at rest.
    pub fn bones(&mut self, armature: &Armature) {
        self.word(armature.bones.len());
        for bone in &armature.bones {
            self.word(bone.joint);
            self.point(bone.start);
            self.point(bone.end);
        }
    }

    /// Where joints are taken, with their names: patterns ask for them.
    fn poses(&mut self, armature: &Armature) {
        self.word(armature.names.len());
        armature.names.iter().for_each(|name| self.text(name.as_bytes()));
        self.word(armature.motions.len());
        for Motion { pivot, shift, change, turn, stretch } in &armature.motions {
            self.point(*pivot);
            self.point(*shift);
            self.matrix(change);
            self.numbers(turn.to_array());
            self.matrix(stretch);
        }
    }

    /// The law of a skin's weights.
    pub fn weights(&mut self, weights: &Weights) {
        match weights {
            Weights::Rigid => self.word(0),
            Weights::Smooth(most) => [1, *most].into_iter().for_each(|n| self.word(n)),
            Weights::Listed(rows, _) => {
                self.word(2);
                self.rows(rows);
            }
            Weights::Function(function, _) => {
                self.word(3);
                self.function(function);
            }
        }
    }

    fn rows(&mut self, rows: &Influences) {
        self.word(rows.len());
        for k in 0..rows.len() {
            let (joints, weights) = rows.of(k);
            self.word(joints.len());
            joints.iter().for_each(|joint| self.word(usize::from(*joint)));
            self.numbers(weights.iter().copied());
        }
    }
}
