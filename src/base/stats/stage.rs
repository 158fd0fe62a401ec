//! Stages of a run, and their times.

use serde::Serialize;
use std::ops::AddAssign;
use std::time::Instant;

/// A stage of the pipeline, in order of execution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Reading, sanitising and recentring the scene.
    Load,
    /// Building the acceleration structure and the tables of materials and lights.
    Build,
    /// Planning settings: trial renders and measurements of their errors.
    Plan,
    /// Eye rays and specular chains, in methods with a separate eye pass.
    EyePass,
    /// Photon paths, which become virtual point lights.
    LightPass,
    /// Clustering the virtual point lights.
    Tree,
    /// Computing cache records.
    Records,
    /// Splatting and adapting records.
    Splat,
    /// Lighting of eye samples by cuts or gathering; all rendering in methods without an eye pass.
    Render,
    /// Denoising the image.
    Denoise,
    /// Path tracing of pixels to measure the image's error.
    Verify,
    /// Encoding and writing the images.
    Write,
    /// The whole run, from the command to the last file.
    Total,
}

impl Stage {
    /// All stages, in order.
    pub const ALL: [Stage; 13] = [
        Stage::Load,
        Stage::Build,
        Stage::Plan,
        Stage::EyePass,
        Stage::LightPass,
        Stage::Tree,
        Stage::Records,
        Stage::Splat,
        Stage::Render,
        Stage::Denoise,
        Stage::Verify,
        Stage::Write,
        Stage::Total,
    ];

    /// Returns the name for messages.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Load => "load",
            Stage::Build => "build",
            Stage::Plan => "plan",
            Stage::EyePass => "eye pass",
            Stage::LightPass => "light pass",
            Stage::Tree => "tree",
            Stage::Records => "records",
            Stage::Splat => "splat",
            Stage::Render => "render",
            Stage::Denoise => "denoise",
            Stage::Verify => "verify",
            Stage::Write => "write",
            Stage::Total => "total",
        }
    }

    /// Returns the name in machine-readable output.
    pub fn key(self) -> &'static str {
        match self {
            Stage::EyePass => "eye_pass",
            Stage::LightPass => "light_pass",
            other => other.name(),
        }
    }
}

/// Time of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StageTime {
    /// Elapsed seconds.
    pub wall_seconds: f64,
    /// Seconds of processor time over all threads of the process.
    pub cpu_seconds: f64,
}

impl StageTime {
    /// Returns the share of the time of `threads` threads in which they worked; 0 if no time passed.
    pub fn busy(self, threads: usize) -> f64 {
        self.cpu_seconds / (threads as f64 * self.wall_seconds).max(1e-9)
    }

    /// Returns the time minus that of `part`.
    pub fn without(self, part: StageTime) -> StageTime {
        StageTime {
            wall_seconds: self.wall_seconds - part.wall_seconds,
            cpu_seconds: self.cpu_seconds - part.cpu_seconds,
        }
    }
}

impl AddAssign for StageTime {
    fn add_assign(&mut self, other: StageTime) {
        self.wall_seconds += other.wall_seconds;
        self.cpu_seconds += other.cpu_seconds;
    }
}

/// A watch of wall-clock and CPU time.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    wall: Instant,
    cpu_seconds: f64,
}

impl Stopwatch {
    /// Starts measuring.
    pub fn start() -> Stopwatch {
        Stopwatch { wall: Instant::now(), cpu_seconds: process_cpu_seconds() }
    }

    /// Returns the time since the start.
    pub fn elapsed(&self) -> StageTime {
        StageTime {
            wall_seconds: self.wall.elapsed().as_secs_f64(),
            cpu_seconds: process_cpu_seconds() - self.cpu_seconds,
        }
    }
}

fn process_cpu_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_lists_the_stages_in_order_with_distinct_keys() {
        assert!(Stage::ALL.windows(2).all(|w| w[0] < w[1] && w[0].key() != w[1].key()));
    }

    #[test]
    fn keys_are_what_serde_writes() {
        for stage in Stage::ALL {
            assert_eq!(serde_json::to_string(&stage).unwrap(), format!("\"{}\"", stage.key()));
        }
    }

    #[test]
    fn work_costs_processor_time() {
        let watch = Stopwatch::start();
        let mut x = 1u64;
        for i in 0..3_000_000u64 {
            x = std::hint::black_box(x.wrapping_mul(6364136223846793005).wrapping_add(i));
        }
        let time = watch.elapsed();
        assert!(time.cpu_seconds > 0.0 && time.wall_seconds > 0.0, "{time:?} {x}");
    }
}
