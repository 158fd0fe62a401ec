//! `farm/movie.sh`, with a script in the place of ffmpeg that tells its arguments.
#![cfg(unix)]

use super::{Finished, Sandbox};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

/// Writes its arguments to a file, and a movie to the last of them unless it is to fail.
const FFMPEG: &str = "#!/bin/sh
printf '%s\\n' \"$@\" >arguments
test -e fail && exit 7
for last; do :; done
echo movie >\"$last\"
";

fn movie(sandbox: &Sandbox, arguments: &[&str]) -> Finished {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/farm/movie.sh");
    let path = format!("{}:{}", sandbox.path("bin").display(), std::env::var("PATH").unwrap());
    let mut command = Command::new("bash");
    command.arg(script).args(arguments).current_dir(sandbox.path("")).env("PATH", path);
    Finished::from(command.output().unwrap())
}

#[test]
fn movies_are_of_all_frames_and_whole_or_not_at_all() {
    let sandbox = Sandbox::new();
    fs::create_dir(sandbox.path("bin")).unwrap();
    let ffmpeg = sandbox.path("bin/ffmpeg");
    fs::write(&ffmpeg, FFMPEG).unwrap();
    fs::set_permissions(&ffmpeg, fs::Permissions::from_mode(0o755)).unwrap();
    for frame in 8..=11 {
        fs::write(sandbox.path(&format!("f.{frame:04}.png")), "frame").unwrap();
        fs::write(sandbox.path(&format!("f.{frame:04}.records.png")), "layer").unwrap();
    }
    movie(&sandbox, &["f.%04d.png", "a.mp4", "12", "8"]).expect(0);
    let arguments = fs::read_to_string(sandbox.path("arguments")).unwrap();
    let arguments: Vec<&str> = arguments.lines().collect();
    let input = ["-framerate", "12", "-start_number", "8", "-i", "f.%04d.png"];
    assert!(arguments.windows(input.len()).any(|window| window == input), "{arguments:?}");
    assert_eq!(fs::read_to_string(sandbox.path("a.mp4")).unwrap(), "movie\n");
    // A frame that lacks, an encoder that fails, and wrong names leave the movie as it was.
    fs::write(sandbox.path("a.mp4"), "old").unwrap();
    let fails = |arguments: &[&str], code, reason: &str| {
        let stderr = movie(&sandbox, arguments).expect(code).stderr;
        assert!(stderr.contains(reason), "{stderr}");
        assert_eq!(fs::read_to_string(sandbox.path("a.mp4")).unwrap(), "old");
    };
    fails(&["f.%04d.png", "a.mp4"], 1, "f.0001.png is missing");
    fails(&["f.%04d.png", "a.mp4", "24", "12"], 1, "no frames from 12 on");
    fails(&["f.####.png", "a.mp4", "24", "8"], 1, "f.%04d.png");
    fails(&["f.%04d.png"], 2, "FRAMES_A_SECOND");
    fs::remove_file(sandbox.path("f.0010.png")).unwrap();
    fails(&["f.%04d.png", "a.mp4", "24", "8"], 1, "f.0010.png is missing");
    fs::write(sandbox.path("f.0010.png"), "frame").unwrap();
    fs::write(sandbox.path("fail"), "").unwrap();
    fails(&["f.%04d.png", "a.mp4", "24", "8"], 7, "");
}
