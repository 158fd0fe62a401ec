//! `lightsplat develop`: makes a PNG of an OpenEXR image, with another exposure or view. Programs read its pixels from
//! standard output.

use super::exit::{self, Failure};
use super::outputs::{Inputs, OutputCheck, check_outputs};
use super::png_args::ToneArgs;
use super::{picture, talk};
use base::film::{ExrFile, Look, Shown, write_png};
use clap::Args;
use std::path::{Path, PathBuf};

/// Options of `develop`.
#[derive(Debug, Args)]
#[command(after_long_help = exit::HELP)]
pub struct DevelopArgs {
    /// OpenEXR image to convert, from lightsplat or another renderer
    pub input: PathBuf,
    /// Image to write. `-` is standard output, which gets an uncompressed image (PAM) for programs [default: the input
    /// with the extension .png]
    #[arg(short, long, value_name = "FILE.png|-")]
    output: Option<PathBuf>,
    /// Exposure and view.
    #[command(flatten)]
    tone: ToneArgs,
}

/// Runs the command.
pub fn run(args: DevelopArgs) -> Result<(), Failure> {
    let output = args.output.unwrap_or_else(|| args.input.with_extension("png"));
    let is_piped = output == Path::new("-");
    if !is_piped {
        check_outputs(None, Some(&output), OutputCheck::default())?;
        Inputs::new([&args.input]).check_apart([output.as_path()])?;
    }
    let file = ExrFile::read(&args.input).map_err(Failure::input)?;
    let mut color = file.color().map_err(Failure::input)?;
    picture::mend(&args.input, "", &mut color);
    let alpha = file.alpha();
    let shown = Shown { color: &color, alpha: alpha.as_ref() };
    let look = args.tone.tone().look(shown);
    let said = format!("({}x{}, {}, view {})", color.width, color.height, look.said(), look.curve.name());
    if is_piped {
        talk::note(&format!("wrote to standard output {said}"));
        return talk::print_bytes(&to_pam(shown, look));
    }
    write_png(&output, shown, look).map_err(Failure::output)?;
    talk::wrote(&format!("wrote {} {said}", output.display()), &[output]);
    Ok(())
}

/// Returns an image for display as a Portable Arbitrary Map: a head in text, then a byte per channel.
fn to_pam(shown: Shown, look: Look) -> Vec<u8> {
    let (width, height) = (shown.color.width, shown.color.height);
    let (depth, kind) = if shown.alpha.is_some() { (4, "RGB_ALPHA") } else { (3, "RGB") };
    let head =
        format!("P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH {depth}\nMAXVAL 255\nTUPLTYPE {kind}\nENDHDR\n");
    [head.as_bytes(), &look.to_bytes(shown)].concat()
}
