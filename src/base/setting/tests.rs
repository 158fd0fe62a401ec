use super::{Settings, Spec, Value};

choices! {
    /// Colours.
    pub enum Colour {
        /// Like blood.
        Red = "red",
        /// Like grass.
        Green = "green",
    }
}

settings! {
    /// Settings of a part.
    pub struct Part in "Part" {
        /// Rays of
        /// something.
        ///
        /// More about them.
        probe_rays: u32 = 128 => [.range(1.0, 4096.0)];
        /// Share of it.
        share: f32 = 0.02 => [.fraction().named("part_share")];
        /// No setting.
        seed: u32 = 7;
    }
}

/// A choice of settings.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    lacks: &'static str,
}

impl Preset {
    fn has(self, key: &str) -> bool {
        key != self.lacks
    }
}

settings! {
    /// Settings of the whole.
    pub struct Whole in "" of preset {
        /// Settings that apply.
        preset: Preset = Preset { lacks: "probe_rays" };
        /// The part.
        part: Part = Part { share: 0.5, ..Part::default() } => [group];
        /// Rays of another part.
        rays: u32 = 128 => [.range(1.0, 4096.0)];
        /// Colour of the whole.
        colour: Colour = Colour::Green => [];
        /// Least and largest.
        reach: [[f32; 2]; 2] = [[1.5, 20.0], [1.5, 40.0]] => [.positive()];
        /// Most.
        most: Option<u32> = None => [.at_least(1.0)];
        /// Whether it is fast.
        fast: Option<bool> = None => [];
        /// Bound, 0 for none.
        bound: Option<f32> = Some(0.25) => [.fraction()];
    }
}

/// Returns key, text and number of values of all settings.
fn all(settings: &mut dyn Settings) -> Vec<(&'static str, String, usize)> {
    let mut found = Vec::new();
    settings.each(&mut |spec: &Spec, value: &mut dyn Value| {
        found.push((spec.key, value.text(), value.numbers().len()));
    });
    found
}

#[test]
fn settings_are_visited_with_their_groups_in_order() {
    let whole: Vec<_> = all(&mut Whole::default());
    let expected = [
        ("part_share", "0.5", 1),
        ("rays", "128", 1),
        ("colour", "green", 0),
        ("reach", "1.5,20,1.5,40", 4),
        ("most", "", 0),
        ("fast", "auto", 0),
        ("bound", "0.25", 1),
    ];
    assert_eq!(whole, expected.map(|(key, text, numbers)| (key, text.to_owned(), numbers)));
    assert_eq!(Part::default().seed, 7);
    Part::default().each(&mut |spec, _| {
        if spec.key == "probe_rays" {
            let told = (spec.option(), spec.help(), spec.heading);
            assert_eq!(told, ("probe-rays".to_owned(), "Rays of something".to_owned(), "Part"));
        }
    });
}

#[test]
fn what_is_shown_is_read_back_and_what_makes_no_sense_is_refused() {
    let mut whole = Whole::default();
    for (key, text, _) in all(&mut Whole::default()) {
        assert_eq!(whole.set(key, &text), Ok(true), "{key} {text}");
    }
    assert_eq!(all(&mut whole), all(&mut Whole::default()));
    assert_eq!(whole.set("probe_rays", "9"), Ok(false));
    let wrong = [
        ("part_share", &["", "2", "-0.1", "nan", "inf", "two"][..]),
        ("rays", &["", "0", "4097", "1.5", "-3", "99999999999"]),
        ("colour", &["", "blue", "Red"]),
        ("reach", &["", "1", "2,1", "0,1", "-1,2", "1,2,3", "1,2,4,3", "1,inf", "nan,1", "a,b"]),
        ("most", &["0", "many"]),
        ("fast", &["yes"]),
        ("bound", &["1.5", "1e-4", "-1"]),
    ];
    for (key, texts) in wrong {
        for text in texts {
            assert!(whole.set(key, text).is_err(), "{key} {text}");
        }
    }
    assert_eq!(all(&mut whole), all(&mut Whole::default()));
    for (key, text) in [("rays", " 16 "), ("reach", "2, 3"), ("most", "4"), ("fast", "off"), ("bound", "0")] {
        assert_eq!(whole.set(key, text), Ok(true));
    }
    assert_eq!(whole.reach, [[2.0, 3.0]; 2]);
    assert_eq!((whole.rays, whole.most, whole.fast, whole.bound), (16, Some(4), Some(false), None));
}

#[test]
fn parsed_values_are_set_where_the_type_is_the_same() {
    let mut whole = Whole::default();
    let rays = whole.parse("rays", "16").unwrap().unwrap();
    assert_eq!(format!("{rays:?}"), "16");
    assert!(whole.parse("nothing", "16").unwrap().is_none() && whole.parse("rays", "0").is_err());
    let mut other = Whole::default();
    assert!(other.assign("rays", &rays) && other.rays == 16);
    let before = all(&mut other);
    assert!(
        !other.assign("nothing", &rays) && !other.assign("colour", &rays) && !other.assign("most", &rays)
    );
    assert_eq!(all(&mut other), before);
}

#[test]
fn reports_hold_numbers_as_typed() {
    let mut found = Vec::new();
    Whole::default().each(&mut |_, value| found.push(value.json()));
    let expected = serde_json::json!([0.5, 128, "green", [1.5, 20, 1.5, 40], null, "auto", 0.25]);
    assert_eq!(serde_json::Value::from(found), expected);
}
