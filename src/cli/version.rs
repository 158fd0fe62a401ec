//! The text of `--version`: the program, what it was compiled for, and the libraries that it finds.

use embree::{Device, Width};
use render::denoise::Denoiser;

/// Returns the lines after the program's name.
pub fn text() -> String {
    let commit = option_env!("LIGHTSPLAT_COMMIT").filter(|commit| !commit.is_empty());
    let commit = commit.map_or(String::new(), |commit| format!(" ({commit})"));
    let features: Vec<&str> = FEATURES.iter().filter(|(_, is_on)| *is_on).map(|(name, _)| *name).collect();
    let features =
        if features.is_empty() { "none of avx2, fma, avx512f".to_owned() } else { features.join(", ") };
    let embree = match Device::new(1) {
        Ok(device) => {
            let lanes = match device.widest_packets() {
                Width::Sixteen => 16,
                Width::Eight => 8,
                _ => 4,
            };
            format!("{}, native packets of {lanes} rays", device.version())
        }
        Err(error) => error.to_string(),
    };
    let denoiser = match Denoiser::load() {
        Ok(denoiser) => denoiser.name(),
        Err(error) => format!("none: {error}"),
    };
    format!(
        "{}{commit}\ncompiled for: {} with {features}\nEmbree:       {embree}\ndenoiser:     {denoiser}",
        env!("CARGO_PKG_VERSION"),
        std::env::consts::ARCH,
    )
}

/// Instruction sets that matter for speed, and whether the program was compiled for them.
const FEATURES: [(&str, bool); 4] = [
    ("avx2", cfg!(target_feature = "avx2")),
    ("fma", cfg!(target_feature = "fma")),
    ("avx512f", cfg!(target_feature = "avx512f")),
    ("avx512vl", cfg!(target_feature = "avx512vl")),
];

#[cfg(test)]
mod tests {
    #[test]
    fn the_version_names_the_libraries() {
        let text = super::text();
        assert!(text.starts_with(env!("CARGO_PKG_VERSION")), "{text}");
        assert!(text.contains("Embree:       4.") && text.contains("denoiser: "), "{text}");
    }
}
