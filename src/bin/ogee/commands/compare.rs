//! `ogee compare`: how far two pictures are apart.

use crate::args::{Compare, DataFormat};
use crate::speech::{Ended, Exit, Failure, data, tell};
use ogee::render::compare::{CompareFault, Difference, Picture, compare};
use std::path::Path;

/// Prints the measures; exits 1 where the threshold is passed.
pub fn run(args: &Compare) -> Ended {
    let (actual, reference) = (picture(&args.actual)?, picture(&args.reference)?);
    let difference = compare(&actual, &reference).map_err(|fault| Failure {
        exit: Exit::Scene,
        message: format!(
            "{} and {} cannot be compared: {fault}",
            args.actual.display(),
            args.reference.display()
        ),
    })?;
    data(match args.format {
        DataFormat::Text => text(&difference),
        DataFormat::Json => json(&difference),
    })?;
    match args.max_rmse {
        Some(most) if !difference.is_within(most) => {
            tell(format!("the RMSE {} is above {most}", difference.rmse));
            Ok(Exit::Scene)
        }
        _ => Ok(Exit::Done),
    }
}

fn picture(file: &Path) -> Result<Picture, Failure> {
    let bytes = super::read(file)?;
    Picture::decode(&bytes).map_err(|fault| match fault {
        CompareFault::Decode(_) | CompareFault::Size(..) => {
            Failure { exit: Exit::Scene, message: format!("{}: {fault}", file.display()) }
        }
    })
}

fn text(difference: &Difference) -> String {
    let Difference { rmse, relative_mse, ssim, largest } = difference;
    format!(
        "rmse          {rmse}\nrelative mse  {relative_mse}\nssim          {ssim}\nlargest       {largest}\n"
    )
}

fn json(difference: &Difference) -> String {
    let Difference { rmse, relative_mse, ssim, largest } = difference;
    let object = serde_json::json!({
        "rmse": rmse, "relative_mse": relative_mse, "ssim": ssim, "largest": largest
    });
    format!("{object}\n")
}
