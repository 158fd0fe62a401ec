//! Signals at random moments of runs of every kind: they end with 75, or 0 where they came too late, and leave whole
//! files.
//!
//! `LIGHTSPLAT_INTERRUPTS=100 cargo test --release --test command random_interrupts -- --nocapture` tries so many, and
//! says after how much processor time, and by the clock, the runs ended.

use super::Sandbox;
use lightsplat::film::ExrFile;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");

/// Arguments of runs of some seconds, most of which is spent in different stages. Tests take the first two, which are
/// the shortest.
const RUNS: [&str; 14] = [
    "render SCENES/knot.toml -o a.exr --resolution 2048x1024 --method path --spp 1",
    "render SCENES/cornell.toml -o a.exr --resolution 96x96 --verify 2000",
    "render SCENES/hall.toml -o a.exr --resolution 64x64",
    "render SCENES/apartment.toml -o a.exr --resolution 96x64 --spp 64",
    "render SCENES/kitchen.toml -o a.exr --resolution 96x64 --set direct=records",
    "render SCENES/knot.toml -o a.exr --resolution 128x128 --method reconstruction",
    "render SCENES/nave.toml -o a.exr --resolution 64x64 --method lightcuts",
    "render SCENES/kitchen.toml -o a.exr --resolution 64x64 --method photon-cache",
    "render SCENES/cornell.toml -o a.exr --resolution 96x96 --time 3s",
    "walk SCENES/apartment.toml -o a.##.exr --resolution 64x64 --frames 1-3",
    "render SCENES/cornell.toml -o a.exr --resolution 96x96 --set vpls=4000000",
    "render SCENES/cornell.toml -o a.exr --resolution 96x96 --method photon-cache --set photons=4000000",
    "render SCENES/knot.toml -o a.exr --resolution 1500x1500 --method reconstruction --spp 2",
    "render sheets.toml -o a.exr --resolution 48x48",
];

/// Three hundred sheets that let nearly all light pass.
fn sheets() -> String {
    let mut text = "environment = { radiance = 1 }\ncamera = { origin = [0, 0, 10], target = [0, 0, 0] }\n\
        material = [{ name = 'wall', kind = 'diffuse', reflectance = 0.5 }, \
        { name = 'sheet', kind = 'diffuse', reflectance = 0.5, opacity = 0.02 }]\n\
        [[mesh]]\nshape = 'cube'\nmaterial = 'wall'\ntransform = [{ translate = [0, 0, -4] }]\n"
        .to_owned();
    for i in 0..300 {
        let z = 0.01 * f64::from(i);
        text += &format!(
            "[[mesh]]\nshape = 'rectangle'\nmaterial = 'sheet'\n\
             transform = [{{ scale = 4 }}, {{ translate = [0, 0, {z}] }}]\n"
        );
    }
    text
}

/// Processor seconds that a process has used, and whether it has ended.
fn spent(child: &Child) -> (f64, bool) {
    let text = std::fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap();
    let fields: Vec<&str> = text.rsplit_once(')').unwrap().1.split_whitespace().collect();
    // Fields 14 and 15 of proc(5), in hundredths of a second; the state is the third.
    let ticks = |field: usize| fields[field - 3].parse::<f64>().unwrap();
    ((ticks(14) + ticks(15)) * 0.01, fields[0] == "Z")
}

/// Waits until a process has used so much time, or has ended; returns the time used.
pub(super) fn wait_for(child: &Child, seconds: f64) -> (f64, bool) {
    loop {
        let (used, ended) = spent(child);
        if ended || used >= seconds {
            return (used, ended);
        }
        thread::sleep(Duration::from_millis(2));
    }
}

fn start(sandbox: &Sandbox, run: &str) -> Child {
    let line = run.replace("SCENES", SCENES) + " --threads 2 --progress none";
    let arguments: Vec<&str> = line.split(' ').collect();
    let mut command = sandbox.command(&arguments);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Sends a signal once a run has used so many processor seconds; returns those until it ended, and the clock's.
fn interrupt(sandbox: &Sandbox, run: &str, after: f64) -> [f64; 2] {
    let mut child = start(sandbox, run);
    let (before, ended) = wait_for(&child, after);
    let signalled = Instant::now();
    if !ended {
        let id = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    }
    let (all, _) = wait_for(&child, f64::INFINITY);
    let elapsed = signalled.elapsed().as_secs_f64();
    let code = child.wait().unwrap().code();
    // Before its handlers are there, a signal ends the process.
    assert!(matches!(code, Some(0 | 75)) || after < 0.2 && code.is_none(), "{run} after {after} s: {code:?}");
    for name in sandbox.files().iter().filter(|name| name.ends_with(".exr")) {
        assert!(ExrFile::read(&sandbox.path(name)).unwrap().color().is_ok(), "{run} after {after} s: {name}");
        std::fs::remove_file(sandbox.path(name)).unwrap();
    }
    [all - before, elapsed]
}

/// A share from 0 to 1 of a trial: of the golden ratio, which spreads them evenly.
fn share(trial: u32) -> f64 {
    (0.5 + 0.618_033_988_749_895 * f64::from(trial)).fract()
}

#[test]
fn runs_end_wherever_they_are_interrupted() {
    let wanted = std::env::var("LIGHTSPLAT_INTERRUPTS").ok().map(|number| number.parse().unwrap());
    let trials: u32 = wanted.unwrap_or(2);
    let sandbox = Sandbox::new();
    std::fs::write(sandbox.path("sheets.toml"), sheets()).unwrap();
    let mut worst = (0.0, String::new());
    for (index, run) in RUNS.iter().enumerate() {
        // Without the environment's word a few, each of another run.
        let own = (0..trials).filter(|trial| *trial as usize % RUNS.len() == index);
        let own: Vec<u32> = own.collect();
        if own.is_empty() {
            continue;
        }
        let mut child = start(&sandbox, run);
        let (whole, _) = wait_for(&child, f64::INFINITY);
        assert_eq!(child.wait().unwrap().code(), Some(0), "{run}");
        for trial in own {
            let after = whole * share(trial);
            let [seconds, elapsed] = interrupt(&sandbox, run, after);
            let told = format!(
                "{run} after {after:.2} of {whole:.2} s: {seconds:.2} s, {elapsed:.2} s by the clock"
            );
            if wanted.is_some() {
                eprintln!("{told}");
            }
            if seconds > worst.0 {
                worst = (seconds, told);
            }
        }
    }
    eprintln!("{trials} runs interrupted, at most {:.2} processor seconds to the end: {}", worst.0, worst.1);
}
