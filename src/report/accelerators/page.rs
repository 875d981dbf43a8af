//! Rows of trees as a page: a table for each mesh, and plots of how cost grows.

use super::{AcceleratorRow, RayRow};
use crate::report::page::{Page, names, short, slug};
use crate::report::plot::lines::{Chart, Line, lines};
use crate::report::row::Machine;
use std::fmt::Write;

/// `index.md` and a plot for each mesh that grows.
pub fn render(machine: &Machine, rows: &[AcceleratorRow]) -> Vec<Page> {
    let mut index = head(machine);
    let mut pages = Vec::new();
    // As files of results are read again.
    let mut meshes = names(rows.iter().map(|row| &row.mesh));
    meshes.sort_by_key(|mesh| slug(mesh));
    for mesh in meshes {
        let own: Vec<&AcceleratorRow> = rows.iter().filter(|row| row.mesh == mesh).collect();
        let _ = write!(index, "\n## {mesh}\n");
        plots(&mut index, &mut pages, &mesh, &own);
        table(&mut index, &own);
    }
    whole_pictures(&mut index, rows);
    pages.insert(0, Page { name: "index.md".into(), text: index });
    pages
}

fn head(machine: &Machine) -> String {
    format!(
        "# Trees: what a ray costs\n\n\
         `ogee bench accelerators` measured it, `ogee bench report` wrote this page from [results](results) alone. {told}.\n\n\
         All trees stand over the same triangles with the same test of each, as scenes do. Bytes are for \
         each triangle: the tree's nodes, and what is in its leaves; those of the mesh itself come on top and are the same for all. Rays are on one \
         thread, in turn, the fastest of several rounds; building takes all threads. Rays together are those of the camera, sixteen at once, in \
         squares of four by four pixels; a kd-tree is asked one by one. Nodes and tests are counted (of very many rays on some, evenly chosen), and \
         the same on every machine; the nodes of `bvh` have eight children, those of `kdtree` two, and its leaves count as nodes. Wrong are rays that meet \
         another triangle, at another distance, or are blocked otherwise, than by a test of every triangle: half of them go through edges and corners. \
         `bvh` and `kdtree` are what scenes use; the others are what they are measured against.\n",
        told = machine.told(),
    )
}

/// What is drawn over triangles, by title and axis.
type Figure = (&'static str, &'static str, fn(&AcceleratorRow) -> f64);

const OVER_TRIANGLES: [Figure; 5] = [
    ("Building", "seconds", |row| row.build),
    ("Memory", "bytes of tree and leaves", |row| (row.bytes[0] + row.bytes[1]) as f64),
    ("Camera rays", "seconds a million", |row| 1.0 / ray(row, "camera").mrays),
    ("Diffuse rays", "seconds a million", |row| 1.0 / ray(row, "diffuse").mrays),
    ("Diffuse rays", "nodes and tests a ray", |row| ray(row, "diffuse").nodes + ray(row, "diffuse").tests),
];

const OVER_PIXELS: [Figure; 1] =
    [("Camera rays", "seconds a picture", |row| row.pixels as f64 / ray(row, "camera").mrays / 1e6)];

fn ray(row: &AcceleratorRow, name: &str) -> RayRow {
    row.rays.iter().find(|ray| ray.name == name).cloned().unwrap_or_default()
}

fn plots(index: &mut String, pages: &mut Vec<Page>, mesh: &str, rows: &[&AcceleratorRow]) {
    let chart = |figure: &Figure, grows: &str, x: fn(&AcceleratorRow) -> f64| {
        let line = |builder: String| {
            let own = rows.iter().filter(|row| row.grows == grows && row.builder == builder);
            let points = own.map(|row| (x(row), (figure.2)(row))).filter(|(_, y)| y.is_finite() && *y > 0.0);
            Line { points: points.collect(), label: builder, dashed: false }
        };
        Chart {
            title: figure.0.into(),
            cost_label: grows.into(),
            error_label: figure.1.into(),
            lines: names(rows.iter().map(|row| &row.builder)).into_iter().map(line).collect(),
            guides: Vec::new(),
            floor: 0.0,
        }
    };
    let mut charts = Vec::new();
    if rows.iter().any(|row| row.grows == "triangles") {
        charts.extend(
            OVER_TRIANGLES.iter().map(|figure| chart(figure, "triangles", |row| row.triangles as f64)),
        );
    }
    if rows.iter().any(|row| row.grows == "pixels") {
        charts.extend(OVER_PIXELS.iter().map(|figure| chart(figure, "pixels", |row| row.pixels as f64)));
    }
    if !charts.is_empty() {
        let name = format!("{}.svg", slug(mesh));
        let _ = write!(index, "\n![{mesh}: how cost grows]({name})\n");
        pages.push(Page { text: lines(mesh, &charts), name });
    }
}

/// How much of the rate of their rays alone whole pictures keep.
fn whole_pictures(index: &mut String, rows: &[AcceleratorRow]) {
    let mut framed: Vec<&AcceleratorRow> = rows.iter().filter(|row| !row.frames.is_empty()).collect();
    framed.sort_by_key(|row| slug(&row.mesh));
    if framed.is_empty() {
        return;
    }
    index.push_str(
        "\n## Whole pictures\n\n\
         A matt mesh as the same camera sees it under the light of the shadow rays, one sample a pixel, one thread: millions of rays a second of the tiles of the \
         picture, and as a share of those of its rays alone, one by one, and with the camera's sixteen at once, as the picture's are. The rest is making rays, surfaces, \
         materials, light and pixels. All in turn, the fastest of several rounds.\n\n\
         | mesh | pixels | tracer | Mrays/s | of its rays one by one | of them together |\n|---|---|---|---|---|---|\n",
    );
    for row in framed {
        for frame in &row.frames {
            let _ = writeln!(
                index,
                "| {} | {} | {} | {} | {} | {} |",
                row.mesh,
                row.pixels,
                frame.tracer,
                short(frame.rays as f64 / frame.seconds / 1e6),
                short(frame.one_by_one / frame.seconds),
                short(frame.together / frame.seconds),
            );
        }
    }
}

fn table(index: &mut String, rows: &[&AcceleratorRow]) {
    index.push_str(
        "\n| triangles | pixels | tree | build, s | bytes a triangle: tree | leaves | named | camera, Mrays/s | nodes | tests | together | shadow | nodes | tests \
         | diffuse | nodes | tests | wrong |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let share = |bytes: usize| short(bytes as f64 / row.triangles.max(1) as f64);
        let _ = write!(
            index,
            "| {} | {} | {} | {} | {} | {} | {} |",
            row.triangles,
            row.pixels,
            row.builder,
            short(row.build),
            share(row.bytes[0]),
            share(row.bytes[1]),
            short(row.references as f64 / row.triangles.max(1) as f64),
        );
        for name in ["camera", "together", "shadow", "diffuse"] {
            let ray = row.rays.iter().find(|ray| ray.name == name);
            let figure = |of: fn(&RayRow) -> f64| ray.map_or("–".into(), |ray| short(of(ray)));
            let _ = write!(index, " {} |", figure(|ray| ray.mrays));
            // Together they are counted as one by one.
            if name != "together" {
                let _ = write!(index, " {} | {} |", figure(|ray| ray.nodes), figure(|ray| ray.tests));
            }
        }
        let wrong = match row.checked {
            0 => "–".into(),
            n => format!("{} of {n}", row.wrong),
        };
        let _ = writeln!(index, " {wrong} |");
    }
}
