//! Memory that methods expect to need.

use crate::kit::small_methods;
use lightsplat::film::Window;

#[test]
fn every_method_reckons_with_pixels_samples_lights_and_photons() {
    let small = Window::whole([100, 100]);
    for (name, method) in small_methods() {
        let expected = |key: &str, value: &str, window: &Window| {
            let mut method = method;
            let known = method.set(key, value).expect("a value");
            known.then(|| method.expected_bytes(window))
        };
        assert!(method.expected_bytes(&Window::whole([32_768, 32_768])) > 60 << 30, "{name}");
        for (key, value) in [("vpls", "1000000000"), ("direct_vpls", "1000000000"), ("photons", "1000000000")]
        {
            assert!(expected(key, value, &small).is_none_or(|bytes| bytes > 100 << 30), "{name} {key}");
        }
        let samples = expected("spp", "1000000", &small).expect("every method has samples");
        let keeps = !["path", "lightcuts", "cache"].contains(&name);
        assert!(samples > 100 << 30 || !keeps, "{name} {samples}");
    }
}
