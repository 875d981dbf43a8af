//! Mesh and group.

use super::shapes::{conflict, finish};
use crate::diag::{Code, Diagnostic};
use crate::geometry::mesh::Mesh;
use crate::lang::coerce;
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Reported, Role, Type};
use crate::lang::value::Value;
use crate::scene::{MeshSource, Shape};
use std::sync::Arc;

/// A mesh.
pub static MESH: Kind = Kind {
    name: "mesh",
    doc: "Triangles that share corners, from an OBJ file (with its .mtl and textures) or from lists; solid where closed. \
          A file is read when a picture needs it.",
    example: "mesh { vertices <-1, 0, 0>, <1, 0, 0>, <1, 1, 0>, <-1, 1, 0>  faces [<0, 1, 2, 3>] }",
    role: Role::Object,
    own: &[
        Property::new("file", &[&[Type::Text]], "", "an OBJ file, relative to the file that writes it"),
        Property::new(
            "smooth",
            &[&[], &[Type::Bool]],
            "",
            "`on` shades smoothly over edges, `off` shades flat; without it the file's normals and smoothing groups count",
        ),
        Property::new("vertices", &[&[Type::Vector3]], "", "the corners, in scene units; instead of `file`").many(),
        Property::new(
            "faces",
            &[&[Type::Any]],
            "",
            "which corners make each face, counted from 0: vectors of 3 or 4 (or lists of more, in one plane), \
             counterclockwise seen from outside",
        )
        .many(),
        Property::new("normals", &[&[Type::Direction]], "", "a normal for each corner, for smooth shading").many(),
        Property::new("uvs", &[&[Type::Vector2]], "", "texture coordinates for each corner").many(),
    ],
    children: false,
    open: false,
    build: Some(mesh),
};

/// A group.
pub static GROUP: Kind = Kind {
    name: "group",
    doc: "Objects and lights together: its transforms apply to all of them, its material to those without one.",
    example: "group { sphere { radius 0.5 }  box { min <-1, -1, -1>  max <1, -0.5, 1> }  rotate y*20 }",
    role: Role::Object,
    own: &[],
    children: true,
    open: false,
    build: Some(|ctx, block| {
        let children = std::mem::take(&mut block.children);
        finish(ctx, block, Shape::Group(children.into()))
    }),
};

fn mesh(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let source = match (block.has("file"), block.has("vertices")) {
        (true, true) => return Err(conflict(ctx, block, "file", "vertices")),
        (true, false) => file_mesh(ctx, block)?,
        (false, true) => MeshSource::Inline(inline_mesh(ctx, block)?),
        (false, false) => {
            let said = Diagnostic::new(
                Code::MissingProperty,
                block.kind_span,
                "`mesh` needs either `file`, or `vertices` and `faces`",
            )
            .hint("write `mesh { file \"model.obj\" }`");
            return Err(ctx.fail(said));
        }
    };
    finish(ctx, block, Shape::Mesh(Arc::new(source)))
}

fn file_mesh(ctx: &mut dyn Context, block: &Block) -> Outcome<MeshSource> {
    for other in ["faces", "normals", "uvs"] {
        if block.has(other) {
            return Err(conflict(ctx, block, "file", other));
        }
    }
    let (written, span) = (block.text("file").unwrap_or_default(), block.place("file"));
    let path = existing_file(ctx, written, span)?;
    Ok(MeshSource::File { path, smooth: block.flag("smooth"), span })
}

/// The path of a file that must be there, joined to the folder of the file that names it.
pub fn existing_file(
    ctx: &mut dyn Context,
    written: &str,
    span: crate::diag::Span,
) -> Outcome<std::path::PathBuf> {
    let path = ctx.path(written, span);
    if ctx.loader().exists(&path) {
        return Ok(path);
    }
    let said = Diagnostic::new(Code::FileNotFound, span, format!("there is no file `{written}`"))
        .label(format!("looked for {}", path.display()))
        .hint("a file name is relative to the scene file that writes it");
    Err(ctx.fail(said))
}

fn inline_mesh(ctx: &mut dyn Context, block: &Block) -> Outcome<Mesh> {
    let positions = block.vectors("vertices").expect("just looked up");
    let faces = face_list(ctx, block, positions.len())?;
    let normals = per_vertex(ctx, block, "normals", block.vectors("normals"), positions.len())?;
    let uvs = per_vertex(ctx, block, "uvs", block.vectors2("uvs"), positions.len())?;
    let mut mesh = Mesh::from_faces(positions, faces, normals, uvs).map_err(|error| {
        let hint = "a face needs three corners that are not in one line";
        block.fault(ctx, Code::BadGeometry, "faces", format!("this mesh cannot be used: {error}"), hint)
    })?;
    match block.flag("smooth") {
        Some(true) if mesh.normals.is_empty() => mesh.compute_normals(),
        Some(false) => mesh.normals.clear(),
        _ => {}
    }
    Ok(mesh)
}

/// The faces' vertex numbers; every fault of them is reported.
fn face_list(ctx: &mut dyn Context, block: &Block, n_vertices: usize) -> Outcome<Vec<Vec<u32>>> {
    let Some(given) = block.get("faces") else {
        let said = Diagnostic::new(
            Code::MissingProperty,
            block.kind_span,
            "`mesh` has `vertices` but lacks `faces`",
        )
        .also(block.place("vertices"), "the vertices are here")
        .hint("write the faces by the vertices' numbers from 0: `faces [<0, 1, 2>]`");
        return Err(ctx.fail(said));
    };
    let mut faces = Vec::with_capacity(given.values.len());
    let mut outcome = Ok(());
    for (value, span) in &given.values {
        match face_corners(ctx, value, n_vertices, *span) {
            Ok(corners) => faces.push(corners),
            Err(reported) => outcome = Err(reported),
        }
    }
    outcome.map(|()| faces)
}

fn per_vertex<T>(
    ctx: &mut dyn Context,
    block: &Block,
    name: &str,
    values: Option<Vec<T>>,
    n_vertices: usize,
) -> Outcome<Vec<T>> {
    match values {
        None => Ok(Vec::new()),
        Some(values) if values.len() == n_vertices => Ok(values),
        Some(values) => {
            let message = format!("`{name}` has {} values for {n_vertices} vertices", values.len());
            Err(block.fault(
                ctx,
                Code::BadProperty,
                name,
                message,
                format!("give one of `{name}` for each vertex"),
            ))
        }
    }
}

/// The vertex numbers of a face.
fn face_corners(
    ctx: &mut dyn Context,
    value: &Value,
    n_vertices: usize,
    span: crate::diag::Span,
) -> Outcome<Vec<u32>> {
    let numbers: Option<Vec<f64>> = match value {
        Value::Vector3(v) => Some(v.to_array().to_vec()),
        Value::Vector4(v) => Some(v.to_array().to_vec()),
        Value::List(list) if list.len() >= 3 => {
            list.iter().map(|v| if let Value::Number(x) = v { Some(*x) } else { None }).collect()
        }
        _ => None,
    };
    let Some(numbers) = numbers else {
        let said = Diagnostic::new(
            Code::TypeMismatch,
            span,
            format!("a face is a vector of 3 or 4 vertex numbers, and this is {}", coerce::shown(value)),
        )
        .hint("write `faces [<0, 1, 2>, <0, 2, 3>]`");
        return Err(ctx.fail(said));
    };
    numbers.iter().map(|x| corner(ctx, *x, n_vertices, span)).collect()
}

fn corner(
    ctx: &mut dyn Context,
    x: f64,
    n_vertices: usize,
    span: crate::diag::Span,
) -> Result<u32, Reported> {
    if x >= 0.0 && x < n_vertices as f64 && x.floor() == x && x < f64::from(u32::MAX) {
        return Ok(x as u32);
    }
    let message = match n_vertices {
        0 => "a face of a mesh without vertices".to_string(),
        n => format!("there is no vertex {}: {n} vertices are numbered 0 to {}", coerce::number(x), n - 1),
    };
    let said =
        Diagnostic::new(Code::BadProperty, span, message).hint("vertices are counted from 0, not from 1");
    Err(ctx.fail(said))
}
