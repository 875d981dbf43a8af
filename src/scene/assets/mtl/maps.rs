//! The pictures of a .mtl file: options before the name, and where the name leads.

use super::{find, push_once};
use crate::diag::Span;
use crate::scene::assets::AssetCache;
use crate::scene::assets::image::{Image, Picture};
use crate::scene::{Filter, ImagePattern, Wrap};
use std::path::Path;
use std::sync::Arc;

/// How many words each option takes at most; those of variable length take numbers as far as there are any.
const OPTIONS: &[(&str, usize)] = &[
    ("-blendu", 1),
    ("-blendv", 1),
    ("-bm", 1),
    ("-boost", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-o", 3),
    ("-s", 3),
    ("-t", 3),
    ("-texres", 1),
    ("-type", 1),
    ("-colorspace", 1),
];

/// A map statement taken apart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapStatement<'t> {
    /// The file, blanks and all.
    pub name: &'t str,
    /// `-bm`: how strong a bump is.
    pub bump: f64,
    /// `-clamp on`.
    pub clamp: bool,
    /// `-o` and `-s`: (u, v) of the picture is s·(u, v) + o.
    pub offset: [f64; 2],
    /// See `offset`.
    pub scale: [f64; 2],
}

/// Takes a map statement apart: options with their values, then a name that may hold blanks.
pub(super) fn parse(statement: &str) -> MapStatement<'_> {
    let mut map =
        MapStatement { name: statement.trim(), bump: 1.0, clamp: false, offset: [0.0; 2], scale: [1.0; 2] };
    while let Some((option, most)) =
        OPTIONS.iter().find(|(option, _)| first_word(map.name).0.eq_ignore_ascii_case(option))
    {
        let (_, mut rest) = first_word(map.name);
        let mut values = Vec::new();
        while values.len() < *most {
            let (word, after) = first_word(rest);
            let is_number = word.parse::<f64>().is_ok();
            // A further number could be the name itself; the last word always is.
            if after.is_empty() || (!is_number && !values.is_empty()) || (!is_number && *most == 3) {
                break;
            }
            values.push(word);
            rest = after;
        }
        map.name = rest;
        map.apply(option, &values);
    }
    map
}

impl MapStatement<'_> {
    fn apply(&mut self, option: &str, values: &[&str]) {
        let number = |i: usize| values.get(i).and_then(|v| v.parse::<f64>().ok()).filter(|x| x.is_finite());
        match option {
            "-bm" => self.bump = number(0).unwrap_or(1.0),
            "-clamp" => self.clamp = values.first().is_some_and(|v| v.eq_ignore_ascii_case("on")),
            "-o" => self.offset = [number(0).unwrap_or(0.0), number(1).unwrap_or(0.0)],
            "-s" => self.scale = [number(0).unwrap_or(1.0), number(1).unwrap_or(1.0)],
            _ => {}
        }
    }
}

fn first_word(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    match text.split_once(char::is_whitespace) {
        Some((word, rest)) => (word, rest.trim_start()),
        None => (text, ""),
    }
}

/// Finds and reads the pictures of one material.
pub(super) struct Maps<'m, 'c> {
    cache: &'m AssetCache<'c>,
    mesh: &'m Path,
    folder: &'m Path,
    missing: &'m mut Vec<String>,
}

impl<'m, 'c> Maps<'m, 'c> {
    /// Of a mesh file and the folder of its material file.
    pub(super) fn new(
        cache: &'m AssetCache<'c>,
        mesh: &'m Path,
        folder: &'m Path,
        missing: &'m mut Vec<String>,
    ) -> Self {
        Maps { cache, mesh, folder, missing }
    }

    /// The picture of a map statement, read; none where it is missing, which is noted.
    pub(super) fn picture(
        &mut self,
        map: &MapStatement<'_>,
        span: Span,
    ) -> Option<(ImagePattern, Arc<Image>)> {
        let beside_mesh = self.mesh.parent().unwrap_or(Path::new(""));
        let Some(path) = find(self.cache, &[self.folder, beside_mesh], map.name) else {
            push_once(self.missing, format!("there is no picture `{}`", map.name));
            return None;
        };
        let image = match self.cache.image(&path) {
            Ok(image) => image,
            Err(why) => {
                push_once(self.missing, format!("the picture `{}` cannot be used: {why}", map.name));
                return None;
            }
        };
        let picture = Picture::default();
        picture.set(Arc::clone(&image));
        let wrap = if map.clamp { Wrap::Clamp } else { Wrap::Repeat };
        Some((ImagePattern { path, wrap, filter: Filter::Bilinear, colour: true, span, picture }, image))
    }
}
