//! `render --verify`: the measured error in the statistics and in the file, for every method.

use super::Sandbox;
use lightsplat::film::ExrFile;

#[test]
fn the_measured_error_is_in_statistics_and_metadata() {
    let sandbox = Sandbox::new();
    for (method, against) in
        [("path", "pixels"), ("reconstruction", "eye-samples"), ("lightcuts", "eye-samples")]
    {
        let options = [
            "--method",
            method,
            "--verify",
            "50",
            "--set",
            "verify-samples=256",
            "--stats",
            "json",
            "--no-png",
        ];
        let run = sandbox.render("a.exr", &options).expect(0);
        let place = |text: &str| run.stderr.find(text).unwrap_or_else(|| panic!("{}", run.stderr));
        assert!(place("wrote a.exr") < place("error, measured by path tracing"));
        let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        let found = &report["run"]["verified"];
        assert_eq!((found["against"].as_str(), found["most_samples"].as_u64()), (Some(against), Some(256)));
        let file = ExrFile::read(&sandbox.path("a.exr")).unwrap();
        for (long, short) in
            [("relative_bias", "bias"), ("relative_rms", "rms"), ("relative_error_95", "error_95")]
        {
            let [value, low, high] = ["value", "low", "high"].map(|key| found[long][key].as_f64().unwrap());
            assert!(low <= value && value <= high && high.abs() < 1.0, "{method} {found}");
            let stored = file.metadata().number(&format!("verified_{short}")).unwrap();
            assert!((stored - value).abs() < 1e-6, "{stored} {value}");
            assert!(file.metadata().number(&format!("verified_{short}_high")).is_some());
        }
        assert_eq!(file.metadata().text("verified_against"), Some(against));
        assert!(report["times"]["verify"]["cpu_seconds"].as_f64().unwrap() > 0.0);
        assert!(report["counters"]["Verify"]["pixels"].as_u64().unwrap() >= 40);
    }
    let text = sandbox.render("a.exr", &["--verify", "16", "--stats", "text"]).expect(0).stdout;
    assert!(text.contains("relative RMS [%]") && text.contains("relative bias, from"), "{text}");
    let plain = sandbox.render("a.exr", &["--stats", "json"]).expect(0).stdout;
    assert!(serde_json::from_str::<serde_json::Value>(&plain).unwrap()["run"]["verified"].is_null());
}

#[test]
fn verifying_options_need_verify_and_sensible_numbers() {
    let sandbox = Sandbox::new();
    for wrong in [
        &["--verify", "3"][..],
        &["--set", "verify-samples=256"],
        &["--set", "verify-against=pixels"],
        &["--verify", "50", "--set", "verify-against=hope"],
    ] {
        sandbox.render("a.exr", wrong).expect(2);
    }
    let options =
        ["--method", "reconstruction", "--verify", "20", "--set", "verify-against=pixels", "--stats", "json"];
    let run = sandbox.render("a.exr", &options).expect(0);
    assert!(run.stdout.contains("\"against\":\"pixels\""), "{}", run.stdout);
}
