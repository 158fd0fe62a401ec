//! The text of `--version`: the program, what it was compiled for, and the libraries that it finds.

use embree::{Device, Width, tbb_version};
use render::denoise::Denoiser;

/// Returns the lines after the program's name.
pub fn text() -> String {
    let commit = option_env!("LIGHTSPLAT_COMMIT").filter(|commit| !commit.is_empty());
    let commit = commit.map_or(String::new(), |commit| format!(" ({commit})"));
    let embree = match Device::new(1) {
        Ok(device) => {
            let isa = match device.widest_packets() {
                Width::Sixteen => "AVX-512",
                Width::Eight => "AVX or AVX2",
                _ => "SSE",
            };
            let lanes = device.widest_packets().rays();
            let tasks = tbb_version().map_or("no TBB".to_owned(), |version| format!("TBB {version}"));
            format!("{} with {isa} (packets of {lanes} rays), {tasks}", device.version())
        }
        Err(error) => error.to_string(),
    };
    let denoiser = match Denoiser::load() {
        Ok(denoiser) => denoiser.name(),
        Err(error) => format!("none: {error}"),
    };
    format!(
        "{}{commit}\ncompiled for: {}\nEmbree:       {embree}\ndenoiser:     {denoiser}",
        env!("CARGO_PKG_VERSION"),
        compiled_for(),
    )
}

/// Returns what the program was compiled for: the largest level of x86-64 whose features the compiler might use.
fn compiled_for() -> String {
    let level = LEVELS.iter().take_while(|(_, features)| features.iter().all(|is_on| *is_on)).last();
    match level {
        Some((level, _)) if cfg!(target_arch = "x86_64") => (*level).to_owned(),
        None if cfg!(target_arch = "x86_64") => "x86-64, any processor, which is slow".to_owned(),
        _ => std::env::consts::ARCH.to_owned(),
    }
}

/// Levels of x86-64, and whether the program was compiled for their features.
const LEVELS: [(&str, &[bool]); 3] = [
    ("x86-64-v2", &[cfg!(target_feature = "sse4.2"), cfg!(target_feature = "popcnt")]),
    (
        "x86-64-v3",
        &[
            cfg!(target_feature = "avx2"),
            cfg!(target_feature = "bmi1"),
            cfg!(target_feature = "bmi2"),
            cfg!(target_feature = "f16c"),
            cfg!(target_feature = "fma"),
            cfg!(target_feature = "lzcnt"),
            cfg!(target_feature = "movbe"),
        ],
    ),
    (
        "x86-64-v4",
        &[
            cfg!(target_feature = "avx512f"),
            cfg!(target_feature = "avx512bw"),
            cfg!(target_feature = "avx512cd"),
            cfg!(target_feature = "avx512dq"),
            cfg!(target_feature = "avx512vl"),
        ],
    ),
];

#[cfg(test)]
mod tests {
    #[test]
    fn the_version_names_the_libraries() {
        let text = super::text();
        assert!(text.starts_with(env!("CARGO_PKG_VERSION")), "{text}");
        assert!(text.contains("\ncompiled for: ") && text.contains("TBB"), "{text}");
        assert!(text.contains("Embree:       4.") && text.contains("denoiser: "), "{text}");
    }
}
