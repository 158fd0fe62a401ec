//! Memory that the process uses, and memory available to it.

use std::path::Path;

/// Returns memory to the system that threads of the current pool have freed but keep for later.
pub fn give_back() {
    rayon::broadcast(|_| allocator::give_back());
}

/// Returns the peak resident set size of this process in bytes; `None` if the system does not report it.
pub fn peak_resident_bytes() -> Option<u64> {
    field(&std::fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Returns the memory available to this process without swapping, in bytes.
///
/// This is the machine's available memory, limited by control groups (as of containers) and by the address space.
/// `None` if the system reports none of these.
pub fn available_bytes() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let machine = read("/proc/meminfo").and_then(|text| field(&text, "MemAvailable:"));
    let groups =
        read("/proc/self/cgroup").and_then(|text| left_to_groups(&text, Path::new("/sys/fs/cgroup")));
    let space = read("/proc/self/limits").and_then(|text| address_space(&text)).map(|limit| {
        limit.saturating_sub(read("/proc/self/status").and_then(|text| field(&text, "VmSize:")).unwrap_or(0))
    });
    [machine, groups, space].into_iter().flatten().min()
}

/// Returns the soft limit of the address space in `/proc/self/limits`; `None` if unlimited.
fn address_space(limits: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Returns the minimum of the memory left to the groups of `/proc/self/cgroup` (version 1 or 2) and their parents under
/// `mount`.
///
/// Returns `None` without limits. A container may see its own group at the mount only.
fn left_to_groups(groups: &str, mount: &Path) -> Option<u64> {
    let mut left = None;
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(group)) = (parts.next(), parts.next()) else { continue };
        let (mount, names) = match controllers {
            "" => (mount.to_owned(), ["memory.max", "memory.current"]),
            _ if controllers.split(',').any(|name| name == "memory") => {
                (mount.join("memory"), ["memory.limit_in_bytes", "memory.usage_in_bytes"])
            }
            _ => continue,
        };
        for group in Path::new(group.trim_start_matches('/')).ancestors() {
            left = left.into_iter().chain(left_to_group(&mount.join(group), names)).min();
        }
    }
    left
}

/// Returns the limit of a group minus its use. Inactive file caches do not count as use.
fn left_to_group(folder: &Path, [limit, used]: [&str; 2]) -> Option<u64> {
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
    let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
    let cached = read("memory.stat").and_then(|text| {
        // Version 1 reports the caches of child groups separately.
        let line = |name| text.lines().find_map(|line| line.strip_prefix(name));
        line("total_inactive_file ").or_else(|| line("inactive_file "))?.trim().parse::<u64>().ok()
    });
    let used = number(used)?.saturating_sub(cached.unwrap_or(0));
    Some(number(limit)?.saturating_sub(used))
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

    #[test]
    fn limits_of_groups_and_of_those_above_count_whatever_their_version() {
        let mount = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = mount.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        write("jobs/one/memory.max", "max\n");
        write("jobs/one/memory.current", "1000\n");
        write("jobs/memory.max", "5000\n");
        write("jobs/memory.current", "3000\n");
        write("jobs/memory.stat", "anon 9\ninactive_file 500\n");
        write("memory/box/memory.limit_in_bytes", "4000\n");
        write("memory/box/memory.usage_in_bytes", "3000\n");
        let left = |groups: &str| left_to_groups(groups, mount.path());
        assert_eq!(left("0::/jobs/one\n"), Some(2500));
        assert_eq!(left("0::/\n5:cpu:/box\n4:memory:/box\n"), Some(1000));
        assert_eq!(left("0::/jobs\n4:cpu,memory:/box\n"), Some(1000));
        assert_eq!(left("0::/elsewhere\nnonsense\n"), None);
    }

    #[test]
    fn limits_of_the_address_space_are_read() {
        let limits = |soft: &str| {
            format!("Limit  Soft Limit  Hard Limit  Units\nMax address space {soft} unlimited bytes\n")
        };
        assert_eq!(address_space(&limits("4096")), Some(4096));
        assert_eq!(address_space(&limits("unlimited")), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn something_is_available() {
        assert!(available_bytes().unwrap() > 0);
    }
}
