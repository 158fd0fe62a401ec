//! The option `--method`, and an option for every setting of the methods.

use super::exit::Failure;
use anyhow::anyhow;
use base::setting::{Choice, Parsed, Spec};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use render::method::Method;
use std::sync::OnceLock;

/// Name for a method that lightsplat chooses.
const AUTO: &str = "auto";

/// Description of [`AUTO`] for `--help`.
const ABOUT_AUTO: &str =
    "Cache or denoised path tracing: a test of a few pixels finds which needs less work for the same quality";

/// Settings that do not rule out a method.
const OF_ANY_METHOD: [&str; 2] = ["seed", "max_depth"];

/// The method and the settings on the command line.
#[derive(Clone, Debug)]
pub struct MethodArgs {
    name: String,
    /// Keys and values of the settings.
    typed: Vec<(&'static str, Parsed)>,
}

impl MethodArgs {
    /// Returns the method with the given settings and its defaults.
    ///
    /// # Errors
    /// If a setting is invalid, or the method does not have it.
    pub fn method(&self) -> Result<Method, Failure> {
        let usage = |text: String| Failure::usage(anyhow!(text));
        let mut method = match &*self.name {
            AUTO => Method::default(),
            name => Method::named(name).ok_or_else(|| usage(format!("there is no method {name}")))?,
        };
        for (key, value) in &self.typed {
            if !method.assign(key, value) {
                let setting = settings().into_iter().find(|setting| setting.spec.key == *key);
                let of = setting.as_ref().map_or(String::new(), |setting| setting.methods().join(", "));
                let option = setting.map_or(String::new(), |setting| setting.spec.words(""));
                let (option, name) = (option.trim_end_matches(['=', ' ']), method.name());
                return Err(usage(format!(
                    "{option} is a setting of --method {of}; --method {name} has no such setting"
                )));
            }
        }
        method.check().map_err(usage)?;
        Ok(method)
    }

    /// Returns true if lightsplat may choose the method: `auto` without settings of the cache.
    pub fn is_open(&self) -> bool {
        self.name == AUTO && self.typed.iter().all(|(key, _)| OF_ANY_METHOD.contains(key))
    }

    /// Returns the keys of the settings on the command line. Plans do not change them.
    pub fn pinned(&self) -> Vec<&'static str> {
        self.typed.iter().map(|(key, _)| *key).collect()
    }
}

impl Args for MethodArgs {
    fn augment_args(command: Command) -> Command {
        let names = Method::all().map(|method| PossibleValue::new(method.name()).help(method.about()));
        let names = [PossibleValue::new(AUTO).help(ABOUT_AUTO)].into_iter().chain(names);
        let method = Arg::new("method").long("method").help("Rendering method").help_heading(None::<&str>);
        let method = method.value_parser(PossibleValuesParser::new(names)).value_name("METHOD");
        command.arg(method.default_value(AUTO)).args(settings().iter().map(MethodSetting::arg))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for MethodArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<MethodArgs, clap::Error> {
        let name = matches.get_one::<String>("method").cloned().unwrap_or_default();
        let keys = settings().into_iter().map(|setting| setting.spec.key);
        let typed = keys.filter_map(|key| Some((key, matches.get_one::<Parsed>(key)?.clone()))).collect();
        Ok(MethodArgs { name, typed })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// A setting with the methods that have it.
struct MethodSetting {
    spec: &'static Spec,
    choices: &'static [Choice],
    /// Methods with their defaults of the setting.
    defaults: Vec<(Method, String)>,
}

/// Returns the settings of all methods in the order of the methods.
fn settings() -> Vec<MethodSetting> {
    let mut all: Vec<MethodSetting> = Vec::new();
    for method in Method::all() {
        method.visit(&mut |spec, value| {
            let default = (method, value.text());
            match all.iter_mut().find(|setting| setting.spec.key == spec.key) {
                Some(setting) => setting.defaults.push(default),
                None => all.push(MethodSetting { spec, choices: value.choices(), defaults: vec![default] }),
            }
        });
    }
    all
}

/// Returns true if an argument is a setting of the paper or of tuning.
pub fn is_tuning(id: &str) -> bool {
    static TUNING: OnceLock<Vec<&str>> = OnceLock::new();
    let find = || settings().iter().filter(|s| s.spec.is_tuning()).map(|s| s.spec.key).collect();
    TUNING.get_or_init(find).contains(&id)
}

/// Returns the range of a setting's numbers, if it has one.
pub fn range(id: &str) -> Option<String> {
    settings().iter().find(|setting| setting.spec.key == id)?.spec.range_text()
}

impl MethodSetting {
    /// Returns the names of the methods that have the setting.
    fn methods(&self) -> Vec<&'static str> {
        self.defaults.iter().map(|(method, _)| method.name()).collect()
    }

    /// Returns the default. If it differs between methods, each value has its methods behind it; the value of most of
    /// them comes last.
    fn default(&self) -> String {
        let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
        for (method, text) in &self.defaults {
            match groups.iter_mut().find(|(known, _)| known == text) {
                Some((_, methods)) => methods.push(method.name()),
                None => groups.push((text, vec![method.name()])),
            }
        }
        if let [(only, _)] = groups[..] {
            return only.to_owned();
        }
        groups.sort_by_key(|(_, methods)| methods.len());
        let count = groups.len();
        let of = |(i, (text, methods)): (usize, &(&str, Vec<&str>))| match methods.len() > 1 && i + 1 == count
        {
            true => format!("{text} (others)"),
            false => format!("{text} ({})", methods.join(", ")),
        };
        groups.iter().enumerate().map(of).collect::<Vec<_>>().join(", ")
    }

    /// Builds the option.
    fn arg(&self) -> Arg {
        let MethodSetting { spec, defaults, .. } = self;
        let mut help = spec.help();
        let others: Vec<_> =
            Method::all().map(|method| method.name()).filter(|n| !self.methods().contains(n)).collect();
        if others.len() >= defaults.len() {
            help += &format!(" [for {}]", self.methods().join(", "));
        } else if !others.is_empty() {
            help += &format!(" [not for {}]", others.join(", "));
        }
        let default = self.default();
        if !default.is_empty() && !spec.flag {
            help += &format!(" [default: {default}]");
        }
        let arg = Arg::new(spec.key).long(spec.option()).help(help);
        let arg = if spec.key == "spp" { arg.short('s').visible_alias("samples") } else { arg };
        let arg = arg.help_heading(Some(spec.heading).filter(|heading| !heading.is_empty()));
        if spec.flag {
            let arg = arg.action(ArgAction::Set).num_args(0).default_missing_value("on");
            return arg.value_parser(self.parser());
        }
        let arg = match spec.placeholder {
            Some(placeholder) => arg.value_name(placeholder),
            None => arg.value_name(spec.key.to_uppercase()),
        };
        arg.value_parser(self.parser())
    }

    /// Builds the parser of the values, which sets them in the first method that has the setting.
    fn parser(&self) -> ValueParser {
        let (key, method) = (self.spec.key, self.defaults.first().map(|(method, _)| *method));
        let parse = move |text: &str| {
            let parsed = method.map_or(Ok(None), |mut method| method.parse(key, text))?;
            parsed.ok_or_else(|| format!("no method has the setting {key}"))
        };
        if self.choices.is_empty() {
            return parse.into();
        }
        let value = |choice: &Choice| PossibleValue::new(choice.name).help(choice.help());
        let names = PossibleValuesParser::new(self.choices.iter().map(value));
        names.try_map(move |text: String| parse(&text)).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_of_methods_that_differ_are_all_told() {
        let all = settings();
        let told = |key: &str| all.iter().find(|setting| setting.spec.key == key).unwrap().default();
        assert_eq!(
            (told("spp"), told("least_cell")),
            ("16 (cache), 64 (path), 4 (others)".to_owned(), "256 (cache), 32 (photon-cache)".to_owned())
        );
    }

    fn args(name: &str, typed: &[(&str, &str)]) -> Result<MethodArgs, String> {
        let options = typed.iter().map(|(key, text)| format!("--{}={text}", key.replace('_', "-")));
        let words = ["lightsplat".to_owned(), format!("--method={name}")].into_iter().chain(options);
        let matches = MethodArgs::augment_args(Command::new("lightsplat")).try_get_matches_from(words);
        let matches = matches.map_err(|error| error.to_string())?;
        MethodArgs::from_arg_matches(&matches).map_err(|error| error.to_string())
    }

    fn method(name: &str, typed: &[(&str, &str)]) -> Result<Method, String> {
        args(name, typed)?.method().map_err(|failure| failure.to_string())
    }

    #[test]
    fn settings_of_other_methods_are_refused_and_whose_they_are_is_said() {
        let error = method("path", &[("probe_rays", "64")]).unwrap_err();
        assert!(error.contains("--set probe-rays is a setting of --method cache, photon-cache;"), "{error}");
        assert!(error.contains("--method path has no such setting"), "{error}");
        for (key, value) in [("vpls", "1"), ("clamp", "1"), ("compensation", "on"), ("indirect", "cuts")] {
            let error = method("photon-cache", &[(key, value)]).unwrap_err();
            assert!(error.contains("--method photon-cache has no such setting"), "{key}: {error}");
        }
        let by_cuts = method("cache", &[("direct", "cuts"), ("indirect", "cuts")]).unwrap_err();
        assert!(by_cuts.contains("--method reconstruction"), "{by_cuts}");
        let cache = method("cache", &[("max_cut", "7"), ("clamp", "0")]).unwrap();
        let Method::Vpl(settings) = cache else { panic!("{cache:?}") };
        assert_eq!((settings.cut.max_cut, settings.cut.clamp), (7, None));
        let typed = [("max_cut", "7"), ("seed", "3"), ("spp", "2")];
        assert_eq!(args("auto", &typed).unwrap().pinned(), ["spp", "seed", "max_cut"]);
    }
}
