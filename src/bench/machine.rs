//! The machine and the program: facts that figures depend on. Every report states them.

use embree::{Device, Width, tbb_version};
use std::fs;
use std::thread::available_parallelism;
use time::UtcDateTime;

/// Named facts.
pub type Facts = Vec<(String, String)>;

/// Levels of x86-64, and whether the program was compiled for features that came with them.
const LEVELS: [(&str, bool); 3] = [
    ("x86-64-v2", cfg!(target_feature = "sse4.2")),
    ("x86-64-v3", cfg!(target_feature = "avx2") && cfg!(target_feature = "fma")),
    ("x86-64-v4", cfg!(target_feature = "avx512bw") && cfg!(target_feature = "avx512vl")),
];

/// Returns the commit that the program was built from, if it was built in a git checkout.
pub fn commit() -> Option<&'static str> {
    option_env!("LIGHTSPLAT_COMMIT").filter(|commit| !commit.is_empty())
}

/// Returns the version and the commit.
pub fn version() -> String {
    let commit = commit().map_or(String::new(), |commit| format!(" ({commit})"));
    format!("{}{commit}", env!("CARGO_PKG_VERSION"))
}

/// Returns what the program was compiled for: the largest level of x86-64 whose features the compiler might use.
pub fn compiled_for() -> String {
    let level = LEVELS.iter().take_while(|(_, is_on)| *is_on).last();
    match level {
        Some((level, _)) if cfg!(target_arch = "x86_64") => (*level).to_owned(),
        None if cfg!(target_arch = "x86_64") => "x86-64, any processor, which is slow".to_owned(),
        _ => std::env::consts::ARCH.to_owned(),
    }
}

/// Returns the versions of Embree and TBB with Embree's instruction set, or the reason why Embree cannot be used.
pub fn embree() -> String {
    let device = match Device::new(1) {
        Ok(device) => device,
        Err(error) => return error.to_string(),
    };
    let isa = match device.widest_packets() {
        Width::Sixteen => "AVX-512",
        Width::Eight => "AVX or AVX2",
        _ => "SSE",
    };
    let lanes = device.widest_packets().rays();
    let tasks = tbb_version().map_or("no TBB".to_owned(), |version| format!("TBB {version}"));
    format!("{} with {isa} (packets of {lanes} rays), {tasks}", device.version())
}

/// Returns the facts at this moment, for a measurement on some threads. Call it before the measurement, whose own load
/// would count otherwise.
pub fn facts(threads: usize) -> Facts {
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let processors = available_parallelism().map_or(1, |n| n.get());
    let facts = [
        ("version", version()),
        ("compiler", option_env!("LIGHTSPLAT_RUSTC").unwrap_or("unknown").to_owned()),
        ("compiled for", compiled_for()),
        ("Embree", embree()),
        ("processor", processor(&read("/proc/cpuinfo")).unwrap_or("unknown").to_owned()),
        ("threads", format!("{threads} on {processors} processors")),
        ("load at the start", load(&read("/proc/loadavg")).unwrap_or("unknown".to_owned())),
        ("date", UtcDateTime::now().date().to_string()),
    ];
    facts.map(|(name, value)| (name.to_owned(), value)).into()
}

/// Returns the name of the processor's model from the text of `/proc/cpuinfo`.
fn processor(cpuinfo: &str) -> Option<&str> {
    let (_, model) = cpuinfo
        .lines()
        .filter_map(|line| line.split_once(':'))
        .find(|(key, _)| key.trim() == "model name")?;
    Some(model.trim()).filter(|model| !model.is_empty())
}

/// Returns the mean number of runnable threads over the last minute from the text of `/proc/loadavg`.
fn load(loadavg: &str) -> Option<String> {
    let minute: f64 = loadavg.split_whitespace().next()?.parse().ok()?;
    Some(format!("{minute:.2} runnable threads"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_and_its_load_are_read_from_the_kernels_texts() {
        let cpuinfo =
            "processor\t: 0\nmodel\t\t: 1\nmodel name\t: EPYC: 9 B14 \nflags\t: fpu\n\nprocessor\t: 1\n";
        assert_eq!(processor(cpuinfo), Some("EPYC: 9 B14"));
        assert_eq!([processor(""), processor("model name\t:\n")], [None; 2]);
        assert_eq!(load("0.256 1.02 2.00 3/410 2211\n").unwrap(), "0.26 runnable threads");
        assert_eq!([load(""), load("much\n")], [None, None]);
    }

    #[test]
    fn every_fact_has_a_value() {
        let facts = facts(3);
        assert!(facts.iter().all(|(name, value)| !name.is_empty() && !value.is_empty()), "{facts:?}");
        let value = |wanted: &str| &facts.iter().find(|(name, _)| name == wanted).unwrap().1;
        assert!(value("threads").starts_with("3 on "), "{facts:?}");
        assert!(value("compiler").starts_with("rustc 1."), "{facts:?}");
        assert!(value("version").starts_with(env!("CARGO_PKG_VERSION")), "{facts:?}");
    }
}
