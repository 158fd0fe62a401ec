//! Damaged files of every kind, and pictures of damaged scenes: errors, never a panic, an endless run or memory without
//! bounds.
//!
//! A case follows from its number. `cargo test --test inputs fuzz` tries some hundreds of each target. Variables of the
//! environment change that (see [`Extent`]): with `FUZZ_CASES=100000` a target tries so many, with `FUZZ_SECONDS=3600`
//! it goes on for so much processor time, from case `FUZZ_FIRST`. It then says how many cases it tried. Files that fail
//! go to `tests/scenes/fuzzed`, whose files are tried in every run. A case that ends the process, for it takes more
//! than [`MAX_BYTES`] or [`MAX_SECONDS`], is left in `target/tmp/fuzz`.

mod additions;
mod damage;
mod mutate;
mod seeds;
mod target;
mod unknown;

use cap::Cap;
use lightsplat::stats::{StageTime, Stopwatch};
use mutate::{Random, mutate};
use seeds::corpus;
use std::alloc::System;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use std::{slice, thread};
use target::{Workplace, render, session_of};

/// Maximum memory of all cases at hand, of which there is one a thread.
const MAX_BYTES: usize = 3 << 30;
/// Maximum time of a case, elapsed and of the processor.
const MAX_SECONDS: f64 = 60.0;
/// Maximum elapsed time of a case, where the machine does other things.
const MAX_ELAPSED_SECONDS: f64 = 600.0;

#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, MAX_BYTES);

/// Message and place of the last panic.
static LAST_PANIC: Mutex<Option<(String, String)>> = Mutex::new(None);

thread_local! {
    /// True while a case is tried on this thread.
    static TRYING: Cell<bool> = const { Cell::new(false) };
}

/// Keeps panics for [`tried`], which tells them; those beside cases are printed.
fn listen() {
    panic::set_hook(Box::new(|info| {
        let place = info.location().map_or("nowhere".to_owned(), |place| {
            let name = Path::new(place.file()).file_stem().unwrap_or_default().to_string_lossy();
            format!("{name}-{}", place.line())
        });
        if !TRYING.get() {
            eprintln!("{info}");
        }
        *LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner) = Some((place, info.to_string()));
    }));
}

/// Reads the case in place, and renders it once for each of `choices`; returns whether it loaded, or where and how it
/// panicked.
fn tried(workplace: &Workplace, extension: &str, choices: &mut [Random]) -> Result<bool, (String, String)> {
    TRYING.set(true);
    let result = catch_unwind(AssertUnwindSafe(|| {
        let loaded = workplace.read(extension, !choices.is_empty());
        let loads = loaded.is_some();
        if let Some(session) = loaded.filter(|_| !choices.is_empty()).and_then(session_of) {
            choices.iter_mut().for_each(|random| render(&session, random));
        }
        loads
    }));
    TRYING.set(false);
    result.map_err(|_| LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default())
}

/// Ends the process if a case takes too long.
fn watch(folder: PathBuf) -> Arc<AtomicU64> {
    let begun = Arc::new(AtomicU64::new(0));
    let shared = Arc::downgrade(&begun);
    thread::spawn(move || {
        let (mut last, mut since) = (0, Stopwatch::start());
        while let Some(begun) = shared.upgrade() {
            let now = begun.load(Ordering::Relaxed);
            if now != last {
                (last, since) = (now, Stopwatch::start());
            }
            let StageTime { wall_seconds, cpu_seconds } = since.elapsed();
            if wall_seconds.min(cpu_seconds) > MAX_SECONDS || wall_seconds > MAX_ELAPSED_SECONDS {
                eprintln!("case {now} takes too long; it is in {}", folder.display());
                std::process::abort();
            }
            drop(begun);
            thread::sleep(Duration::from_millis(500));
        }
    });
    begun
}

fn number(variable: &str) -> Option<u64> {
    std::env::var(variable).ok()?.parse().ok()
}

/// Seconds of the processor that programs run by this one have taken, so far as they ended.
fn children_seconds() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Numbers follow the name in brackets: the fourteenth and fifteenth are theirs, in hundredths.
    let numbers = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(13).take(2);
    numbers.filter_map(|number| number.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// Cases of a run, as the environment asks for them.
struct Extent {
    /// Number of the first case: `FUZZ_FIRST`, or 0.
    first: u64,
    /// Number of cases: `FUZZ_CASES`, or that of a short run.
    count: u64,
    /// Processor seconds in place of a number of cases: `FUZZ_SECONDS`.
    seconds: Option<u64>,
    /// True if the environment asks for a number or a time.
    is_asked_for: bool,
    start: Stopwatch,
}

impl Extent {
    /// Starts a run of `count` cases, or of those that the environment asks for.
    fn start(count: u64) -> Extent {
        let (asked, seconds) = (number("FUZZ_CASES"), number("FUZZ_SECONDS"));
        Extent {
            first: number("FUZZ_FIRST").unwrap_or(0),
            count: asked.unwrap_or(count),
            seconds,
            is_asked_for: asked.is_some() || seconds.is_some(),
            start: Stopwatch::start(),
        }
    }

    /// Returns true if the run has this case.
    fn has(&self, case: u64) -> bool {
        match self.seconds {
            Some(seconds) => self.spent() < seconds as f64,
            None => case < self.first + self.count,
        }
    }

    /// Returns the processor seconds of this program and of those that it ran.
    fn spent(&self) -> f64 {
        self.start.elapsed().cpu_seconds + children_seconds()
    }
}

/// Tries `count` cases of a target, or those that the environment asks for.
fn fuzz(target: &str, count: u64) {
    listen();
    let seeds = seeds::seeds_of(target);
    let extent = Extent::start(count);
    let first = extent.first;
    let name = format!("{target}-{first}");
    let workplace = Workplace::new(Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz").join(&name));
    let begun = watch(workplace.case("*"));
    let mut failed: BTreeMap<String, String> = BTreeMap::new();
    let (mut case, mut loaded) = (first, 0);
    while extent.has(case) {
        begun.store(case + 1, Ordering::Relaxed);
        let mut random = Random::new(case);
        let (seed, other) = (random.pick(&seeds), random.pick(&seeds));
        let path = workplace.case(seed.extension);
        fs::write(&path, seed.pack(mutate(&seed.bytes, &other.bytes, &mut random))).unwrap();
        let choices = if target == "picture" { slice::from_mut(&mut random) } else { &mut [] };
        match tried(&workplace, seed.extension, choices) {
            Ok(loads) => loaded += u64::from(loads),
            Err((place, message)) => {
                failed.entry(place.clone()).or_insert_with(|| {
                    let kept = corpus("fuzzed").join(format!("{target}-{place}.{}", seed.extension));
                    fs::copy(&path, &kept).unwrap();
                    format!("case {case}, kept as {}: {message}", kept.display())
                });
            }
        }
        case += 1;
    }
    if extent.is_asked_for {
        let (count, seconds) = (case - first, extent.spent());
        eprintln!(
            "{target}: {count} cases from {first}, of which {loaded} load, in {seconds:.0} s of the processor"
        );
    }
    let _ = fs::remove_dir_all(workplace.case("").parent().unwrap());
    assert!(failed.is_empty(), "{failed:#?}");
    let is_scene = !matches!(target, "records" | "job" | "views");
    assert!(!is_scene || (loaded > 0 && loaded < case - first), "{loaded} load: the damage is one-sided");
}

macro_rules! targets {
    ($($name:ident $count:literal)+) => {$(
        #[test]
        fn $name() {
            fuzz(stringify!($name), $count);
        }
    )+};
}

targets! {
    toml 500
    xml 500
    obj 500
    mtl 500
    ply 500
    stl 500
    serialized 500
    gltf 500
    exr 500
    pictures 500
    spectrum 500
    records 500
    views 500
    job 30
    picture 100
}

/// Files that failed once, by any method.
#[test]
fn files_that_failed_once_are_errors_or_pictures() {
    listen();
    let workplace = Workplace::new(Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz/kept"));
    let begun = watch(workplace.case("*"));
    for file in fs::read_dir(corpus("fuzzed")).unwrap() {
        let path = file.unwrap().path();
        let Some(extension) = path.extension().map(|e| e.to_string_lossy().into_owned()) else { continue };
        fs::copy(&path, workplace.case(&extension)).unwrap();
        begun.fetch_add(1, Ordering::Relaxed);
        let mut choices: Vec<Random> = (0..8).map(Random::new).collect();
        let outcome = tried(&workplace, &extension, &mut choices);
        assert!(outcome.is_ok(), "{}: {outcome:?}", path.display());
    }
}
