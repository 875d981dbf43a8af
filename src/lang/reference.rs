//! The reference of the language as Markdown, derived from the tables of kinds and functions: a page for each name, and all
//! of it with chapters of prose between.

use super::builtins::{self, CHAPTERS, CONSTANTS};
use super::coerce::forms;
use super::kinds::{self, common};
use super::members::{FAMILIES, Family, Member};
use super::table::{Builtin, Kind, Property, Role};
use std::fmt::Write;

/// The chapters of prose: the name by which `page` finds one, the title, the text.
const PROSE: [(&str, &str, &str); 10] = [
    ("language", "The language", include_str!("reference/language.md")),
    ("expressions", "Expressions", include_str!("reference/expressions.md")),
    ("cameras", "Cameras and pictures", include_str!("reference/camera.md")),
    ("lights", "Lights", include_str!("reference/lights.md")),
    ("materials", "Materials", include_str!("reference/materials.md")),
    ("patterns", "Patterns", include_str!("reference/patterns.md")),
    ("objects", "Objects", include_str!("reference/objects.md")),
    ("curves", "Curves", include_str!("reference/curves.md")),
    ("skeletons", "Skeletons", include_str!("reference/skeletons.md")),
    ("decisions", "Decisions", include_str!("reference/decisions.md")),
];

/// Which kinds stand at the end of which chapter.
fn kinds_of_chapter(chapter: &str) -> Vec<&'static Kind> {
    let named = |names: &[&str]| names.iter().filter_map(|name| kinds::find(name)).collect();
    match chapter {
        "cameras" => named(&["camera", "render"]),
        "lights" => named(&["light"]),
        "materials" => named(&["material"]),
        "curves" => named(&["spline"]),
        "skeletons" => named(&["skeleton", "joint", "tip", "pose"]),
        "objects" => kinds::ALL.iter().copied().filter(|k| k.role == Role::Object).collect(),
        _ => Vec::new(),
    }
}

/// Which types of value have their members told at the end of which chapter.
fn families_of_chapter(chapter: &str) -> impl Iterator<Item = &'static Family> {
    let named: &[&str] = match chapter {
        "curves" => &["curve", "transform"],
        "objects" => &["patch"],
        "skeletons" => &["pose", "model"],
        _ => &[],
    };
    FAMILIES.iter().copied().filter(move |family| named.contains(&family.name))
}

/// Every name that has a page: kinds, functions, constants, chapters, members, and the properties that all objects take.
pub fn names() -> impl Iterator<Item = &'static str> {
    let properties = common::of_role(Role::Object).map(|p| p.name);
    kinds::ALL
        .iter()
        .map(|kind| kind.name)
        .chain(builtins::names())
        .chain(properties)
        .chain(PROSE.iter().map(|(name, _, _)| *name))
        .chain(FAMILIES.iter().flat_map(|f| f.members.iter()).map(|m| m.name).filter(|name| !name.is_empty()))
}

/// The page of a kind, function, constant, property or chapter. Where a name is several of them, all are on it.
pub fn page(name: &str) -> Option<String> {
    let mut out = String::new();
    if let Some(kind) = kinds::find(name) {
        kind_page(&mut out, kind, 1);
    }
    if let Some(builtin) = builtins::find(name) {
        builtin_page(&mut out, builtin, 1);
    }
    if let Some((name, constant, doc)) = CONSTANTS.iter().find(|(n, _, _)| *n == name) {
        let value = super::display::display(&constant.value());
        let _ = writeln!(out, "# `{name}`\n\nA constant: {doc}. Its value is `{value}`.\n");
    }
    if let Some((_, doc)) = TIMES.iter().find(|(n, _)| *n == name) {
        let _ = writeln!(out, "# `{name}`\n\n{doc}.\n");
    }
    if let Some((chapter, title, _)) = PROSE.iter().find(|(n, _, _)| *n == name) {
        let _ = writeln!(out, "# {title}\n\n{}", prose(chapter));
    }
    if kinds::find(name).is_none() {
        property_page(&mut out, name);
    }
    for family in FAMILIES {
        if family.name == name {
            family_page(&mut out, family, 1);
        }
        for member in family.members.iter().filter(|m| m.name == name) {
            member_page(&mut out, family, member);
        }
    }
    (!out.is_empty()).then(|| out.trim_end().to_string() + "\n")
}

/// What the evaluator itself sets.
const TIMES: [(&str, &str); 2] = [
    ("time", "The moment of an animation: frame / frames, from 0 up to but not including 1"),
    ("frame", "The number of the picture in an animation, from 0"),
];

/// The whole reference.
pub fn whole() -> String {
    let mut out = String::from(
        "# The Ogee scene language\n\n\
         Made from the tables that the evaluator itself uses; `ogee docs NAME` prints the page of one block, function, \
         constant, property or chapter.\n\n",
    );
    contents(&mut out);
    for (name, title, _) in &PROSE {
        let _ = writeln!(out, "## {title}\n\n{}", prose(name));
        for kind in kinds_of_chapter(name) {
            kind_page(&mut out, kind, 3);
        }
        for family in families_of_chapter(name) {
            family_page(&mut out, family, 3);
        }
        if *name == "patterns" {
            functions_chapters(&mut out);
        }
    }
    out.trim_end().to_string() + "\n"
}

fn contents(out: &mut String) {
    for (name, title, _) in &PROSE {
        let kinds: Vec<String> = kinds_of_chapter(name).iter().map(|k| format!("`{}`", k.name)).collect();
        let colon = if kinds.is_empty() { "" } else { ": " };
        let _ = writeln!(out, "- {title}{colon}{}", kinds.join(" "));
        if *name == "patterns" {
            for (title, functions) in CHAPTERS {
                let names: Vec<String> = functions.iter().map(|b| format!("`{}`", b.name)).collect();
                let _ = writeln!(out, "- {title}: {}", names.join(" "));
            }
            out.push_str("- Constants\n");
        }
    }
    out.push('\n');
}

fn functions_chapters(out: &mut String) {
    for (title, functions) in CHAPTERS {
        let _ = writeln!(out, "## {title}\n");
        for builtin in *functions {
            builtin_page(out, builtin, 3);
        }
    }
    out.push_str("## Constants\n\n| name | what it is |\n|---|---|\n");
    for (name, _, doc) in CONSTANTS {
        let _ = writeln!(out, "| `{name}` | {doc} |");
    }
    for (name, doc) in TIMES {
        let _ = writeln!(out, "| `{name}` | {} |", lower_first(doc));
    }
    out.push('\n');
}

/// A chapter with what the tables know put into its places.
fn prose(name: &str) -> String {
    let text = PROSE.iter().find(|(n, _, _)| *n == name).map_or("", |(_, _, text)| *text);
    text.replace("{common}\n", &property_table(common::of_role(Role::Object)))
}

fn kind_page(out: &mut String, kind: &Kind, level: usize) {
    let _ = writeln!(out, "{} `{}`\n\n{}\n", "#".repeat(level), kind.name, kind.doc);
    if !kind.own.is_empty() {
        out.push_str(&property_table(kind.own.iter()));
        out.push('\n');
    }
    if kind.open {
        out.push_str("Any other property is the name of a joint.\n\n");
    }
    let common = match kind.role {
        Role::Object => {
            "Also what every object takes: `translate rotate scale shear matrix material name hide`"
        }
        Role::Light => "Also the transforms: `translate rotate scale shear matrix`",
        Role::Value | Role::Setting | Role::Part => "",
    };
    let children = if kind.children { "objects and lights may stand inside it" } else { "" };
    match (common, children) {
        ("", "") => {}
        ("", children) => {
            let _ = writeln!(out, "Inside it: {children}.\n");
        }
        (common, "") => {
            let _ = writeln!(out, "{common}.\n");
        }
        (common, children) => {
            let _ = writeln!(out, "{common}; {children}.\n");
        }
    }
    let _ = writeln!(out, "```ogee\n{}\n```\n", kind.example);
}

fn property_table<'a>(properties: impl Iterator<Item = &'a Property>) -> String {
    let mut out = String::from("| property | takes | default | meaning |\n|---|---|---|---|\n");
    for p in properties {
        let default = match (p.default, p.required) {
            (_, true) => "needed".to_string(),
            ("", false) => String::new(),
            (default, false) => format!("`{default}`"),
        };
        let _ = writeln!(out, "| `{}` | {} | {default} | {} |", p.name, forms(p), p.doc);
    }
    out
}

fn property_page(out: &mut String, name: &str) {
    if let Some(p) = common::of_role(Role::Object).find(|p| p.name == name) {
        let _ = writeln!(
            out,
            "# The property `{name}` of objects\n\n{}.\n\nTakes {}.\n",
            upper_first(p.doc),
            forms(p)
        );
    }
    for kind in kinds::ALL {
        let Some(p) = kind.own.iter().find(|p| p.name == name) else { continue };
        let default =
            if p.default.is_empty() { String::new() } else { format!(" By default `{}`.", p.default) };
        let _ = writeln!(
            out,
            "# The property `{name}` of `{}`\n\n{}.\n\nTakes {}.{default}\n",
            kind.name,
            upper_first(p.doc),
            forms(p)
        );
    }
}

fn builtin_page(out: &mut String, builtin: &Builtin, level: usize) {
    let _ = writeln!(out, "{} `{}`\n\n{}\n", "#".repeat(level), builtin.form(), builtin.doc);
    for (i, p) in builtin.parameters.iter().enumerate() {
        let more =
            if builtin.variadic && i + 1 == builtin.parameters.len() { ", any number of them" } else { "" };
        let default = p.default.map_or(String::new(), |d| format!("; by default `{d}`"));
        let _ = writeln!(out, "- `{}`: {}{more}{default}", p.name, p.takes);
    }
    let (domain, _) = builtin.domain;
    if !domain.is_empty() {
        let _ = writeln!(out, "\nDefined for {domain}; anything else is an error.");
    }
    match builtin.example {
        (written, "") => {
            let _ = writeln!(out, "\n`{written}`\n");
        }
        (written, gives) => {
            let _ = writeln!(out, "\n`{written}` is `{gives}`\n");
        }
    }
}

fn family_page(out: &mut String, family: &Family, level: usize) {
    let _ = writeln!(out, "{} Members of a {}\n\n{}\n", "#".repeat(level), family.name, family.doc);
    let _ = writeln!(out, "```ogee\n{}\n```\n", family.scene);
    out.push_str("| written | gives | example |\n|---|---|---|\n");
    for member in family.members {
        let (written, gives) = member.example;
        let _ = writeln!(out, "| `{}` | {} | `{written}` is `{gives}` |", member.written(), member.doc);
    }
    out.push('\n');
}

fn member_page(out: &mut String, family: &Family, member: &Member) {
    let _ = writeln!(out, "# `{}` of a {}\n\n{}\n", member.written(), family.name, member.doc);
    for p in member.parameters {
        let default = p.default.map_or(String::new(), |d| format!("; by default `{d}`"));
        let _ = writeln!(out, "- `{}`: {}{default}", p.name, p.takes);
    }
    let (written, gives) = member.example;
    let _ = writeln!(out, "\nWith\n\n```ogee\n{}\n```\n\n`{written}` is `{gives}`\n", family.scene);
}

fn upper_first(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or(String::new(), |c| c.to_uppercase().chain(characters).collect())
}

fn lower_first(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or(String::new(), |c| c.to_lowercase().chain(characters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_a_page() {
        for name in names() {
            let page = page(name).unwrap_or_else(|| panic!("{name} has no page"));
            assert!(page.starts_with('#') && page.ends_with('\n'), "{name}");
        }
        assert_eq!(page("sphre"), None);
    }

    #[test]
    fn a_page_tells_types_defaults_and_an_example() {
        let sphere = page("sphere").unwrap();
        assert!(sphere.contains("| `radius` | a number above 0 | `1` |"), "{sphere}");
        assert!(sphere.contains("```ogee\nsphere {"));
        let sqrt = page("sqrt").unwrap();
        assert!(
            sqrt.contains("Defined for 0 and above") && sqrt.contains("`sqrt(2)` is `1.4142135623730951`")
        );
        assert!(page("radius").unwrap().contains("of `torus`") == page("radius").unwrap().contains("radii"));
    }

    #[test]
    fn no_place_of_a_chapter_stays_empty() {
        let whole = whole();
        assert!(!["{common}", "{kinds}"].iter().any(|place| whole.contains(place)));
        for (name, title, _) in PROSE {
            assert!(whole.contains(&format!("## {title}\n")), "{name}");
        }
    }
}
