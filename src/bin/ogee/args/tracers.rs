//! The command line of `ogee bench tracers`.

use super::{Evaluation, Sampler, Tracer, size, threads};
use clap::{Args, ValueEnum, ValueHint};
use ogee::report::tracers::Variant;
use std::path::PathBuf;

/// `ogee bench tracers`.
#[derive(Args)]
pub struct Tracers {
    /// The scenes
    #[arg(required = true, value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub scenes: Vec<PathBuf>,
    /// What is compared: a tracer, or a tracer and a sampler; the others are compared with the first
    #[arg(
        long,
        value_name = "TRACER[:SAMPLER],…",
        value_delimiter = ',',
        value_parser = variant,
        default_value = "path,path:stratified,path:independent,montecarlo,photon,irradiance"
    )]
    pub variants: Vec<Variant>,
    /// Samples a pixel
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "4,16,64", value_parser = clap::value_parser!(u32).range(1..))]
    pub samples: Vec<u32>,
    /// Pictures of each, with a seed each
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(2..))]
    pub seeds: u32,
    /// The true picture, of the same size: .exr, .hdr or .png
    #[arg(long, value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    pub reference: Option<PathBuf>,
    /// The true picture is one of `path` of so many samples [default: 64 times the most of `--samples`]
    #[arg(long, value_name = "N", conflicts_with = "reference", value_parser = clap::value_parser!(u32).range(2..))]
    pub reference_samples: Option<u32>,
    /// Width and height in pixels [default: the scene's shape, no side over 128]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// At most so many segments from the camera
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub depth: Option<u32>,
    /// The camera with this label
    #[arg(long, value_name = "LABEL")]
    pub camera: Option<String>,
    /// Threads to measure with [default: 1]; the reference takes all
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Folder for index.md, plots and results
    #[arg(long, value_name = "DIR", default_value = "report-tracers", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    #[command(flatten)]
    pub evaluation: Evaluation,
}

/// `photon`, or `path:independent`.
fn variant(text: &str) -> Result<Variant, String> {
    let (tracer, sampler) = text.split_once(':').unwrap_or((text, "sobol"));
    let words = |of: Vec<String>| of.join(", ");
    let tracer = Tracer::from_str(tracer, false)
        .map_err(|_| format!("there is no tracer `{tracer}`; there are {}", words(names::<Tracer>())))?;
    let sampler = Sampler::from_str(sampler, false)
        .map_err(|_| format!("there is no sampler `{sampler}`; there are {}", words(names::<Sampler>())))?;
    Ok(Variant { tracer: tracer.into(), sampler: sampler.into() })
}

fn names<V: ValueEnum>() -> Vec<String> {
    let named = V::value_variants().iter().filter_map(ValueEnum::to_possible_value);
    named.map(|value| value.get_name().to_owned()).collect()
}
