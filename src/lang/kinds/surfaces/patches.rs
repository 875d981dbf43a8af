//! The kind `patch`.

use crate::diag::{Code, Diagnostic};
use crate::geometry::patch::{Patch, PatchBasis, PatchError};
use crate::lang::kinds::objects::existing_file;
use crate::lang::kinds::shapes::{conflict, finish};
use crate::lang::table::{Block, Context, Kind, Outcome, Property, Role, Type};
use crate::scene::{PatchMethod, PatchNet, PatchSource, Shape, Surface};
use std::sync::Arc;

/// A bicubic patch.
pub static PATCH: Kind = Kind {
    name: "patch",
    doc: "A bicubic surface of 16 control points, of a grid of them that share seams, or of a .bpt file; no solid. (u, v) run from 0 \
          to 1, u through the rows, v through the columns (of a file, in each of its patches). A file is read when a picture needs it.",
    example: "patch { bspline <-1, 0, -1>, <0, 0, -1>, <1, 0, -1>, <2, 0, -1>, <-1, 0, 0>, <0, 3, 0>, <1, 0, 0>, <2, 0, 0>, \
              <-1, 0, 1>, <0, 0, 1>, <1, 3, 1>, <2, 0, 1>, <-1, 0, 2>, <0, 0, 2>, <1, 0, 2>, <2, 0, 2> }",
    role: Role::Object,
    own: &[
        Property::new(
            "bezier",
            &[&[Type::Vector3]],
            "",
            "Bézier points row by row: u picks the row, v the column",
        )
        .many(),
        Property::new("bspline", &[&[Type::Vector3]], "", "points of uniform bicubic B-splines, row by row")
            .many(),
        Property::new(
            "file",
            &[&[Type::Text]],
            "",
            "a .bpt file, relative to the file that writes it: how many patches, then `3 3` and 16 points for each",
        ),
        Property::new(
            "grid",
            &[&[Type::Integer { min: 1 }, Type::Integer { min: 1 }]],
            "4, 4",
            "rows and columns of points, which share seams: 3n + 1 of `bezier`, at least 4 of `bspline`; or of patches",
        ),
        Property::new(
            "tolerance",
            &[&[Type::Positive]],
            "",
            "largest distance of its triangles from the true surface, in scene units; by default under a quarter pixel",
        ),
        Property::new(
            "method",
            &[&[Type::Word(&["tessellated", "direct"])]],
            "tessellated",
            "how it is drawn: as triangles without cracks, or directly, each root isolated; `trace` is always direct",
        ),
    ],
    children: false,
    open: false,
    build: Some(patch),
};

fn patch(ctx: &mut dyn Context, block: &mut Block) -> Outcome {
    let source = PatchSource {
        net: net(ctx, block)?,
        method: block.word("method").map(|word| match word {
            "direct" => PatchMethod::Direct,
            _ => PatchMethod::Tessellated,
        }),
        tolerance: block.number("tolerance"),
    };
    finish(ctx, block, Shape::Surface(Arc::new(Surface::Patch(source))))
}

fn net(ctx: &mut dyn Context, block: &Block) -> Outcome<PatchNet> {
    let given: Vec<&'static str> =
        ["bezier", "bspline", "file"].into_iter().filter(|name| block.has(name)).collect();
    match *given.as_slice() {
        ["file"] if block.has("grid") => Err(conflict(ctx, block, "file", "grid")),
        ["file"] => {
            let (written, span) = (block.text("file").unwrap_or_default(), block.place("file"));
            Ok(PatchNet::File { path: existing_file(ctx, written, span)?, span })
        }
        ["bezier"] => points(ctx, block, "bezier", PatchBasis::Bezier),
        ["bspline"] => points(ctx, block, "bspline", PatchBasis::BSpline),
        [first, second, ..] => Err(conflict(ctx, block, first, second)),
        _ => {
            let message = "`patch` needs `bezier` or `bspline` with its points, or `file`";
            let said = Diagnostic::new(Code::MissingProperty, block.kind_span, message)
                .hint("write `patch { file \"teapot.bpt\" }`, or 16 points after `bezier`");
            Err(ctx.fail(said))
        }
    }
}

fn points(ctx: &mut dyn Context, block: &Block, name: &'static str, basis: PatchBasis) -> Outcome<PatchNet> {
    let points = block.vectors(name).expect("just looked up");
    let grid = block.numbers("grid").map(|g| (g[0] as usize, g[1] as usize));
    let error = match Patch::new(basis, &points, grid) {
        Ok(patch) => return Ok(PatchNet::Inline(patch)),
        Err(error) => error,
    };
    let (place, hint) = match error {
        PatchError::GridShape { .. } => {
            ("grid", "`grid rows, columns` counts points: 3n + 1 of a `bezier`, 4 or more of a `bspline`")
        }
        PatchError::PointCount { .. } if grid.is_some() => {
            (name, "give a point for each place of the `grid`, row by row")
        }
        _ => (name, "a single patch has 16 points, row by row; more of them need `grid rows, columns`"),
    };
    Err(block.fault(ctx, Code::BadGeometry, place, format!("this patch cannot be made: {error}"), hint))
}
