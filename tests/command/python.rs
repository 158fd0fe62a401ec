//! Packages, and the Python module: arguments, messages, interrupts. `make package-test` tries images of an installed
//! wheel.

use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn packages_have_the_version_of_the_program() {
    for file in ["pyproject.toml", "packaging/launcher/Cargo.toml", "packaging/launcher/Cargo.lock"] {
        let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap();
        let line = concat!("\nversion = \"", env!("CARGO_PKG_VERSION"), "\"\n");
        assert!(text.contains(line), "{file}");
    }
}

#[test]
fn the_python_module_runs_the_program() {
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("python");
    let mut tests = Command::new("python3");
    tests.args(["-B", "-m", "unittest", "discover", "-s"]).arg(python.join("tests"));
    tests.env("PYTHONPATH", &python).env("LIGHTSPLAT_PROGRAM", env!("CARGO_BIN_EXE_lightsplat"));
    // Neither the build nor the program needs Python.
    let Ok(output) = tests.output() else { return eprintln!("skipped: there is no python3") };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("OK") && !said.contains("skipped"), "{said}");
}
