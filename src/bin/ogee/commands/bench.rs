//! `ogee bench`: kernels, tracers and trees measured, and the reports of it.

mod accelerators;
mod counts;
mod rays;
mod tracers;

use crate::args::{Bench, BenchReport, Kernels, Repro};
use crate::place::Place;
use crate::speech::{Ended, Exit, Failure, data, reason, tell};
use ogee::diag::nearest;
use ogee::math::hex::parse_hex_list;
use ogee::report::accelerators::{self as of_accelerators, AcceleratorRow};
use ogee::report::components::{COMPONENTS, SEED};
use ogee::report::page::{Link, Page, render, short};
use ogee::report::row::{Machine, Row};
use ogee::report::tracers::TracerRow;
use ogee::report::trial::{Only, Plan};
use ogee::report::{measure, reproduce, store, tracers as of_tracers};
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};

/// The mode of a report of tracers.
const TRACERS: &str = "tracers";
/// The mode of a report of trees.
const ACCELERATORS: &str = "accelerators";

/// Measures, reports, or asks for one input.
pub fn run(args: &Bench) -> Ended {
    match args {
        Bench::Kernels(args) => kernels(args),
        Bench::Tracers(args) => tracers::run(args),
        Bench::Accelerators(args) => accelerators::run(args),
        Bench::Rays(args) => rays::run(args),
        Bench::Report(args) => report(args),
        Bench::Repro(args) => repro(args),
        Bench::Count(args) => counts::make_calls(&args.component),
    }
}

fn kernels(args: &Kernels) -> Ended {
    let names = || COMPONENTS.iter().map(|(name, _)| *name);
    if let Some(unknown) = args.only.iter().find(|wanted| !names().any(|name| name == **wanted)) {
        let near = nearest(unknown, names()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let all = names().collect::<Vec<_>>().join(", ");
        return Err(Failure::usage(format!("there is no component `{unknown}`\n{near}there are {all}")));
    }
    make_results(&args.out)?;
    let (mode, plan) = if args.full { ("full", Plan::full()) } else { ("quick", Plan::quick()) };
    let mut machine = machine(mode);
    let mut rows = measure(&plan, &args.only, |name| tell(format!("measuring {name}")));
    match counts::counter() {
        Some(counter) if args.count => {
            machine.counter = counter;
            counts::fill(&mut rows, &args.only)?;
        }
        None if args.count => tell("valgrind is not installed: instructions are not counted"),
        _ => {}
    }
    write(&args.out, &store::write(&machine, &rows, |row| &row.component))?;
    write(&args.out, &render(&machine, &rows, &beside(&args.out)))?;
    tell(format!("wrote {}", args.out.join("index.md").display()));
    let broken: Vec<&Row> = rows.iter().filter(|row| !row.within_bar()).collect();
    for row in &broken {
        let bar = short(row.bar.unwrap_or(0.0));
        let wrong = row.missed + row.spurious + row.not_finite;
        tell(format!(
            "{}, {}: {} {}, {wrong} wrong; the bar is {bar}, none wrong",
            row.component,
            row.case,
            short(row.error_max),
            row.error_unit
        ));
    }
    let grown = match &args.against {
        Some(report) => counts::grown(&rows, &rows_of(&results_in(report)?)?.1),
        None => Vec::new(),
    };
    grown.iter().for_each(tell);
    Ok(if broken.is_empty() && grown.is_empty() { Exit::Done } else { Exit::Scene })
}

/// Makes a report's folder for results, and the folders around it.
fn make_results(report: &Path) -> Result<(), Failure> {
    let results = report.join("results");
    std::fs::create_dir_all(&results)
        .map_err(|error| Failure::machine(format!("cannot make {}", results.display()), reason(&error)))
}

fn write(folder: &Path, pages: &[Page]) -> Result<(), Failure> {
    pages.iter().try_for_each(|page| Place::try_at(&folder.join(&page.name))?.write(page.text.as_bytes()))
}

/// Renders what the result files of a folder hold: kernels in the order of their components, tracers by scene, or trees by mesh.
fn report(args: &BenchReport) -> Ended {
    let texts = results_in(&args.folder)?;
    let mode = match texts.first() {
        Some(_) => rows_of::<serde_json::Value>(&texts[..1])?.0.mode,
        None => String::new(),
    };
    if mode == ACCELERATORS {
        let (machine, rows) = rows_of::<AcceleratorRow>(&texts)?;
        write(&args.folder, &of_accelerators::page::render(&machine, &rows))?;
    } else if mode == TRACERS {
        let (machine, rows) = rows_of::<TracerRow>(&texts)?;
        write(&args.folder, &of_tracers::page::render(&machine, &rows))?;
    } else {
        let (machine, mut rows) = rows_of(&texts)?;
        store::sort(&mut rows);
        write(&args.folder, &render(&machine, &rows, &beside(&args.folder)))?;
    }
    Ok(Exit::Done)
}

/// The reports in folders of a report's folder, by title, in the order of their names.
fn beside(report: &Path) -> Vec<Link> {
    let folders = std::fs::read_dir(report).into_iter().flatten().flatten();
    let link = |folder: std::fs::DirEntry| {
        let text = std::fs::read_to_string(folder.path().join("index.md")).ok()?;
        let title = text.lines().next()?.strip_prefix("# ")?.to_owned();
        Some((title, format!("{}/index.md", folder.file_name().to_str()?)))
    };
    let mut links: Vec<Link> = folders.filter_map(link).collect();
    links.sort_by(|a, b| a.1.cmp(&b.1));
    links
}

/// The result files of a report's folder with their texts, in the order of their names.
fn results_in(report: &Path) -> Result<Vec<(PathBuf, String)>, Failure> {
    let results = report.join("results");
    let cannot = |what: &Path, error: &std::io::Error| {
        Failure::machine(format!("cannot read {}", what.display()), reason(error))
    };
    let entries = std::fs::read_dir(&results).map_err(|error| cannot(&results, &error))?;
    let mut files: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "jsonl"));
    files.sort();
    let text_of = |file: PathBuf| match std::fs::read_to_string(&file) {
        Ok(text) => Ok((file, text)),
        Err(error) => Err(cannot(&file, &error)),
    };
    files.into_iter().map(text_of).collect()
}

/// The machine of the last file, and the rows of all.
fn rows_of<R: DeserializeOwned>(texts: &[(PathBuf, String)]) -> Result<(Machine, Vec<R>), Failure> {
    let (mut machine, mut rows) = (Machine::default(), Vec::new());
    for (file, text) in texts {
        let (of_file, mut own) = store::read(text).map_err(|error| Failure {
            exit: Exit::Scene,
            message: format!("{}: {error}", file.display()),
        })?;
        machine = of_file;
        rows.append(&mut own);
    }
    Ok((machine, rows))
}

fn repro(args: &Repro) -> Ended {
    let Some(input) = parse_hex_list(&args.input.join(" ")) else {
        return Err(Failure::usage("the input is not hexadecimal floats like -0x1.8p+3"));
    };
    let only = Only {
        component: args.component.clone(),
        case: args.case.clone(),
        variant: args.variant.clone(),
        input,
    };
    let Some(row) = reproduce(only) else {
        return Err(Failure::usage(
            "there is no such variant, or its inputs have another number of numbers\nthe report has a line to copy for each",
        ));
    };
    data(format!(
        "answer    {}\nerror     {} {}\nmissed    {}\nspurious  {}\nwork      {} {}\n",
        row.answer, row.error_max, row.error_unit, row.missed, row.spurious, row.work, row.work_unit
    ))?;
    Ok(Exit::Done)
}

/// What is known of the machine and the build; blank where nothing is.
fn machine(mode: &str) -> Machine {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let cpuinfo = read("/proc/cpuinfo");
    let cpu = cpuinfo.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let load = read("/proc/loadavg").split(' ').next().and_then(|load| load.parse().ok());
    let wide = if cfg!(target_feature = "avx2") { "avx2" } else { "baseline features" };
    let git = std::process::Command::new("git").args(["rev-parse", "--short", "HEAD"]).output();
    let commit = git.ok().filter(|out| out.status.success()).map(|out| out.stdout);
    Machine {
        cpu: cpu.map_or_else(|| "an unknown processor".into(), |(_, name)| name.trim().to_owned()),
        target: format!("{} with {wide}", std::env::consts::ARCH),
        version: env!("CARGO_PKG_VERSION").into(),
        commit: commit.map_or(String::new(), |hash| String::from_utf8_lossy(&hash).trim().to_owned()),
        build: if cfg!(debug_assertions) { "with debug assertions" } else { "optimised" }.into(),
        seed: SEED,
        load: load.unwrap_or(0.0),
        mode: mode.into(),
        counter: String::new(),
    }
}
