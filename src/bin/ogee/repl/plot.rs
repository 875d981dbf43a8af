//! `:plot`: a figure in the terminal, or in a file.

use super::orders::{refuse, unquoted};
use super::{Flow, Talk};
use crate::place::Place;
use crate::speech::{Failure, data};
use ogee::plot::{Figure, braille, raster, svg};
use ogee::session::plot::Request;
use std::io::Cursor;
use std::path::Path;

/// The size of a figure in a file, in pixels.
const SIZE: [u32; 2] = [720, 480];
/// The size of a figure in characters where there is no terminal to fit.
const CHARACTERS: [usize; 2] = [72, 20];

/// Plots what a line asks for behind its first `at` bytes.
pub fn plot(talk: &mut Talk<'_, '_>, line: &str, at: usize, first_line: usize) -> Result<Flow, Failure> {
    let (asked, file) = match line[at..].rsplit_once("--to ") {
        Some((asked, file)) => (&line[..at + asked.len()], Some(Path::new(unquoted(file.trim())))),
        None => (line, None),
    };
    let request = match Request::parse(asked, at.min(asked.len())) {
        Ok(request) => request,
        Err(why) => return Ok(refuse(talk, &why)),
    };
    let place = match file.map(prepared).transpose() {
        Ok(place) => place,
        Err(failure) => return Ok(refuse(talk, &failure.message)),
    };
    let mut figure = None;
    talk.answer(|dialogue| {
        let (found, reply) = dialogue.plot(&request, first_line);
        figure = found;
        reply
    })?;
    match (figure, place) {
        (None, _) => {}
        (Some(figure), None) => data(in_characters(&figure))?,
        (Some(figure), Some((place, form))) => {
            if let Err(failure) = form.bytes(&figure).and_then(|bytes| place.write(&bytes)) {
                return Ok(refuse(talk, &failure.message));
            }
        }
    }
    Ok(Flow::On)
}

/// The form of a file.
#[derive(Clone, Copy)]
enum Form {
    Svg,
    Png,
}

fn prepared(file: &Path) -> Result<(Place, Form), Failure> {
    let form = match file.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("svg") => Form::Svg,
        Some("png") => Form::Png,
        _ => return Err(Failure::usage(format!("{}: figures are .svg or .png", file.display()))),
    };
    Ok((Place::try_at(file)?, form))
}

impl Form {
    fn bytes(self, figure: &Figure) -> Result<Vec<u8>, Failure> {
        let [width, height] = SIZE;
        match self {
            Form::Svg => Ok(svg::text(figure, width.into(), height.into()).into_bytes()),
            Form::Png => {
                let mut bytes = Cursor::new(Vec::new());
                let image = raster::image(figure, width, height);
                let written = image.write_to(&mut bytes, image::ImageFormat::Png);
                written.map_err(|error| Failure::machine("cannot encode the figure", error))?;
                Ok(bytes.into_inner())
            }
        }
    }
}

/// As wide as the terminal and half as high as it, so that what was typed before stays in sight.
fn in_characters(figure: &Figure) -> String {
    let [columns, rows] = match terminal_size::terminal_size_of(std::io::stdout()) {
        Some((width, height)) => {
            let (width, height) = (usize::from(width.0), usize::from(height.0));
            [width.min(120), (2 * height / 3).min(width / 3)]
        }
        None => CHARACTERS,
    };
    braille::text(figure, columns, rows)
}
