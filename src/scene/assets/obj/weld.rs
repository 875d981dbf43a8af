//! Corners joined into vertices: what agrees in position, texture coordinate and normal is one vertex.
//!
//! A normal is a *slot*: one of the file's, or one to be computed from the faces of a smoothing group around a position, or
//! a single face's own. Slots are numbered before their normals are known, so that a seam of texture coordinates makes no
//! crease.

use super::numbers::{NONE, Numbers};
use super::scan::{FaceState, NO_MATERIAL, Scan};
use crate::geometry::mesh::{Mesh, OBJECT_MATERIAL, Triangulator, angle_weighted_normals, has_area, unit};
use glam::DVec3;
use std::collections::HashMap;

/// A mesh, and what was left out of it.
pub(super) struct Welded {
    pub mesh: Mesh,
    /// Faces of which no triangle has an area.
    pub flat_faces: usize,
}

/// The smoothing group of corners whose file has normals but not for them, or not of any length.
const NO_GROUP: u32 = u32::MAX;

/// Makes the mesh. `materials` gives the material index of each `usemtl` name. `smooth` overrules the file: on, all is one
/// smooth surface; off, all faces are flat.
pub(super) fn weld(numbers: &Numbers, scan: &Scan<'_>, materials: &[u16], smooth: Option<bool>) -> Welded {
    let shading = Shading::of(numbers, scan, smooth);
    let mut welder = Welder::new(numbers, shading);
    let mut polygons = Triangulator::default();
    let (mut first, mut flat_faces) = (0, 0);
    let mut runs = scan.runs.iter().peekable();
    let mut state = None;
    for face in 0..scan.n_faces {
        if let Some((_, now)) = runs.next_if(|(start, _)| *start == face) {
            state = Some(now);
        }
        let state = state.expect("the first run starts at face 0");
        let n = numbers.arities.get(face).map_or(3, |n| *n as usize);
        let material = materials.get(state.material as usize).copied().unwrap_or(OBJECT_MATERIAL);
        let outline = once_round(&numbers.position_of[first..first + n]);
        let points = outline.iter().map(|i| numbers.positions[*i as usize]);
        let before = welder.mesh.triangles.len();
        welder.begin_face(state);
        for triangle in polygons.polygon(points) {
            welder.triangle(triangle.map(|corner| first + corner as usize), material);
        }
        flat_faces += usize::from(welder.mesh.triangles.len() == before);
        first += n;
    }
    Welded { mesh: welder.finish(), flat_faces }
}

/// A face's corners without the further rounds of one that goes round its outline again and again.
fn once_round(corners: &[u32]) -> &[u32] {
    let n = corners.len();
    let goes_round = |p: &usize| n.is_multiple_of(*p) && corners[*p..] == corners[..n - p];
    if n < 6 { corners } else { &corners[..(3..=n / 2).find(goes_round).unwrap_or(n)] }
}

/// How normals are found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shading {
    /// No normals.
    Flat,
    /// As the file says.
    File,
    /// Computed over all faces at a place.
    Smooth,
}

impl Shading {
    fn of(numbers: &Numbers, scan: &Scan<'_>, smooth: Option<bool>) -> Shading {
        let any_normal = scan.runs.iter().any(|(_, s)| s.has_normals) && !numbers.normals.is_empty();
        let any_group = scan.runs.iter().any(|(_, s)| s.smoothing != 0);
        match smooth {
            Some(true) => Shading::Smooth,
            Some(false) => Shading::Flat,
            None if any_normal || any_group => Shading::File,
            None => Shading::Flat,
        }
    }
}

struct Vertex {
    uv: u32,
    slot: u32,
    /// The next vertex at the same position.
    next: u32,
}

struct Welder<'n> {
    numbers: &'n Numbers,
    shading: Shading,
    mesh: Mesh,
    /// The first vertex at each position.
    first_at: Vec<u32>,
    vertices: Vec<Vertex>,
    /// Normals of the file's slots, which come first; zero where one has no length.
    file_normals: Vec<DVec3>,
    n_slots: u32,
    /// The first smoothing group at each position, and its slot; further ones are in `slot_of_group`.
    first_group_at: Vec<(u32, u32)>,
    slot_of_group: HashMap<(u32, u32), u32>,
    /// The position that stands for all at the same place, where the whole is smooth.
    same_place: Vec<u32>,
    state: FaceState,
    /// The slot of the flat face at hand, once it has one.
    face_slot: u32,
    any_material: bool,
}

impl<'n> Welder<'n> {
    fn new(numbers: &'n Numbers, shading: Shading) -> Self {
        let file_normals: Vec<DVec3> = match shading {
            Shading::File => numbers.normals.iter().map(|n| unit(*n).unwrap_or(DVec3::ZERO)).collect(),
            Shading::Flat | Shading::Smooth => Vec::new(),
        };
        let same_place = match shading {
            Shading::Smooth => positions_by_place(&numbers.positions),
            Shading::Flat | Shading::File => Vec::new(),
        };
        let n_slots = if shading == Shading::Smooth { numbers.positions.len() } else { file_normals.len() };
        Welder {
            numbers,
            shading,
            mesh: Mesh::default(),
            first_at: vec![NONE; numbers.positions.len()],
            vertices: Vec::with_capacity(numbers.positions.len()),
            file_normals,
            n_slots: n_slots as u32,
            first_group_at: Vec::new(),
            slot_of_group: HashMap::new(),
            same_place,
            state: FaceState { material: NO_MATERIAL, smoothing: 0, has_uvs: false, has_normals: false },
            face_slot: NONE,
            any_material: false,
        }
    }

    fn begin_face(&mut self, state: &FaceState) {
        self.state = *state;
        self.face_slot = NONE;
    }

    fn triangle(&mut self, corners: [usize; 3], material: u16) {
        let positions = corners.map(|c| self.numbers.position_of[c]);
        if !has_area(positions.map(|p| self.numbers.positions[p as usize])) {
            return;
        }
        let triangle = corners.map(|c| self.vertex(c));
        self.mesh.triangles.push(triangle);
        self.mesh.material_of_triangle.push(material);
        self.any_material |= material != OBJECT_MATERIAL;
    }

    /// The vertex of a corner, new or found again.
    fn vertex(&mut self, corner: usize) -> u32 {
        let position = self.numbers.position_of[corner];
        let uv =
            if self.state.has_uvs { self.numbers.uv_of.get(corner).copied().unwrap_or(NONE) } else { NONE };
        let slot = self.slot(corner, position);
        let first = self.first_at[position as usize];
        let mut at = first;
        while at != NONE {
            let vertex = &self.vertices[at as usize];
            if vertex.uv == uv && vertex.slot == slot {
                return at;
            }
            at = vertex.next;
        }
        let new = self.vertices.len() as u32;
        self.vertices.push(Vertex { uv, slot, next: first });
        self.mesh.positions.push(self.numbers.positions[position as usize]);
        self.first_at[position as usize] = new;
        new
    }

    fn slot(&mut self, corner: usize, position: u32) -> u32 {
        match self.shading {
            Shading::Flat => NONE,
            Shading::Smooth => self.same_place[position as usize],
            Shading::File => self.slot_of_file(corner, position),
        }
    }

    fn slot_of_file(&mut self, corner: usize, position: u32) -> u32 {
        if self.state.has_normals
            && let Some(&normal) = self.numbers.normal_of.get(corner).filter(|normal| **normal != NONE)
        {
            return match self.file_normals[normal as usize] != DVec3::ZERO {
                true => normal,
                false => self.group_slot(position, NO_GROUP),
            };
        }
        match self.state.smoothing {
            0 => self.flat_slot(),
            group => self.group_slot(position, group),
        }
    }

    fn group_slot(&mut self, position: u32, group: u32) -> u32 {
        self.first_group_at.resize(self.numbers.positions.len(), (NONE, NONE));
        let (first_group, first_slot) = &mut self.first_group_at[position as usize];
        if *first_slot != NONE && *first_group == group {
            return *first_slot;
        }
        let new = self.n_slots;
        if *first_slot == NONE {
            (*first_group, *first_slot) = (group, new);
            self.n_slots += 1;
            return new;
        }
        let slot = *self.slot_of_group.entry((position, group)).or_insert(new);
        self.n_slots += u32::from(slot == new);
        slot
    }

    fn flat_slot(&mut self) -> u32 {
        if self.face_slot == NONE {
            self.face_slot = self.n_slots;
            self.n_slots += 1;
        }
        self.face_slot
    }

    fn finish(mut self) -> Mesh {
        self.mesh.normals = self.normals();
        if self.vertices.iter().any(|v| v.uv != NONE) {
            let uv = |v: &Vertex| self.numbers.uvs.get(v.uv as usize).copied().unwrap_or_default();
            self.mesh.uvs = self.vertices.iter().map(uv).collect();
        }
        if !self.any_material {
            self.mesh.material_of_triangle = Vec::new();
        }
        self.mesh
    }

    /// One per vertex, or none.
    fn normals(&self) -> Vec<DVec3> {
        if self.shading == Shading::Flat {
            return Vec::new();
        }
        let n_given = self.file_normals.len();
        let mut slots = self.file_normals.clone();
        if self.n_slots as usize > n_given {
            let triangles = self.mesh.triangles.iter().map(|t| {
                let corner = |v: u32| self.mesh.positions[v as usize];
                (t.map(|v| self.vertices[v as usize].slot), t.map(corner))
            });
            let computed = angle_weighted_normals(self.n_slots as usize, triangles);
            slots.extend_from_slice(&computed[n_given..]);
        }
        self.vertices.iter().map(|v| slots[v.slot as usize]).collect()
    }
}

/// For each position, the first one at the same place.
fn positions_by_place(positions: &[DVec3]) -> Vec<u32> {
    let mut first_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(positions.len());
    let numbered = positions.iter().zip(0..);
    // Adding 0 makes −0 the same place as 0.
    numbered.map(|(p, i)| *first_at.entry(p.to_array().map(|x| (x + 0.0).to_bits())).or_insert(i)).collect()
}
