//! Memory used by the process, and memory left on the machine.

/// Peak resident set size of this process, in bytes; `None` where the system does not report it.
pub fn peak_resident_bytes() -> Option<u64> {
    field(&std::fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Memory available without swapping, in bytes; `None` where the system does not report it.
pub fn available_bytes() -> Option<u64> {
    field(&std::fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// Parses a line such as `VmHWM:   1024 kB`, in bytes.
fn field(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kibibytes.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn the_peak_covers_what_was_touched() {
        let block = std::hint::black_box(vec![1u8; 64 << 20]);
        assert!(peak_resident_bytes().unwrap() >= block.len() as u64);
    }

    #[test]
    fn fields_are_found_by_name_and_anything_else_is_unknown() {
        let text = "MemTotal:  9 kB\nMemAvailable:   12 kB\nSwapFree: 7\n";
        assert_eq!(field(text, "MemAvailable:"), Some(12 * 1024));
        assert_eq!((field(text, "SwapFree:"), field(text, "Cached:")), (None, None));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn something_is_available() {
        assert!(available_bytes().unwrap() > 0);
    }
}
