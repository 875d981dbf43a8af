//! Frames of an animation, each into a file of its own or all into one. A frame is written when it is finished, and not before: a file that
//! is there is whole, so that `--resume` can leave it.

use super::target::{Form, Saving, Target, cannot_write, development, save_movie};
use super::{Bar, Seconds, prepare, render, stats};
use crate::args::Render;
use crate::interrupt::CANCEL;
use crate::speech::{Ended, Exit, Failure, data, show, tell, tell_failure};
use ogee::diag::{Code, Diagnostic, Span, has_errors};
use ogee::render::film::{Film, Taken};
use ogee::render::output::Format;
use ogee::render::output::movie::Movie;
use ogee::render::settings::ResolvedSettings;
use ogee::session::animation::Animation;
use ogee::session::picture::{self, Prepared};
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard};

/// Renders those frames that are not there yet.
pub fn run(
    args: &Render,
    target: &Target,
    animation: &mut Animation<'_>,
    frames: Range<u32>,
    seconds: Seconds,
) -> Ended {
    let is_there = |frame: &u32| args.resume && target.name.of(*frame).is_file();
    let missing: Vec<u32> = frames.clone().filter(|frame| !is_there(frame)).collect();
    let fps = animation.fps();
    let into = match target.form {
        Form::Still(format) => Into::Files(format),
        Form::Movie(format) => Into::Movie(Arc::new(Mutex::new(Movie::new(format, fps)))),
    };
    let bar = Bar::over(missing.len() as u64);
    let there = frames.len() - missing.len();
    let mut reel = Reel {
        args,
        target,
        animation,
        into,
        bar,
        printed: Vec::new(),
        total: Total { seconds, ..Total::default() },
    };
    let ended = reel.all(&missing);
    reel.bar.end();
    // What was made is kept, however the rest ended.
    if let Into::Movie(movie) = &reel.into {
        let movie = locked(movie);
        reel.total.seconds.write.measure(|| save_movie(&movie, target.name.given()))?;
    }
    if ended.is_ok() || reel.total.frames > 0 {
        tell(reel.total.line(&target.shown(), there, missing.len()));
    }
    ended
}

/// Where frames go.
enum Into {
    Files(Format),
    Movie(Arc<Mutex<Movie>>),
}

/// Frames as they are made.
struct Reel<'r, 'a> {
    args: &'r Render,
    target: &'r Target,
    animation: &'r mut Animation<'a>,
    into: Into,
    bar: Bar,
    /// What the frame before printed.
    printed: Vec<String>,
    total: Total,
}

/// All frames that were made.
#[derive(Default)]
struct Total {
    frames: usize,
    rays: u64,
    taken: Taken,
    settings: Option<ResolvedSettings>,
    faulty: bool,
    seconds: Seconds,
}

impl Reel<'_, '_> {
    fn all(&mut self, frames: &[u32]) -> Ended {
        for &frame in frames {
            self.bar.name(format_args!("frame {frame}"));
            if let Some(exit) = self.one(frame)? {
                return Ok(exit);
            }
            self.bar.made();
        }
        Ok(if self.total.faulty { Exit::Scene } else { Exit::Done })
    }

    /// Makes a frame; says how all of it ends where it cannot go on.
    fn one(&mut self, frame: u32) -> Result<Option<Exit>, Failure> {
        let mut seconds = Seconds::default();
        let evaluated = seconds.evaluate.measure(|| self.animation.frame(frame));
        if is_interrupted() {
            return Ok(Some(Exit::Interrupted));
        }
        if evaluated.printed != self.printed {
            self.bar.aside(|| evaluated.printed.iter().for_each(tell));
            self.printed.clone_from(&evaluated.printed);
        }
        let size_span = evaluated.scene.render.size_span;
        let (prepared, diagnostics) =
            prepare(self.args, self.target, self.animation, evaluated, &mut seconds)?;
        self.say(frame, diagnostics);
        let Some(prepared) = prepared else { return Ok(Some(Exit::Scene)) };
        if let Some(fault) = self.other_size(&prepared.settings, size_span) {
            self.say(frame, vec![fault]);
            return Ok(Some(Exit::Scene));
        }
        let left = self.left_undone(frame);
        let film = seconds.render.measure(|| render(self.args, &prepared, &self.bar, left));
        let Some(film) = film.filter(|film| super::is_made(film, &prepared.settings)) else {
            return Ok(Some(Exit::Interrupted));
        };
        let faults = picture::faults(&film);
        self.total.faulty |= has_errors(&faults);
        self.say(frame, faults);
        seconds.write.measure(|| self.keep(frame, &film, &prepared))?;
        self.count(frame, &film, &prepared, &seconds)?;
        Ok(is_interrupted().then_some(Exit::Interrupted))
    }

    /// Why a frame does not go into one file with those before it.
    fn other_size(&self, settings: &ResolvedSettings, at: Option<Span>) -> Option<Diagnostic> {
        let Into::Movie(movie) = &self.into else { return None };
        let [w, h] = [settings.crop.width, settings.crop.height];
        let [w0, h0] = locked(movie).size().filter(|size| *size != [w, h])?;
        let message = format!("this frame is {w}×{h}, and those before it are {w0}×{h0}");
        let numbered = self.target.name.numbered_like("png");
        Some(
            Diagnostic::new(Code::BadProperty, at, message)
                .label("the same for all frames of one file")
                .hint(format!("give all frames one size, or each a file of its own: `-o '{numbered}'`")),
        )
    }

    /// What is left to do where a ray does not come back.
    fn left_undone(&self, frame: u32) -> impl FnOnce(Option<&Film>) + Send + 'static {
        let movie = match &self.into {
            Into::Files(_) => None,
            Into::Movie(movie) => Some((Arc::clone(movie), self.target.name.given().to_owned())),
        };
        move |_: Option<&Film>| {
            tell(format!("frame {frame} is left out: a ray does not come back"));
            if let Some((movie, path)) = movie {
                save_movie(&locked(&movie), &path).unwrap_or_else(|failure| tell_failure(&failure));
            }
        }
    }

    fn keep(&self, frame: u32, film: &Film, prepared: &Prepared) -> Result<(), Failure> {
        match &self.into {
            Into::Files(format) => {
                let path = self.target.name.of(frame);
                Saving::at(path, *format, &prepared.settings, self.animation.sources())?.save(film)
            }
            Into::Movie(movie) => {
                let pushed = locked(movie).push(film, &development(&prepared.settings));
                pushed.map_err(|fault| cannot_write(Path::new(&format!("frame {frame}")), fault))
            }
        }
    }

    fn count(
        &mut self,
        frame: u32,
        film: &Film,
        prepared: &Prepared,
        seconds: &Seconds,
    ) -> Result<(), Failure> {
        let total = &mut self.total;
        total.frames += 1;
        total.rays += film.report.rays.total();
        total.taken.merge(film.report.taken);
        total.settings = Some(prepared.settings);
        total.seconds.add(seconds);
        if self.args.stats.is_some() {
            let output = self.target.name.of(frame).display().to_string();
            data(stats::json(&self.args.file, &output, Some(frame), film, prepared, seconds))?;
        }
        Ok(())
    }

    /// Says what is wrong with a frame, but for what was said of one before.
    fn say(&mut self, frame: u32, diagnostics: Vec<Diagnostic>) {
        let news = self.animation.news(diagnostics);
        if news.is_empty() {
            return;
        }
        let ends = has_errors(&news);
        self.bar.aside(|| {
            tell(if ends {
                format!("at frame {frame}:")
            } else {
                format!("at frame {frame}, and perhaps later ones:")
            });
            show(&news, self.animation.sources());
        });
    }
}

fn is_interrupted() -> bool {
    CANCEL.load(Ordering::SeqCst)
}

fn locked(movie: &Mutex<Movie>) -> MutexGuard<'_, Movie> {
    movie.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

impl Total {
    /// "walk.gif  48 frames  320×180  4.1 s  4 samples a pixel  31 M rays".
    fn line(&self, name: &str, there: usize, wanted: usize) -> String {
        let frames = |n: usize| if n == 1 { "1 frame".to_owned() } else { format!("{n} frames") };
        let part = if self.frames == wanted { String::new() } else { format!(" of {wanted}") };
        let there = match there {
            0 => String::new(),
            1 => "  (1 was there)".to_owned(),
            n => format!("  ({n} were there)"),
        };
        let made = self.settings.map_or(String::new(), |settings| {
            format!("  {}", stats::made(&settings, self.taken, self.rays, &self.seconds))
        });
        format!("{name}  {}{part}{made}{there}", frames(self.frames))
    }
}
