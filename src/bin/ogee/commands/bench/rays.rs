//! `ogee bench rays`: one mesh asked about files of rays, an order a line of standard input, for who times this program beside another. It
//! answers each order with a line when it is done, and looks at no clock.
//!
//! | order | what is done | the line |
//! |---|---|---|
//! | `build` | the tree is made anew | its bytes, with those of its leaves |
//! | `closest FILE FIRST COUNT` | so many rays of a file from one on are asked what they meet first | `done` |
//! | `together FILE FIRST COUNT` | the same, as many rays at once as a packet has | `done` |
//! | `any FILE FIRST COUNT` | the same as of the first, whether anything | `done` |
//! | `answers FILE OUT` | for each ray the triangle met (u32, of none all bits) is written, then each distance (f32) | `done` |
//! | `judge FILE OTHER MOST` | answers of another program, as `answers` writes them, are compared | the numbers of a `Verdict` |
//!
//! A file is seven f32 a ray, see `RawRay`. Names have no spaces.

use crate::args::Rays;
use crate::speech::{Ended, Exit, Failure, data, reason};
use ogee::geometry::mesh::Mesh;
use ogee::report::accelerators::rays::{RawRay, RaySet};
use ogee::report::accelerators::subject::{Builder, Subject};
use std::collections::HashMap;
use std::io::BufRead;

/// In place of a triangle.
const NONE: u32 = u32::MAX;

/// Does what standard input says until it ends.
pub fn run(args: &Rays) -> Ended {
    let names = || Builder::TREES.into_iter().chain([Builder::List]);
    let Some(builder) = names().find(|builder| builder.name() == args.tree) else {
        let all: Vec<_> = names().map(Builder::name).collect();
        return Err(Failure::usage(format!(
            "there is no tree `{}`\nthere are: {}",
            args.tree,
            all.join("; ")
        )));
    };
    let (_, mesh) = super::accelerators::read(&args.mesh)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads)
        .build()
        .map_err(|error| Failure::machine("cannot start threads", error))?;
    pool.install(|| obey(&mesh, builder))
}

fn obey(mesh: &Mesh, builder: Builder) -> Ended {
    let mut asked = Desk { mesh, builder, subject: Subject::new(mesh, builder), sets: HashMap::new() };
    for line in std::io::stdin().lock().lines() {
        let line = line.map_err(|error| Failure::machine("cannot read standard input", reason(&error)))?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let said = asked.order(&words)?;
        data(format!("{said}\n"))?;
    }
    Ok(Exit::Done)
}

/// A mesh under a tree, and the rays that it was asked about, by file.
struct Desk<'m> {
    mesh: &'m Mesh,
    builder: Builder,
    subject: Subject<'m>,
    sets: HashMap<String, RaySet>,
}

impl Desk<'_> {
    fn order(&mut self, words: &[&str]) -> Result<String, Failure> {
        match words {
            ["build"] => {
                self.subject = Subject::new(self.mesh, self.builder);
                Ok(self.subject.bytes().iter().sum::<usize>().to_string())
            }
            [how @ ("closest" | "together" | "any"), file, first, count] => {
                let (first, count) = (number(first)?, number(count)?);
                if !self.sets.contains_key(*file) {
                    self.sets.insert((*file).into(), RaySet::new(&read(file)?, *how == "any"));
                }
                let set = self.sets.get_mut(*file).expect("it has just been read");
                set.any = *how == "any";
                let first = first.min(set.len());
                let some = first..first.saturating_add(count).min(set.len());
                match *how {
                    "together" => set.ask_together(&self.subject, some),
                    _ => set.ask(&self.subject, some),
                }
                Ok("done".into())
            }
            ["answers", file, out] => {
                let answers = self.set(file)?.answers();
                let triangles = answers.iter().map(|answer| answer.map_or(NONE, |(_, i)| i));
                let distances = answers.iter().map(|answer| answer.map_or(f32::INFINITY, |(t, _)| t));
                let words = triangles.chain(distances.map(f32::to_bits));
                let bytes: Vec<u8> = words.flat_map(u32::to_le_bytes).collect();
                std::fs::write(out, bytes)
                    .map_err(|error| Failure::machine(format!("cannot write {out}"), reason(&error)))?;
                Ok("done".into())
            }
            ["judge", file, other, most] => {
                let set = self.set(file)?;
                let theirs = words_of(other)?.into_iter().take(set.len());
                let theirs: Vec<_> = theirs.map(|i| (i != NONE).then_some(i)).collect();
                let found = set.judge(&theirs, &Subject::new(self.mesh, Builder::List), number(most)?);
                let all = [found.lost, found.made_up, found.other, found.judged, found.ours, found.theirs];
                Ok(all.map(|n| n.to_string()).join(" "))
            }
            _ => Err(Failure::usage(format!("`{}` is no order", words.join(" ")))),
        }
    }

    fn set(&self, file: &str) -> Result<&RaySet, Failure> {
        self.sets.get(file).ok_or_else(|| Failure::usage(format!("no ray of {file} was asked")))
    }
}

fn number(word: &str) -> Result<usize, Failure> {
    word.parse().map_err(|_| Failure::usage(format!("`{word}` is no number")))
}

fn words_of(file: &str) -> Result<Vec<u32>, Failure> {
    let bytes = std::fs::read(file)
        .map_err(|error| Failure::machine(format!("cannot read {file}"), reason(&error)))?;
    let words = bytes.as_chunks::<4>().0;
    Ok(words.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect())
}

fn read(file: &str) -> Result<Vec<RawRay>, Failure> {
    let words: Vec<f32> = words_of(file)?.into_iter().map(f32::from_bits).collect();
    Ok(words.as_chunks::<7>().0.to_vec())
}
