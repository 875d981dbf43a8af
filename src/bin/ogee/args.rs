//! The command line as clap reads it. Help, completions and man pages come from here and from nowhere else.

mod accelerators;
mod rays;
mod tracers;

pub use accelerators::Accelerators;
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
use ogee::render::features::Layer;
use ogee::scene::{Accelerator, PixelFilter, SamplerKind, TracerKind};
pub use rays::Rays;
use std::ops::Range;
use std::path::PathBuf;
use std::str::FromStr;
pub use tracers::Tracers;

/// Ogee: write a scene as text, get a picture.
#[derive(Parser)]
#[command(
    name = "ogee",
    version,
    about,
    arg_required_else_help = true,
    args_override_self = true,
    max_term_width = 100
)]
#[command(after_help = "`-` in place of a file is standard input or output. \
    Exit codes: 0 done, 1 the scene is at fault or a comparison failed, 2 the command line is, \
    3 the machine is (disk, memory, an unreadable place), 130 interrupted, with the picture so far saved.")]
pub struct Ogee {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Subcommand)]
pub enum Command {
    /// Render a scene to a picture
    Render(Box<Render>),
    /// Say everything that is wrong with scenes, and render nothing
    Check(Check),
    /// Print the value of an expression
    Eval(Eval),
    /// Evaluate lines again and again, in one scope that stays
    Repl(Repl),
    /// Print how a scene was read: its syntax tree
    Ast(Ast),
    /// Print what a scene evaluates to: its objects, lights and cameras
    Inspect(Inspect),
    /// Lay out scenes in the one canonical way, comments kept
    Fmt(Fmt),
    /// Run the asserts of scenes, and compare their parse and picture with the snapshots beside them
    Test(Test),
    /// Measure how far two pictures are apart
    Compare(Compare),
    /// Measure kernels, tracers and trees: speed against error
    #[command(subcommand)]
    Bench(Bench),
    /// Print the reference page of a block, a function or a constant; or the whole reference
    Docs(Docs),
    /// Explain a diagnostic's code, with a broken and a mended scene; or list all codes
    Explain(Explain),
    /// Print a completion script for a shell
    Completions(Completions),
    /// Print the man page, or write one for each command into a folder
    Man(Man),
}

/// `ogee bench`.
#[derive(Subcommand)]
pub enum Bench {
    /// Measure every variant of every kernel, and write results and report; exits 1 where a default passes its bar
    Kernels(Kernels),
    /// Render scenes by several tracers with several seeds, and write time against error, noise and bias apart
    Tracers(Tracers),
    /// Put meshes under several trees, and write what building, memory and rays cost, and how that grows; exits 1 where a hit is wrong
    Accelerators(Accelerators),
    /// Ask a mesh about files of rays as standard input says, for comparisons with other programs
    #[command(hide = true)]
    Rays(Rays),
    /// Write the report again from results alone
    Report(BenchReport),
    /// Ask one variant for one input that a report names
    Repro(Repro),
    /// Make the calls of a component that `kernels --count` counts
    #[command(hide = true)]
    Count(BenchCount),
}

/// `ogee bench kernels`.
#[derive(Args)]
pub struct Kernels {
    /// Within a minute (the default)
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// More inputs and longer blocks, for the record
    #[arg(long)]
    pub full: bool,
    /// Folder for index.md, plots and results
    #[arg(long, value_name = "DIR", default_value = "report", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// These components alone: curves,roots
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Count the instructions of a call too, in some minutes more, where valgrind is installed
    #[arg(long)]
    pub count: bool,
    /// Exit 1 where the default's instructions, by those of the variant before all others, are a tenth above this report's
    #[arg(long, value_name = "DIR", requires = "count", value_hint = ValueHint::DirPath)]
    pub against: Option<PathBuf>,
}

/// `ogee bench count`.
#[derive(Args)]
pub struct BenchCount {
    /// The component, as `kernels --only` names it
    pub component: String,
}

/// `ogee bench report`.
#[derive(Args)]
pub struct BenchReport {
    /// The folder of the report, with its results
    #[arg(default_value = "report", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
}

/// `ogee bench repro`.
#[derive(Args)]
pub struct Repro {
    /// As the report names it: "cubic evaluation"
    pub component: String,
    /// The case set: "tiny tail"
    pub case: String,
    /// The variant: "horner"
    pub variant: String,
    /// The input, as hexadecimal floats
    #[arg(required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    pub input: Vec<String>,
}

/// What shapes every evaluation.
#[derive(Args, Clone, Default)]
pub struct Evaluation {
    /// Replace a top-level `let` of the scene: `--set count=12`
    #[arg(long, value_name = "NAME=VALUE", value_parser = pair)]
    pub set: Vec<(String, String)>,
    /// `time` in the scene, 0 up to 1 over an animation
    #[arg(long, value_name = "T", value_parser = finite, allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// Raise a guard: `--limit calls=100000`; nesting, calls, turns, list, file, memory, placements
    #[arg(long, value_name = "NAME=N", value_parser = limit)]
    pub limit: Vec<(LimitName, u64)>,
}

/// `ogee render`.
#[derive(Args)]
#[allow(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub struct Render {
    /// The scene; `-` reads standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The picture: .png, .jpg, .hdr or .exr; with `{frame:04}` in its name one a frame, as .gif or .apng all frames; `-` writes PNG to
    /// standard output [default: the scene's name, .png, or .gif for several frames]
    #[arg(short, long, value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// How light is followed
    #[arg(long, value_name = "TRACER", value_enum)]
    pub tracer: Option<Tracer>,
    /// Samples a pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub samples: Option<u32>,
    /// At most so many segments from the camera
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub depth: Option<u32>,
    /// Seed of every random number
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// How even the random numbers of a pixel are
    #[arg(long, value_name = "SAMPLER", value_enum)]
    pub sampler: Option<Sampler>,
    /// How a pixel weighs what lies around its centre
    #[arg(long, value_name = "FILTER", value_enum)]
    pub filter: Option<Filter>,
    /// Dims camera samples to this radiance, and tells how much light that took
    #[arg(long, value_name = "RADIANCE", value_parser = positive, allow_negative_numbers = true)]
    pub clamp: Option<f64>,
    /// The tree that finds what a ray meets
    #[arg(long, value_name = "TREE", value_enum)]
    pub accelerator: Option<Tree>,
    /// The camera with this label
    #[arg(long, value_name = "LABEL")]
    pub camera: Option<String>,
    #[command(flatten)]
    pub evaluation: Evaluation,
    /// Render these frames of an animation, the second not among them: `0..24`; with it: `0..=23`; one alone: `17` [default: all]
    #[arg(long, value_name = "A..B", value_parser = frames, conflicts_with = "time")]
    pub frames: Option<Range<u32>>,
    /// Render only the frames whose files are not there yet
    #[arg(long)]
    pub resume: bool,
    /// Render a part of the picture alone, in pixels from its top left corner
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    pub crop: Option<[u32; 4]>,
    /// Threads to work with [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Brighten by this many stops
    #[arg(long, value_name = "STOPS", value_parser = finite, allow_negative_numbers = true)]
    pub exposure: Option<f64>,
    /// Further layers of an EXR picture: `--layers depth,normal`
    #[arg(long, value_name = "LAYER,…", value_enum, value_delimiter = ',')]
    pub layers: Vec<LayerName>,
    /// Take as many samples as this time allows, at most `--samples`: `30s`, `500ms`, `2min`
    #[arg(long, value_name = "TIME", value_parser = budget, conflicts_with = "error")]
    pub budget: Option<f64>,
    /// Finish a pixel where its estimated relative error is this, `0.02`; `--samples` are then the most [default of these: 4096]
    #[arg(long, value_name = "SHARE", value_parser = positive)]
    pub error: Option<f64>,
    /// Remove noise from the finished picture
    #[arg(long)]
    pub denoise: bool,
    /// Print what was made and how long it took, on standard output
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub stats: Option<StatsFormat>,
}

/// `ogee check`.
#[derive(Args)]
pub struct Check {
    /// Scenes; `-` reads standard input
    #[arg(required = true, value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// How diagnostics are written; json goes to standard output
    #[arg(long, value_enum, default_value_t = DiagnosticFormat::Human)]
    pub format: DiagnosticFormat,
    #[command(flatten)]
    pub evaluation: Evaluation,
}

/// `ogee eval`.
#[derive(Args)]
pub struct Eval {
    /// The expression
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    pub expression: String,
    /// A scene whose names the expression may use
    #[arg(long = "in", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Print numbers to so many significant digits [default: as many as bring the same number back]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=100))]
    pub digits: Option<u8>,
    #[command(flatten)]
    pub evaluation: Evaluation,
}

/// `ogee repl`.
#[derive(Args)]
pub struct Repl {
    /// A scene whose names the lines may use; it is evaluated first
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Print numbers to so many significant digits [default: as many as bring the same number back]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=100))]
    pub digits: Option<u8>,
    #[command(flatten)]
    pub evaluation: Evaluation,
}

/// `ogee ast`.
#[derive(Args)]
pub struct Ast {
    /// The scene; `-` reads standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The form of the tree
    #[arg(long, value_enum, default_value_t = DataFormat::Text)]
    pub format: DataFormat,
}

/// `ogee inspect`.
#[derive(Args)]
pub struct Inspect {
    /// The scene; `-` reads standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The form of the hierarchy
    #[arg(long, value_enum, default_value_t = DataFormat::Text)]
    pub format: DataFormat,
    #[command(flatten)]
    pub evaluation: Evaluation,
}

/// `ogee fmt`.
#[derive(Args)]
pub struct Fmt {
    /// Scenes, rewritten in place; `-` reads standard input and writes to standard output
    #[arg(required = true, value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// Write nothing; name the files that are laid out otherwise, and exit 1 if there are any
    #[arg(long)]
    pub check: bool,
}

/// `ogee test`.
#[derive(Args)]
pub struct Test {
    /// Scenes, and folders of scenes
    #[arg(required = true, value_name = "PATH", value_hint = ValueHint::AnyPath)]
    pub paths: Vec<PathBuf>,
    /// Write the snapshots that are missing or differ, instead of failing
    #[arg(long)]
    pub bless: bool,
    #[command(flatten)]
    pub evaluation: Evaluation,
}

/// `ogee compare`.
#[derive(Args)]
pub struct Compare {
    /// The picture to judge
    #[arg(value_name = "A", value_hint = ValueHint::FilePath)]
    pub actual: PathBuf,
    /// The reference
    #[arg(value_name = "B", value_hint = ValueHint::FilePath)]
    pub reference: PathBuf,
    /// Exit 1 if the root mean square error is above this
    #[arg(long, value_name = "X", value_parser = non_negative)]
    pub max_rmse: Option<f64>,
    /// The form of the result
    #[arg(long, value_enum, default_value_t = DataFormat::Text)]
    pub format: DataFormat,
}

/// `ogee docs`.
#[derive(Args)]
pub struct Docs {
    /// A kind of block, a function or a constant; without it, the whole reference
    pub name: Option<String>,
}

/// `ogee explain`.
#[derive(Args)]
pub struct Explain {
    /// A code as diagnostics show it: E0101
    pub code: Option<String>,
}

/// `ogee completions`.
#[derive(Args)]
pub struct Completions {
    /// The shell
    pub shell: Shell,
}

/// `ogee man`.
#[derive(Args)]
pub struct Man {
    /// The folder; it is made if it is not there
    #[arg(value_hint = ValueHint::DirPath)]
    pub folder: Option<PathBuf>,
}

/// Forms of diagnostics.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DiagnosticFormat {
    /// For people
    Human,
    /// An object a line
    Json,
    /// `file:line:column: error[CODE]: message`
    Short,
}

/// Forms of data.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DataFormat {
    /// For people
    Text,
    /// For programs
    Json,
}

/// Forms of `--stats`.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum StatsFormat {
    /// One JSON object
    Json,
}

/// The tracers by the language's words.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "lower")]
#[allow(missing_docs, reason = "the names are the words of the language")]
pub enum Tracer {
    Raycast,
    Whitted,
    MonteCarlo,
    Path,
    Irradiance,
    Photon,
}

impl From<Tracer> for TracerKind {
    fn from(tracer: Tracer) -> Self {
        match tracer {
            Tracer::Raycast => TracerKind::Raycast,
            Tracer::Whitted => TracerKind::Whitted,
            Tracer::MonteCarlo => TracerKind::MonteCarlo,
            Tracer::Path => TracerKind::Path,
            Tracer::Irradiance => TracerKind::Irradiance,
            Tracer::Photon => TracerKind::Photon,
        }
    }
}

/// The samplers by the language's words.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "lower")]
#[allow(missing_docs, reason = "the names are the words of the language")]
pub enum Sampler {
    Sobol,
    Stratified,
    Independent,
}

impl From<Sampler> for SamplerKind {
    fn from(sampler: Sampler) -> Self {
        match sampler {
            Sampler::Sobol => SamplerKind::Sobol,
            Sampler::Stratified => SamplerKind::Stratified,
            Sampler::Independent => SamplerKind::Independent,
        }
    }
}

/// The reconstruction filters by the language's words.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "lower")]
#[allow(missing_docs, reason = "the names are the words of the language")]
pub enum Filter {
    Box,
    Tent,
    Gaussian,
}

impl From<Filter> for PixelFilter {
    fn from(filter: Filter) -> Self {
        match filter {
            Filter::Box => PixelFilter::Box,
            Filter::Tent => PixelFilter::Tent,
            Filter::Gaussian => PixelFilter::Gaussian,
        }
    }
}

/// The layers of EXR pictures.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[allow(missing_docs, reason = "named as the members of `ogee::render::features::Layer`")]
pub enum LayerName {
    Albedo,
    Normal,
    Depth,
    Position,
    Variance,
    Source,
}

impl From<LayerName> for Layer {
    fn from(name: LayerName) -> Self {
        match name {
            LayerName::Albedo => Layer::Albedo,
            LayerName::Normal => Layer::Normal,
            LayerName::Depth => Layer::Depth,
            LayerName::Position => Layer::Position,
            LayerName::Variance => Layer::Variance,
            LayerName::Source => Layer::Source,
        }
    }
}

/// The accelerators by the language's words.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "lower")]
#[allow(missing_docs, reason = "the names are the words of the language")]
#[allow(clippy::enum_variant_names, reason = "the words of the language")]
pub enum Tree {
    Bvh,
    KdTree,
    None,
}

impl From<Tree> for Accelerator {
    fn from(tree: Tree) -> Self {
        match tree {
            Tree::Bvh => Accelerator::Bvh,
            Tree::KdTree => Accelerator::KdTree,
            Tree::None => Accelerator::None,
        }
    }
}

/// The guards of `--limit`.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[allow(missing_docs, reason = "named as the members of `ogee::session::Limits`")]
pub enum LimitName {
    Nesting,
    Calls,
    Turns,
    List,
    File,
    Memory,
    Placements,
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.to_owned()))
        }
        _ => Err("write it as name=value".to_owned()),
    }
}

fn limit(text: &str) -> Result<(LimitName, u64), String> {
    let (name, value) = pair(text)?;
    let known = || {
        let names = LimitName::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        names.map(|v| v.get_name().to_owned()).collect::<Vec<_>>().join(", ")
    };
    let name = LimitName::from_str(&name, true).map_err(|_| format!("the guards are {}", known()))?;
    let value = value.trim().replace('_', "");
    let value = value.parse().map_err(|_| format!("`{value}` is not a whole number"))?;
    Ok((name, value))
}

fn finite(text: &str) -> Result<f64, String> {
    match f64::from_str(text) {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("a finite number is expected".to_owned()),
    }
}

fn non_negative(text: &str) -> Result<f64, String> {
    finite(text).and_then(|x| if x >= 0.0 { Ok(x) } else { Err("a number of at least 0 is expected".into()) })
}

fn positive(text: &str) -> Result<f64, String> {
    finite(text).and_then(|x| if x > 0.0 { Ok(x) } else { Err("a number above 0 is expected".into()) })
}

/// A time with its unit, in seconds.
fn budget(text: &str) -> Result<f64, String> {
    let unit = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let seconds = match &text[unit..] {
        "ms" => 1e-3,
        "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return Err("write it with its unit: 500ms, 30s, 2min, 1h".to_owned()),
    };
    positive(text[..unit].trim()).map(|n| n * seconds)
}

fn threads(text: &str) -> Result<usize, String> {
    /// More threads than any machine has gain nothing, and asking for very many exhausts it.
    const MOST: usize = 4096;
    match text.parse() {
        Ok(n) if (1..=MOST).contains(&n) => Ok(n),
        _ => Err(format!("a whole number from 1 to {MOST} is expected")),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X', '×']).or_else(|| text.split_once(','));
    match sides.map(|(w, h)| (w.trim().parse(), h.trim().parse())) {
        Some((Ok(w), Ok(h))) if w > 0 && h > 0 => Ok([w, h]),
        _ => Err("write it as WIDTHxHEIGHT, both above 0: 640x480".to_owned()),
    }
}

/// Half open, as ranges of the language are; or with `..=`, or one number.
fn frames(text: &str) -> Result<Range<u32>, String> {
    let number = |text: &str| text.trim().parse::<u32>().ok().filter(|n| *n < u32::MAX);
    let range = match (text.split_once("..="), text.split_once("..")) {
        (Some((first, last)), _) => number(first).zip(number(last).map(|last| last + 1)),
        (None, Some((first, end))) => number(first).zip(number(end)),
        (None, None) => number(text).map(|frame| (frame, frame + 1)),
    };
    match range {
        None => Err("write it as 0..24 for frames 0 to 23, or 0..=23".to_owned()),
        Some((first, end)) if first >= end => {
            Err(format!("there is no frame in it; {first}..={first} is one"))
        }
        Some((first, end)) => Ok(first..end),
    }
}

fn crop(text: &str) -> Result<[u32; 4], String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, w, h]) if w > 0 && h > 0 => Ok([x, y, w, h]),
        _ => Err("write it as x,y,width,height in pixels: 100,50,64,64".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_of_the_command_line_is_sound() {
        <Ogee as clap::CommandFactory>::command().debug_assert();
    }

    #[test]
    fn frames_are_half_open_unless_they_say_otherwise() {
        assert_eq!(frames("0..24"), Ok(0..24));
        assert_eq!(frames("3..=5"), Ok(3..6));
        assert_eq!(frames("17"), Ok(17..18));
        for bad in
            ["", "..", "4..", "..4", "a..b", "-1..3", "0...3", "1.5..2", "0..99999999999", "0..4294967296"]
        {
            assert!(frames(bad).unwrap_err().contains("0..24"), "{bad}");
        }
        for empty in ["5..5", "9..3", "9..=3", "4294967295..=3"] {
            assert!(frames(empty).is_err(), "{empty}");
        }
    }

    #[test]
    fn times_have_a_unit() {
        assert_eq!(["500ms", "30s", "2 min", "1h"].map(budget), [0.5, 30.0, 120.0, 3600.0].map(Ok));
        for bad in ["", "30", "s", "-1s", "0s", "1e9x", "3 days"] {
            assert!(budget(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_and_crops_need_all_their_numbers() {
        assert_eq!(size("64x48"), Ok([64, 48]));
        assert!(size("64").is_err() && size("0x4").is_err() && size("axb").is_err());
        assert_eq!(crop("1,2,3,4"), Ok([1, 2, 3, 4]));
        assert!(crop("1,2,3").is_err() && crop("1,2,0,4").is_err());
    }
}
