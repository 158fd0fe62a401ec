//! The scripts in `farm/slurm`, with a script in the place of sbatch that runs the tasks of an array one by one.
#![cfg(target_os = "linux")]

use super::{Sandbox, read};
use lightsplat::film::ExrFile;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;

/// Runs every task of a job at once, and prints a number of the job. Options of sbatch begin with two dashes.
const SBATCH: &str = r#"#!/usr/bin/env bash
set -euo pipefail
tasks=0-0
while [[ $1 == -* ]]; do
  case $1 in
  --array=*) tasks=${1#--array=} ;;
  esac
  echo "$1" >>options.txt
  shift
done
export SLURM_ARRAY_JOB_ID=1
for ((task = ${tasks%-*}; task <= ${tasks#*-}; task++)); do
  SLURM_ARRAY_TASK_ID=$task bash "$@" >&2
done
echo 1
"#;

/// Runs a script of the farm; returns what it said, and the options that sbatch got.
#[track_caller]
fn submit(sandbox: &Sandbox, script: &str, arguments: &[&str]) -> (String, String) {
    submit_grouped(sandbox, script, arguments, "")
}

/// Runs a script as [`submit`] does, with so many entries per task.
#[track_caller]
fn submit_grouped(sandbox: &Sandbox, script: &str, arguments: &[&str], entries: &str) -> (String, String) {
    let file = format!("{}/farm/slurm/{script}", env!("CARGO_MANIFEST_DIR"));
    let program = sandbox.path("sbatch");
    fs::write(&program, SBATCH).unwrap();
    fs::set_permissions(&program, Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", sandbox.path("").display(), std::env::var("PATH").unwrap());
    let mut command = std::process::Command::new("bash");
    command.arg(file).args(arguments).current_dir(sandbox.path("")).env("PATH", path);
    command.env("LIGHTSPLAT", env!("CARGO_BIN_EXE_lightsplat")).env("CPUS_PER_TASK", "3");
    command.env("ENTRIES_PER_TASK", entries);
    let finished = super::Finished::from(command.output().unwrap()).expect(0);
    let options = fs::read_to_string(sandbox.path("options.txt")).unwrap();
    fs::remove_file(sandbox.path("options.txt")).unwrap();
    (finished.stdout, options)
}

const SMALL: [&str; 7] = ["--method", "path", "--spp", "2", "--resolution", "24x16", "--reproducible"];

#[test]
fn stills_have_a_task_each() {
    let sandbox = Sandbox::new();
    let jobs = "options = { method = 'path', spp = 2, resolution = '24x16' }\n[[picture]]\nscene = 'room.xml'\n\
                output = 'a.exr'\n[[picture]]\nscene = 'room.xml'\noutput = 'b.exr'\n";
    fs::write(sandbox.path("jobs.toml"), jobs).unwrap();
    let (said, options) = submit(&sandbox, "stills.sh", &["jobs.toml"]);
    assert_eq!(said, "images: job 1\n");
    assert_eq!(options, "--parsable\n--array=1-2\n--cpus-per-task=3\n");
    assert!(["a.exr", "a.png", "b.exr", "b.png"].iter().all(|name| sandbox.path(name).exists()));
    let third = format!("{jobs}[[picture]]\nscene = 'room.xml'\noutput = 'c.exr'\n");
    fs::write(sandbox.path("jobs.toml"), third).unwrap();
    let (_, options) = submit_grouped(&sandbox, "stills.sh", &["jobs.toml"], "2");
    assert!(options.contains("--array=1-2") && sandbox.path("c.exr").exists(), "{options}");
}

#[test]
fn tiles_are_parts_of_the_image() {
    let sandbox = Sandbox::new();
    let (_, options) =
        submit(&sandbox, "tiles.sh", &[&["room.xml", "out/t.exr", "3x2"], &SMALL[..]].concat());
    assert!(options.contains("--array=0-5"), "{options}");
    sandbox.run(&[&["render", "room.xml", "-o", "full.exr"], &SMALL[..]].concat()).expect(0);
    let full = ExrFile::read(&sandbox.path("full.exr")).unwrap().color().unwrap();
    let mut seen = vec![false; full.pixels.len()];
    for tile in 0..6 {
        let file = ExrFile::read(&sandbox.path(&format!("out/t.tile.{tile}.exr"))).unwrap();
        let window = file.window();
        for (at, pixel) in window.film_pixels().zip(file.color().unwrap().pixels) {
            let index = (at[1] * 24 + at[0]) as usize;
            assert_eq!(full.pixels[index], pixel, "{at:?}");
            assert!(!std::mem::replace(&mut seen[index], true), "{at:?} is in two tiles");
        }
    }
    assert!(!seen.contains(&false));
}

#[test]
fn seeds_are_merged_and_walks_end_in_a_sheet() {
    let sandbox = Sandbox::new();
    let (said, options) =
        submit(&sandbox, "seeds.sh", &[&["room.xml", "out/s.exr", "2"], &SMALL[..]].concat());
    assert_eq!(said, "seeds: job 1; merging: job 1\n");
    assert!(options.contains("--array=1-2") && options.contains("--dependency=afterok:1"), "{options}");
    sandbox.run(&["merge", "out/s.seed.1.exr", "out/s.seed.2.exr", "-o", "own.exr"]).expect(0);
    assert!(read(&sandbox.path("out/s.exr")) == read(&sandbox.path("own.exr")));
    fs::write(sandbox.path("path.toml"), super::walk::PATH).unwrap();
    let walk = [&["path.toml", "out/f.##.exr", "1-3", "2"], &SMALL[..]].concat();
    let (said, options) = submit(&sandbox, "submit.sh", &walk);
    assert!(options.contains("--array=0-1"), "{options}");
    assert_eq!(said, "chunks: job 1; contact sheet: job 1\n");
    assert!(["out/f.01.exr", "out/f.03.exr", "out/sheet.png"].iter().all(|name| sandbox.path(name).exists()));
}
