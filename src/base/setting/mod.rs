//! Settings, each declared once. [`settings!`] declares a struct whose fields carry name, text, range, default and the
//! levels of a benchmark. [`choices!`] declares an enum that can be the type of a setting.
//!
//! [`Settings::each`] visits all settings of a struct. Command-line options and their help, reports in statistics and
//! files, benchmarks, and the page `docs/cli.md` derive from it.

mod shared;
mod spec;
mod value;

pub use shared::{COMPENSATION, INSPECT, PAPER, PATCHES, PHOTON_ENDS, SHARE};
pub use spec::{DOWN, JudgedBy, Levels, Spec, UP};
pub use value::{Assign, Choice, Parsed, Value};

/// Visitor of settings.
pub type Each<'a> = &'a mut (dyn FnMut(&'static Spec, &mut dyn Value) + 'a);

/// A struct of settings, or a setting of its own.
pub trait Settings {
    /// Visits all settings in the order of the fields, with the settings of a group in its place.
    fn each(&mut self, each: Each);

    /// Sets the setting of this key from text; returns its value, or `None` if there is no such setting.
    ///
    /// # Errors
    /// A description of the values expected. Nothing is set then.
    fn parse(&mut self, key: &str, text: &str) -> Result<Option<Parsed>, String> {
        let mut result = Ok(None);
        self.each(&mut |spec, value| {
            if spec.key == key {
                result = spec.set(value, text).map(|()| Some(value.parsed()));
            }
        });
        result
    }

    /// Sets the setting of this key from text; returns false if there is no such setting.
    ///
    /// # Errors
    /// A description of the values expected. Nothing is set then.
    fn set(&mut self, key: &str, text: &str) -> Result<bool, String> {
        self.parse(key, text).map(|value| value.is_some())
    }

    /// Sets the setting of this key to a parsed value; returns false if there is no such setting, or of another type.
    fn assign(&mut self, key: &str, parsed: &Parsed) -> bool {
        let mut assigned = false;
        self.each(&mut |spec, value| {
            if spec.key == key {
                assigned = value.assign(parsed);
            }
        });
        assigned
    }
}

/// Declares a struct of settings, with its `Default` and [`Settings`]:
///
/// ```text
/// settings! {
///     /// Settings of something.
///     pub struct SomeSettings in "Heading in --help" {
///         /// A setting; its first paragraph is its text in --help.
///         probe_rays: u32 = 128 => [.range(1.0, 4096.0).scaled(&UP)];
///         /// A group of settings.
///         cut: CutSettings = CutSettings::default() => [group];
///         /// A setting shared with other structs.
///         share: bool = true => [is SHARE];
///         /// A field that is no setting.
///         only: Option<Origin> = None;
///     }
/// }
/// ```
///
/// `in "Heading" of preset` visits those settings alone whose key the field `preset` has, by its function `has`.
#[macro_export]
macro_rules! settings {
    (
        $(#[doc = $about:literal])+
        pub struct $Name:ident $(in $heading:literal $(of $preset:ident)?)? {
            $($(#[doc = $doc:literal])+ $field:ident: $Type:ty = $default:expr $(=> [$($how:tt)*])?;)*
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug)]
        pub struct $Name {
            $($(#[doc = $doc])+ pub $field: $Type,)*
        }

        impl Default for $Name {
            fn default() -> $Name {
                $Name { $($field: $default,)* }
            }
        }

        impl $crate::setting::Settings for $Name {
            fn each(&mut self, each: $crate::setting::Each) {
                #[allow(dead_code)]
                const HEADING: &str = concat!("" $(, $heading)?);
                $($(
                    let preset = self.$preset;
                    let each: $crate::setting::Each = &mut |spec, value| {
                        if preset.has(spec.key) {
                            each(spec, value)
                        }
                    };
                )?)?
                $($crate::setting::visit!(self each HEADING $field [$($doc)+] $([$($how)*])?);)*
            }
        }
    };
}

/// Visits a field for [`settings!`].
#[macro_export]
macro_rules! visit {
    ($s:ident $each:ident $heading:ident $field:ident $doc:tt) => {};
    ($s:ident $each:ident $heading:ident $field:ident $doc:tt [group]) => {
        $crate::setting::Settings::each(&mut $s.$field, $each)
    };
    ($s:ident $each:ident $heading:ident $field:ident $doc:tt [is $SPEC:path]) => {
        $each(&$SPEC, &mut $s.$field)
    };
    ($s:ident $each:ident $heading:ident $field:ident $doc:tt [$($build:tt)*]) => {{
        static SPEC: $crate::setting::Spec = $crate::setting::visit!(@spec $heading $field $doc) $($build)*;
        $each(&SPEC, &mut $s.$field)
    }};
    (@spec $heading:ident $field:ident [$($doc:literal)+]) => {
        $crate::setting::Spec::new(stringify!($field), concat!($($doc, "\n"),+), $heading)
    };
}

/// Declares an enum that is the type of a setting: every variant with its text and its name on the command line.
///
/// The default of all settings of the type, if there is one, follows the enum's name.
#[macro_export]
macro_rules! choices {
    (
        $(#[doc = $about:literal])+
        pub enum $Name:ident $(= $Default:ident)? {
            $($(#[doc = $doc:literal])+ $Variant:ident = $name:literal,)+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $Name {
            $($(#[doc = $doc])+ $Variant,)+
        }

        $(impl Default for $Name {
            fn default() -> $Name {
                $Name::$Default
            }
        })?

        impl $crate::setting::Value for $Name {
            fn text(&self) -> String {
                match self { $($Name::$Variant => $name,)+ }.to_owned()
            }

            fn parse(&mut self, text: &str) -> Result<(), String> {
                *self = match text {
                    $($name => $Name::$Variant,)+
                    _ => return Err(concat!("expected one of" $(, " ", $name)+).to_owned()),
                };
                Ok(())
            }

            fn choices(&self) -> &'static [$crate::setting::Choice] {
                const CHOICES: &[$crate::setting::Choice] =
                    &[$($crate::setting::Choice { name: $name, doc: concat!($($doc, "\n"),+) }),+];
                CHOICES
            }
        }
    };
}

pub use {choices, settings, visit};

#[cfg(test)]
mod tests;
