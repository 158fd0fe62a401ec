//! The text of `--version`: the program, what it was compiled for, and the libraries that it finds.

use bench::machine;
use render::denoise::Denoiser;

/// Returns the lines after the program's name.
pub fn text() -> String {
    let denoiser = match Denoiser::load() {
        Ok(denoiser) => denoiser.name(),
        Err(error) => format!("none: {error}"),
    };
    format!(
        "{}\ncompiled for: {}\nEmbree:       {}\ndenoiser:     {denoiser}",
        machine::version(),
        machine::compiled_for(),
        machine::embree(),
    )
}

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
