//! Elements of Mitsuba XML and their attributes.

/// Returns true if elements of the tag have the attribute.
pub(super) fn has_attribute(tag: &str, name: &str) -> bool {
    let names: &[&str] = match tag {
        "scene" => &["version", "type", "id", "name"],
        "default" => &["name", "value"],
        "alias" => &["id", "as"],
        "include" => &["filename", "name"],
        "ref" => &["id", "name"],
        "path" => &["value"],
        "point" | "vector" => &["name", "value", "x", "y", "z"],
        "translate" | "scale" => &["value", "x", "y", "z"],
        "rotate" => &["value", "x", "y", "z", "angle"],
        "lookat" | "lookAt" => &["origin", "target", "up"],
        "matrix" => &["value"],
        "transform" => &["name"],
        "spectrum" => &["name", "value", "filename", "type", "id", "intent"],
        "blackbody" => &["name", "temperature", "scale"],
        tag if is_object(tag) => &["type", "id", "name"],
        // Intents of 0.6 matter to spectral renderings alone.
        _ => &["name", "value", "intent"],
    };
    names.contains(&name)
}

/// Returns true if elements of the tag are objects.
pub(super) fn is_object(tag: &str) -> bool {
    const TAGS: [&str; 14] = [
        "scene",
        "bsdf",
        "emitter",
        "film",
        "integrator",
        "medium",
        "phase",
        "rfilter",
        "sensor",
        "sampler",
        "shape",
        "texture",
        "volume",
        "subsurface",
    ];
    TAGS.contains(&tag)
}

/// Converts `intIOR` to `int_ior` and `toWorld` to `to_world`. Names of 3.x stay unchanged.
pub(super) fn snake_case(name: &str) -> String {
    let mut out = String::with_capacity(name.len() + 2);
    let mut previous_lower = false;
    for c in name.chars() {
        if previous_lower && c.is_ascii_uppercase() {
            out.push('_');
        }
        previous_lower = c.is_ascii_lowercase();
        // Parameter names have no capital at the start.
        out.push(c.to_ascii_lowercase());
    }
    out
}
