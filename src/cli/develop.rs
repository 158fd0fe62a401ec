//! `lightsplat develop`: makes a PNG of an OpenEXR image, with another exposure or view.

use super::exit::{self, Failure};
use super::outputs::{Inputs, OutputCheck, check_outputs};
use super::png_args::ToneArgs;
use super::{picture, talk};
use base::film::{ExrFile, Shown, write_png};
use clap::Args;
use std::path::PathBuf;

/// Options of `develop`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct DevelopArgs {
    /// OpenEXR image to convert, from lightsplat or another renderer
    pub input: PathBuf,
    /// Image to write [default: the input with the extension .png]
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// Exposure and view.
    #[command(flatten)]
    tone: ToneArgs,
}

/// Runs the command.
pub fn run(args: DevelopArgs) -> Result<(), Failure> {
    let output = args.output.unwrap_or_else(|| args.input.with_extension("png"));
    check_outputs(None, Some(&output), OutputCheck::default())?;
    Inputs::new([&args.input]).check_apart([output.as_path()])?;
    let file = ExrFile::read(&args.input).map_err(Failure::input)?;
    let mut color = file.color().map_err(Failure::input)?;
    picture::mend(&args.input, "", &mut color);
    let alpha = file.alpha();
    let shown = Shown { color: &color, alpha: alpha.as_ref() };
    let look = args.tone.tone().look(shown);
    write_png(&output, shown, look).map_err(Failure::output)?;
    let (path, exposure, view) = (output.display(), look.said(), look.curve.name());
    let said = format!("wrote {path} ({}x{}, {exposure}, view {view})", color.width, color.height);
    talk::wrote(&said, &[output]);
    Ok(())
}
