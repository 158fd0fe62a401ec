//! Choice of the variant by the features of the processor.

/// A feature of processors, and whether this one has it. Detection asks the operating system, too, whether it saves
/// the registers.
pub type Feature = (&'static str, bool);

/// Features of x86-64-v3 beyond those of older processors, and of x86-64-v4.
pub struct Features {
    v3: Vec<Feature>,
    v4: Vec<Feature>,
}

/// Names of both instruction sets.
const V3: &str = "x86-64-v3";
const V4: &str = "x86-64-v4";

macro_rules! detected {
    ($($name:tt)*) => { vec![$(($name, std::is_x86_feature_detected!($name))),*] };
}

/// Returns the features of the processor.
pub fn features() -> Features {
    Features {
        v3: detected!("sse3" "ssse3" "sse4.1" "sse4.2" "popcnt" "avx" "avx2" "bmi1" "bmi2" "f16c" "fma" "lzcnt" "movbe"),
        v4: detected!("avx512f" "avx512bw" "avx512cd" "avx512dq" "avx512vl"),
    }
}

/// Returns the instruction set of the variant that suits the processor. `limit` is the largest set that may be used.
///
/// # Errors
/// If the processor has not the features of x86-64-v3, or the limit is unknown.
pub fn choose(features: &Features, limit: Option<&str>) -> Result<&'static str, String> {
    let has_all = |set: &[Feature]| set.iter().all(|(_, is_there)| *is_there);
    let may_be_v4 = match limit {
        None | Some("" | V4) => true,
        Some(V3) => false,
        Some(other) => {
            return Err(format!("LIGHTSPLAT_ISA={other} is unknown; set {V3} or {V4}, or unset it"));
        }
    };
    if let Some((lacking, _)) = features.v3.iter().find(|(_, is_there)| !is_there) {
        return Err(format!(
            "this processor lacks {lacking}; this package needs {V3} (Intel since 2013, AMD since 2015). \
             Compile lightsplat on this machine instead"
        ));
    }
    Ok(if may_be_v4 && has_all(&features.v4) { V4 } else { V3 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(v3: bool, v4: bool) -> Features {
        Features { v3: vec![("avx", true), ("avx2", v3)], v4: vec![("avx512f", v4), ("avx512vl", v4)] }
    }

    #[test]
    fn the_largest_instruction_set_within_the_limit_is_chosen() {
        assert_eq!(choose(&of(true, true), None), Ok(V4));
        assert_eq!(choose(&of(true, true), Some("")), Ok(V4));
        assert_eq!(choose(&of(true, true), Some(V3)), Ok(V3));
        assert_eq!(choose(&of(true, false), None), Ok(V3));
        assert_eq!(choose(&of(true, false), Some(V4)), Ok(V3));
        let some = Features { v4: vec![("avx512f", true), ("avx512vl", false)], ..of(true, false) };
        assert_eq!(choose(&some, None), Ok(V3));
    }

    #[test]
    fn lesser_processors_and_unknown_limits_are_errors() {
        for v4 in [false, true] {
            let error = choose(&of(false, v4), None).unwrap_err();
            assert!(error.starts_with("this processor lacks avx2;") && error.contains("Compile"), "{error}");
        }
        assert!(choose(&of(true, true), Some("v5")).unwrap_err().contains("x86-64-v4"));
    }
}
