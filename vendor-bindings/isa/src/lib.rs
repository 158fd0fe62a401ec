//! The check of the processor: code compiled for the machine it was built on (`target-cpu=native`) ends by SIGILL on an
//! older one. A function in C, which runs before `main`, ends the program with a sentence and exit code 1 instead.

/// Puts the check into the program that calls this; it has run when this does.
pub fn is_checked() {
    #[cfg(target_arch = "x86_64")]
    {
        unsafe extern "C" {
            fn isa_is_checked();
        }
        // SAFETY: the function takes nothing and does nothing.
        unsafe { isa_is_checked() }
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use std::fs;
    use std::process::Command;

    /// Compiles a program that needs the set, and runs it: exit code and what it says.
    fn run_needing(set: &str) -> (Option<i32>, String) {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("needs.h"), format!("NEEDS(\"{set}\")\n")).unwrap();
        fs::write(path("main.c"), "int main(void) { return 0; }\n").unwrap();
        let check = concat!(env!("CARGO_MANIFEST_DIR"), "/src/check.c");
        let compiled = Command::new("cc")
            .arg("-I")
            .arg(folder.path())
            .args([check.as_ref(), path("main.c").as_os_str(), "-o".as_ref(), path("program").as_os_str()])
            .status();
        assert!(compiled.unwrap().success());
        let output = Command::new(path("program")).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    }

    #[test]
    fn the_check_agrees_with_the_standard_library() {
        macro_rules! agree {
            ($($set:tt)*) => { $(
                let code = Some(i32::from(!std::is_x86_feature_detected!($set)));
                assert_eq!(run_needing($set).0, code, $set);
            )* };
        }
        agree!("sse4.2" "fma" "f16c" "bmi2" "lzcnt" "movbe" "avx2" "avx512f" "avx512vl" "avx512vbmi2" "gfni");
        // No table knows it.
        assert_eq!(run_needing("avx9").0, Some(1));
    }

    #[test]
    fn a_processor_without_the_instruction_set_is_told_in_a_sentence() {
        super::is_checked();
        assert_eq!(run_needing("sse2"), (Some(0), String::new()));
        // AMD's processors of 2011 to 2016 alone have it.
        let set = "xop";
        if fs::read_to_string("/proc/cpuinfo").is_ok_and(|text| text.contains(" xop ")) {
            return;
        }
        let (code, said) = run_needing(set);
        assert_eq!(code, Some(1));
        assert!(said.starts_with("error: this processor lacks xop, ") && said.ends_with("\n"), "{said}");
    }
}
