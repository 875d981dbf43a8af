//! Motion capture in Biovision's BVH text: a hierarchy of joints with channels, then a line of numbers for each frame. Knows nothing of
//! scenes. (Meredith & Maddock, *Motion capture file formats explained*, 2001.)
//!
//! Channels may stand in any order; the first is the outermost. An offset may lack, an `End Site` becomes a tip named after its joint.
//! Nothing of a file is trusted: counts are compared with what is there before anything is allocated by them.

use super::names::Names;
use crate::geometry::skeleton::{Freedom, Limits, Skeleton, Turning};
use crate::scene::rig::Motion;
use glam::DVec3;

/// Why a file cannot be used, with the line where that shows.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {why}")]
pub struct MocapError {
    /// Counted from 1.
    pub line: usize,
    /// In words.
    pub why: String,
}

/// Joints that hang on one another deeper than this are no figure.
const DEEPEST: usize = 1000;

/// The same from a file's bytes, in whatever encoding.
pub fn read(bytes: Vec<u8>, reserved: impl Fn(&str) -> bool) -> Result<(Skeleton, Motion), MocapError> {
    parse(&super::decode::decode(bytes), reserved)
}

/// The skeleton at rest with all channels 0, and its motion. Names are made fit for the language: what is no letter, digit or `_` becomes
/// `_`; a name that is `reserved`, or there already, gets a `_` or a number behind it.
pub fn parse(text: &str, reserved: impl Fn(&str) -> bool) -> Result<(Skeleton, Motion), MocapError> {
    let mut reader = Reader {
        words: Words::new(text),
        skeleton: Skeleton::default(),
        names: Names::new(&reserved),
        columns: Vec::new(),
    };
    reader.words.expect("HIERARCHY")?;
    reader.hierarchy()?;
    let motion = reader.motion()?;
    Ok((reader.skeleton, motion))
}

/// The words of a file, read one after the other.
struct Words<'t> {
    text: &'t str,
    /// Behind the last word taken, and its line.
    at: usize,
    line: usize,
}

impl<'t> Words<'t> {
    fn new(text: &'t str) -> Words<'t> {
        Words { text, at: 0, line: 1 }
    }

    /// The next word, its line, and where it ends.
    fn ahead(&self) -> Option<(&'t str, usize, usize)> {
        let rest = &self.text[self.at..];
        let start = rest.find(|c: char| !c.is_whitespace())?;
        let end = rest[start..].find(char::is_whitespace).map_or(rest.len(), |length| start + length);
        let line = self.line + rest[..start].matches('\n').count();
        Some((&rest[start..end], line, self.at + end))
    }

    /// A fault at the next word.
    fn fault<T>(&self, why: impl Into<String>) -> Result<T, MocapError> {
        let end = || self.line + self.text[self.at..].trim_end().matches('\n').count();
        Err(MocapError { line: self.ahead().map_or_else(end, |(_, line, _)| line), why: why.into() })
    }

    /// A fault at the word taken last.
    fn fault_before<T>(&self, why: impl Into<String>) -> Result<T, MocapError> {
        Err(MocapError { line: self.line, why: why.into() })
    }

    fn peek(&self) -> Option<&'t str> {
        self.ahead().map(|(word, ..)| word)
    }

    /// The next word, which `what` says in a fault.
    fn next(&mut self, what: &str) -> Result<&'t str, MocapError> {
        let Some((word, line, end)) = self.ahead() else {
            return self.fault(format!("the file ends where {what} is expected"));
        };
        (self.at, self.line) = (end, line);
        Ok(word)
    }

    fn expect(&mut self, wanted: &str) -> Result<(), MocapError> {
        let word = self.next(&format!("`{wanted}`"))?;
        if word.trim_end_matches(':').eq_ignore_ascii_case(wanted.trim_end_matches(':')) {
            return Ok(());
        }
        self.fault_before(format!("`{wanted}` is expected, and this is `{}`", shown(word)))
    }

    fn number(&mut self, what: &str) -> Result<f64, MocapError> {
        let word = self.next(what)?;
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => self.fault_before(format!("{what} is expected, and this is `{}`", shown(word))),
        }
    }

    fn count(&mut self, what: &str) -> Result<usize, MocapError> {
        let x = self.number(what)?;
        if x >= 0.0 && x == x.trunc() && x <= f64::from(u32::MAX) {
            return Ok(x as usize);
        }
        self.fault_before(format!("{what} is expected, and this is {x}"))
    }

    /// How many words are left.
    fn left(&self) -> usize {
        self.text[self.at..].split_whitespace().count()
    }
}

fn shown(word: &str) -> String {
    word.chars().take(24).collect()
}

struct Reader<'t, 'r> {
    words: Words<'t>,
    skeleton: Skeleton,
    names: Names<'r>,
    /// For each number of a frame's line, the coordinate it is.
    columns: Vec<usize>,
}

impl Reader<'_, '_> {
    /// All `ROOT`s and what hangs on them, with a stack of our own: files may be nested as deep as they like.
    fn hierarchy(&mut self) -> Result<(), MocapError> {
        let mut open: Vec<usize> = Vec::new();
        loop {
            let word = self.words.peek().unwrap_or_default().to_ascii_uppercase();
            match (word.as_str(), open.last().copied()) {
                ("ROOT", None) | ("JOINT", Some(_)) if open.len() < DEEPEST => {
                    self.words.next("a joint")?;
                    open.push(self.joint(open.last().copied())?);
                }
                ("END", Some(joint)) => self.end_site(joint)?,
                ("}", Some(_)) => {
                    self.words.next("`}`")?;
                    open.pop();
                }
                ("MOTION", None) if !self.skeleton.joints().is_empty() => return Ok(()),
                ("ROOT" | "JOINT", _) if open.len() >= DEEPEST => {
                    return self.words.fault(format!("joints are nested deeper than {DEEPEST}"));
                }
                (word, top) => {
                    let wanted = match top {
                        Some(_) => "`JOINT`, `End Site` or `}`",
                        None => "`ROOT` or `MOTION`",
                    };
                    let found = if word.is_empty() { "the end".into() } else { format!("`{}`", shown(word)) };
                    return self.words.fault(format!("{wanted} is expected, and this is {found}"));
                }
            }
        }
    }

    /// `name { OFFSET x y z CHANNELS n …`, the rest of its braces left.
    fn joint(&mut self, parent: Option<usize>) -> Result<usize, MocapError> {
        let name = self.name()?;
        self.words.expect("{")?;
        let offset = self.offset()?;
        let channels = self.channels()?;
        let freedom = freedom(&channels);
        let n = channels.len();
        let joint =
            self.skeleton.add_joint(&name, parent, offset, freedom, &vec![0.0; n], &vec![Limits::NONE; n]);
        let first = self.skeleton.joints()[joint].coordinates().start;
        let of_axis = |axis: DVec3| axis.max_position();
        let canonical = !matches!(self.skeleton.joints()[joint].freedom, Freedom::Channels(_));
        let n_moves = channels.iter().filter(|(turning, _)| *turning == Turning::Move).count();
        self.columns.extend(channels.iter().enumerate().map(|(k, (turning, axis))| {
            match (canonical, turning) {
                (false, _) => first + k,
                (true, Turning::Move) => first + of_axis(*axis),
                (true, Turning::Turn) => first + n_moves + of_axis(*axis),
            }
        }));
        Ok(joint)
    }

    /// A name may have blanks in it: it runs to the end of its line or to a brace.
    fn name(&mut self) -> Result<String, MocapError> {
        let line = self.words.line;
        let mut parts: Vec<&str> = Vec::new();
        while self.words.ahead().is_some_and(|(word, at, _)| at == line && word != "{") {
            parts.push(self.words.next("a name")?);
        }
        if parts.is_empty() {
            return self.words.fault("a joint's name is expected");
        }
        Ok(self.names.fit(&parts.join("_")))
    }

    fn offset(&mut self) -> Result<DVec3, MocapError> {
        if !self.words.peek().is_some_and(|word| word.eq_ignore_ascii_case("OFFSET")) {
            return Ok(DVec3::ZERO);
        }
        self.words.next("`OFFSET`")?;
        let mut number = || self.words.number("a number of the offset");
        Ok(DVec3::new(number()?, number()?, number()?))
    }

    fn channels(&mut self) -> Result<Vec<(Turning, DVec3)>, MocapError> {
        if !self.words.peek().is_some_and(|word| word.eq_ignore_ascii_case("CHANNELS")) {
            return Ok(Vec::new());
        }
        self.words.next("`CHANNELS`")?;
        let n = self.words.count("the number of channels")?;
        let mut channels = Vec::new();
        for _ in 0..n {
            let word = self.words.next("a channel")?;
            let Some(channel) = channel(word) else {
                return self.words.fault_before(format!(
                    "`Xposition` … `Zrotation` is expected, and this is `{}`",
                    shown(word)
                ));
            };
            if channels.contains(&channel) {
                return self.words.fault_before(format!("the channel `{}` is given twice", shown(word)));
            }
            channels.push(channel);
        }
        Ok(channels)
    }

    fn end_site(&mut self, joint: usize) -> Result<(), MocapError> {
        self.words.next("`End Site`")?;
        self.words.expect("Site")?;
        let name = format!("{}_end", self.skeleton.joints()[joint].name);
        let name = self.names.fit(&name);
        self.words.expect("{")?;
        let offset = self.offset()?;
        self.words.expect("}")?;
        self.skeleton.add_tip(&name, joint, offset);
        Ok(())
    }

    fn motion(&mut self) -> Result<Motion, MocapError> {
        self.words.expect("MOTION")?;
        self.words.expect("Frames:")?;
        let n_frames = self.words.count("the number of frames")?;
        self.words.expect("Frame")?;
        self.words.expect("Time:")?;
        let step = self.words.number("the time of a frame")?;
        if !(step > 0.0) {
            return self.words.fault_before("the time of a frame must be above 0");
        }
        let n_columns = self.columns.len();
        if n_frames == 0 {
            return self.words.fault_before("there is no frame");
        }
        let n = self.words.left();
        if n / n_columns.max(1) < n_frames {
            let why =
                format!("{n_frames} frames of {n_columns} channels are announced, and {n} numbers follow");
            return self.words.fault_before(why);
        }
        let frames = (0..n_frames).map(|_| self.frame()).collect::<Result<_, _>>()?;
        let mut turns = vec![false; self.skeleton.rest().len()];
        for motion in self.skeleton.motions() {
            turns[motion.coordinate] = motion.turning == Turning::Turn;
        }
        Ok(Motion { step, frames, turns })
    }

    fn frame(&mut self) -> Result<Vec<f64>, MocapError> {
        let mut coordinates = vec![0.0; self.skeleton.rest().len()];
        for k in 0..self.columns.len() {
            coordinates[self.columns[k]] = self.words.number("a number of a frame")?;
        }
        Ok(coordinates)
    }
}

fn channel(word: &str) -> Option<(Turning, DVec3)> {
    let lower = word.to_ascii_lowercase();
    let axis = match lower.as_bytes().first()? {
        b'x' => DVec3::X,
        b'y' => DVec3::Y,
        b'z' => DVec3::Z,
        _ => return None,
    };
    match &lower[1..] {
        "position" => Some((Turning::Move, axis)),
        "rotation" => Some((Turning::Turn, axis)),
        _ => None,
    }
}

/// Channels that are what a ball or a free joint does are one; all others stay as they are.
fn freedom(channels: &[(Turning, DVec3)]) -> Freedom {
    let turns = [DVec3::Z, DVec3::Y, DVec3::X].map(|axis| (Turning::Turn, axis));
    let is_move = |channel: &&(Turning, DVec3)| channel.0 == Turning::Move;
    let n_moves = channels.iter().take_while(is_move).count();
    match channels {
        [] => Freedom::Fixed,
        _ if channels == turns => Freedom::Ball,
        _ if n_moves == 3 && channels[3..] == turns => Freedom::Free,
        _ => Freedom::Channels(channels.to_vec()),
    }
}

#[cfg(test)]
mod tests;
