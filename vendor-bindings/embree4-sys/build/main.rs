//! Finds Embree 4, links it and passes its folder on as `DEP_EMBREE4_LIBDIR`.
//!
//! With feature `generate` the bindings are first written anew. Only Linux is supported: the product is built
//! and tested nowhere else.

#[cfg(feature = "generate")]
mod generate;
mod locate;

use locate::Library;
use std::path::{Path, PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build");
    #[cfg(feature = "generate")]
    if let Err(message) = generate::write_bindings() {
        println!("cargo::error={message}");
        return;
    }
    match locate::embree().and_then(|library| link(&library)) {
        Ok(()) => {}
        Err(message) => println!("cargo::error={message}"),
    }
}

/// Emits the cargo directives by which this package's tests and the packages above link and load `library`.
fn link(library: &Library) -> Result<(), String> {
    // Verbatim, for the redistributable's file name contains a hash: lib<name>.so would not find it.
    println!("cargo::rustc-link-lib=dylib:+verbatim={}", library.file_name);
    println!("cargo::rustc-link-search=native={}", library.directory.display());
    if library.loader_knows {
        return Ok(());
    }
    println!("cargo::rustc-link-arg=-Wl,-rpath,{}", library.directory.display());
    println!("cargo::metadata=libdir={}", library.directory.display());
    // Documentation tests take no rpath from build scripts, but cargo puts search folders below its
    // target folder into their LD_LIBRARY_PATH.
    let beside = PathBuf::from(std::env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: run by cargo")?);
    link_shared_objects(&library.directory, &beside).map_err(|e| {
        format!("cannot link the libraries of {} into {}: {e}", library.directory.display(), beside.display())
    })?;
    println!("cargo::rustc-link-search=native={}", beside.display());
    Ok(())
}

/// Creates symbolic links in `to` to each shared object of `from`: Embree's own and the TBB it loads.
fn link_shared_objects(from: &Path, to: &Path) -> std::io::Result<()> {
    for entry in std::fs::read_dir(from)? {
        let path = entry?.path();
        let Some(name) = path.file_name().and_then(|n| n.to_str()) else { continue };
        if !(name.starts_with("libembree4") || name.starts_with("libtbb")) || !name.contains(".so") {
            continue;
        }
        let link = to.join(name);
        match std::fs::remove_file(&link) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(e),
            _ => std::os::unix::fs::symlink(&path, &link)?,
        }
    }
    Ok(())
}
