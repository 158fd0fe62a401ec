//! Search for Embree 4, in this order: `EMBREE_DIR`, pkg-config, the system's library folders, and the
//! redistributable that `make setup` unpacks into `.embree/`.
//!
//! The library's file does not tell its version (Debian's is `libembree4.so.4`), so the check at run time,
//! when the device is created, is authoritative. Libraries of the system whose headers say that they are too
//! old are skipped, so that `make setup` helps there too.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A shared library of Embree 4.
pub struct Library {
    /// Absolute path of its folder.
    pub directory: PathBuf,
    /// File name of the library there.
    pub file_name: String,
    /// True if the dynamic loader searches that folder by default.
    pub loader_knows: bool,
}

/// Finds Embree, or returns the remedy in one line.
pub fn embree() -> Result<Library, String> {
    for name in ["EMBREE_DIR", "PKG_CONFIG_PATH", "LIBRARY_PATH"] {
        println!("cargo::rerun-if-env-changed={name}");
    }
    if let Some(dir) = env::var_os("EMBREE_DIR").filter(|d| !d.is_empty()) {
        let dir = PathBuf::from(dir);
        return below(&dir).ok_or_else(|| {
            format!(
                "EMBREE_DIR={} holds no libembree4.so: correct it, or unset it and run `make setup`",
                dir.display()
            )
        });
    }
    from_pkg_config().or_else(from_system).or_else(from_repository).ok_or_else(|| {
        "no Embree 4 found: run `make setup` in the repository (or install libembree-dev >= 4.3, \
         or set EMBREE_DIR)"
            .to_owned()
    })
}

/// Finds the library in `dir` or in the usual folders below it.
fn below(dir: &Path) -> Option<Library> {
    let multiarch = format!("lib/{}", multiarch());
    ["", "lib", "lib64", &multiarch].iter().find_map(|sub| library_in(&dir.join(sub)))
}

/// Finds the library in exactly this folder: the development link if there, else the versioned file.
fn library_in(directory: &Path) -> Option<Library> {
    let directory = directory.canonicalize().ok()?;
    let mut names: Vec<String> = std::fs::read_dir(&directory)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.starts_with("libembree4") && (name.ends_with(".so") || name.contains(".so.4")))
        .collect();
    names.sort_unstable(); // so that the plain `libembree4.so` precedes `libembree4.so.4`
    let file_name = names.into_iter().next()?;
    // A file added or removed changes the result.
    println!("cargo::rerun-if-changed={}", directory.join(&file_name).display());
    Some(Library { directory, file_name, loader_knows: false })
}

fn from_pkg_config() -> Option<Library> {
    ["embree4", "embree"].iter().find_map(|package| {
        let range = [format!("{package} >= 4.3"), format!("{package} < 5")];
        let output = Command::new("pkg-config").args(["--variable=libdir"]).arg(package).output().ok()?;
        let fits = Command::new("pkg-config").arg("--exists").args(&range).status().ok()?.success();
        let directory = String::from_utf8(output.stdout).ok()?;
        if !fits || directory.trim().is_empty() {
            return None;
        }
        mark_system(library_in(Path::new(directory.trim()))?)
    })
}

fn from_system() -> Option<Library> {
    let from_variable = env::var_os("LIBRARY_PATH").unwrap_or_default();
    env::split_paths(&from_variable)
        .filter(|dir| !dir.as_os_str().is_empty())
        .chain(system_folders())
        .filter(|dir| !headers_are_too_old(dir))
        .find_map(|dir| mark_system(library_in(&dir)?))
}

/// True if the headers installed with the libraries of `dir` are of 4.0 to 4.2.
fn headers_are_too_old(dir: &Path) -> bool {
    dir.ancestors()
        .filter_map(|prefix| std::fs::read_to_string(prefix.join("include/embree4/rtcore_config.h")).ok())
        .flat_map(|header| {
            header.lines().filter_map(|l| l.strip_prefix("#define RTC_VERSION ")?.trim().parse().ok()).next()
        })
        .next()
        .is_some_and(|version: u32| version < 40300)
}

fn from_repository() -> Option<Library> {
    // The folder at run time: checkouts that share a target folder share this program.
    let dir = Path::new(&env::var_os("CARGO_MANIFEST_DIR")?).join("../../.embree");
    if let Ok(root) = dir.join("..").canonicalize() {
        println!("cargo::rerun-if-changed={}", root.join(".embree").display());
    }
    library_in(&dir)
}

fn mark_system(mut library: Library) -> Option<Library> {
    let canonical = |dir: PathBuf| dir.canonicalize().ok();
    library.loader_knows = system_folders().filter_map(canonical).any(|dir| dir == library.directory);
    Some(library)
}

/// Returns the folders that both linker and loader search by default.
fn system_folders() -> impl Iterator<Item = PathBuf> {
    let multiarch = multiarch();
    [format!("/usr/lib/{multiarch}"), format!("/usr/local/lib/{multiarch}")]
        .into_iter()
        .chain(["/usr/lib64", "/usr/lib", "/usr/local/lib64", "/usr/local/lib"].map(String::from))
        .map(PathBuf::from)
}

/// Returns Debian's name for the target, as in `/usr/lib/x86_64-linux-gnu`.
fn multiarch() -> String {
    format!("{}-linux-gnu", env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_else(|_| "x86_64".into()))
}
