//! Views: the choice of their method, and options that are refused.

use super::Finished;
use super::views::{NAMES, clear, colour, exr, files, sandbox, views};

/// Returns what a run says of its method; `None` without a denoiser, where nothing is chosen.
fn choice(run: &Finished) -> Option<&str> {
    let mut said = run.stderr.lines().filter(|line| line.starts_with("Method: "));
    let choice = said.next();
    assert!(said.next().is_none(), "{}", run.stderr);
    assert!(choice.is_some() || run.stderr.contains("not denoised"), "{}", run.stderr);
    choice
}

#[test]
fn an_open_method_is_chosen_once_for_the_whole_list_as_for_a_still() {
    let sandbox = sandbox();
    let open = |more: &[&str]| {
        let base = ["views", "path.toml", "cameras.json", "-o", "out", "--resolution", "48x32"];
        sandbox.run(&[&base, more].concat()).expect(0)
    };
    let all = open(&[]);
    let Some(chosen) = choice(&all) else { return eprintln!("skipped: no denoiser") };
    let still = sandbox.run(&["render", "path.toml", "-o", "s.exr", "--resolution", "48x32"]).expect(0);
    let method = |choice: &str| choice.split(' ').nth(1).unwrap().to_owned();
    assert_eq!(method(chosen), method(choice(&still).unwrap()), "{}", all.stderr);
    assert!(exr(&sandbox, NAMES[2]).metadata().text("method") == Some(&method(chosen)));
    let denoised = exr(&sandbox, NAMES[2]).metadata().text("denoised").map(str::to_owned);
    assert!(
        denoised.as_ref().is_some_and(|library| library.starts_with("Open Image Denoise")),
        "{denoised:?}"
    );
    let whole = NAMES.map(|name| colour(&sandbox, name));
    let again = open(&["--resume"]);
    assert!(again.stderr.contains("0 views rendered, 5 existed") && choice(&again) == Some(chosen));
    // A part of the list has the method of the list.
    clear(&sandbox);
    let part = open(&["--only", "3"]);
    assert!(choice(&part) == Some(chosen) && files(&sandbox) == ["test/r_0.exr", "test/r_0.png"]);
    assert!(method(chosen) != "path" || colour(&sandbox, NAMES[2]) == whole[2]);
    assert!(choice(&open(&["--dry-run"])) == Some(chosen));
    for closed in [&["--method", "path", "--spp", "1"][..], &["--spp", "1", "--set", "vpls=100"]] {
        assert!(!open(closed).stderr.contains("Method:"), "{closed:?}");
    }
}

#[test]
fn options_without_effect_are_refused() {
    let sandbox = sandbox();
    for option in ["--look-from=0,0,5", "--look-at=0,0,0", "--fov=40", "--azimuth=3", "--elevation=3"] {
        let stderr = views(&sandbox, &[option]).expect(2).stderr;
        let name = option.split('=').next().unwrap();
        assert!(stderr.contains(name) && stderr.contains("the cameras of cameras.json"), "{stderr}");
        if name != "--fov" {
            let walk = ["walk", "path.toml", "-o", "f.##.exr", "--frames", "1", option];
            assert!(sandbox.run(&walk).expect(2).stderr.contains("the camera path"), "{option}");
        }
    }
    for option in
        ["--set=q-scale=2", "--set=idle-frames=3", "--set=memory-limit=1G", "--set=no-reprojection=on"]
    {
        let walk = ["walk", "path.toml", "-o", "f.##.exr", "--frames", "1", "--method", "path", option];
        assert!(sandbox.run(&walk).expect(2).stderr.contains("has no effect with --method path"), "{option}");
    }
    assert!(files(&sandbox).is_empty());
}
