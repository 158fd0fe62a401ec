//! Options of what an image shows while it is rendered.

use super::plan_args::parse_time;
use clap::Args;
use std::path::PathBuf;

/// Address at which tev listens unless it is told another.
const TEV: &str = "127.0.0.1:14158";

/// Options of what an image shows while it is rendered.
#[derive(Clone, Debug, Default, Args)]
pub struct LiveArgs {
    /// Write what is rendered so far to a PNG file, at intervals. Exposure and view equal the final PNG file. SIGUSR1
    /// writes a preview at once
    #[arg(long, value_name = "FILE.png")]
    pub preview: Option<PathBuf>,
    /// Interval between previews, like 10s or 2m. Previews never take more than 1 % of the processors' time [default:
    /// 10s]
    #[arg(long, value_name = "TIME", value_parser = parse_time, requires = "preview")]
    pub every: Option<f64>,
    /// Send what is rendered so far to the viewer tev. An absent or slow viewer does not delay the render [default
    /// address: 127.0.0.1:14158]
    #[arg(
        long,
        value_name = "HOST:PORT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = TEV,
        value_parser = parse_address
    )]
    pub tev: Option<String>,
}

/// Parses an address of host and port.
fn parse_address(text: &str) -> Result<String, String> {
    match text.rsplit_once(':') {
        Some((host, port)) if !host.is_empty() && port.parse::<u16>().is_ok_and(|port| port > 0) => {
            Ok(text.to_owned())
        }
        _ => Err("expected host and port like 127.0.0.1:14158".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_a_host_and_a_port() {
        for good in [TEV, "desk.example.org:1", "[::1]:14158"] {
            assert_eq!(parse_address(good), Ok(good.to_owned()));
        }
        for bad in ["", "14158", ":14158", "desk:", "desk:0", "desk:70000", "desk:x", "scene.toml"] {
            assert!(parse_address(bad).is_err(), "{bad}");
        }
    }
}
