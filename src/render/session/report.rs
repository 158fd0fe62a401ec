//! Reports of a plan and of the measured error, for statistics, metadata and users.

use super::frame::Remark;
use super::notes::Notes;
use crate::method::Method;
use crate::plan::MethodChoice;
use crate::verify::{Estimate, Verified, VerifySettings};
use base::film::Metadata;
use base::stats::Stats;
use serde_json::{Value, json};
use transport::paths::Estimand;

/// Returns remarks about a plan for a time, of whose `planned` seconds `before` have passed.
pub(super) fn of_time(asked: f64, [before, planned]: [f64; 2], in_reach: bool, options: &str) -> Vec<Remark> {
    let mut remarks = Vec::new();
    if !in_reach {
        let rest = planned - before;
        remarks.push(Remark::Warning(format!(
            "{asked} s are too short: reading the scene and planning took {before:.2} s, and the image with the cheapest \
             settings is expected to take {rest:.2} s more"
        )));
    }
    remarks.push(Remark::Note(format!("planned for {asked} s on this machine, this time: {options}")));
    remarks
}

/// Returns remarks about a plan for an error. `missed` is the measured error if it does not meet the goal.
pub(super) fn of_error(asked: f64, options: &str, missed: Option<Estimate>) -> Vec<Remark> {
    let asked = 100.0 * asked;
    let mut remarks = vec![Remark::Note(format!("planned for an error of {asked} %: {options}"))];
    if let Some(rms) = missed {
        let [value, low, high] = [rms.value, rms.low, rms.high].map(|x| 100.0 * x);
        remarks.push(Remark::Warning(format!(
            "the error may be above {asked} %: {value:.2} % ({low:.2} to {high:.2}); more pixels (--verify) or \
             paths (--set verify-samples) narrow the interval"
        )));
    }
    remarks
}

/// Returns a remark about the cache, whose error of `missed` did not meet the goal.
pub(super) fn of_missed(missed: f64) -> Remark {
    Remark::Note(format!("the cache reached an error of {:.2} %, so path tracing was tried", 100.0 * missed))
}

/// Maximum width of an informative interval, over the RMS error or 1 %.
const WIDE: f64 = 2.0;

/// Returns remarks on the measured error: the figures, and a warning if their intervals are too wide.
pub(super) fn of_measured(found: &Verified) -> Vec<Remark> {
    let text = |estimate: Estimate| {
        // Rounded, and without the sign of zero.
        let percent = |x: f64| (1e4 * x).round() / 1e2 + 0.0;
        let [value, low, high] = [estimate.value, estimate.low, estimate.high].map(percent);
        format!("{value:.2} % ({low:.2} to {high:.2})")
    };
    let Verified { relative_rms, relative_bias, relative_error_95, pixels, .. } = *found;
    let hidden = if found.error_95_resolved { "" } else { " (hidden by the noise of the paths)" };
    let mut remarks = vec![Remark::Note(format!(
        "error, measured by path tracing {pixels} pixels: RMS {}, bias {}, 95th percentile {}{hidden}; brackets are \
         95 % confidence intervals",
        text(relative_rms),
        text(relative_bias),
        text(relative_error_95)
    ))];
    let most = WIDE * relative_rms.value.max(0.01);
    let is_wide = |estimate: Estimate| {
        let width = estimate.high - estimate.low;
        width.is_nan() || width > most
    };
    if is_wide(relative_rms) || is_wide(relative_bias) {
        let capped = 2 * found.pixels_at_cap > pixels;
        let more = if capped {
            "more pixels (--verify) and paths (--set verify-samples)"
        } else {
            "more pixels (--verify)"
        };
        remarks.push(Remark::Warning(format!(
            "{pixels} pixels are too few to measure the error: an interval is more than twice as wide as the error; {more} \
             narrow the interval"
        )));
    }
    remarks
}

/// Share of the light seldom found by paths above which a measurement by paths comes with a warning.
const MAX_SELDOM: f64 = 0.01;

/// Adds a choice between methods to a plan, statistics and remarks.
///
/// `spp` are the final samples per pixel. `is_measured` is true if the error is measured by paths.
pub(super) fn add_choice(
    choice: &MethodChoice,
    spp: u32,
    is_measured: bool,
    plan: &mut Value,
    notes: &mut Notes,
) {
    let Notes { stats, remarks } = notes;
    let MethodChoice { paths_a_sample, rays_ratio, ahead, pilot_rays, seldom, .. } = *choice;
    remarks.push(Remark::Note(choice.text_with(spp)));
    if is_measured && seldom > MAX_SELDOM {
        remarks.push(Remark::Warning(format!(
            "path tracing, which measures the error, seldom finds {:.0} % of the light (small emitters seen through glass \
             or mirrors): the error does not include this light",
            100.0 * seldom
        )));
    }
    stats.count("Plan/paths chosen (1: yes)", u64::from(matches!(choice.method, Method::Path(_))));
    stats.add("Plan/paths worth a sample of cache", paths_a_sample);
    stats.add("Plan/rays of a path over those of a sample", rays_ratio);
    stats.add("Plan/work of the other method", ahead);
    stats.count("Plan/rays of the pilot", pilot_rays);
    stats.add("Plan/light that paths seldom find [%]", 100.0 * seldom);
    if plan.is_null() {
        *plan = json!({});
    }
    plan["chosen"] = choice.method.name().into();
    plan["paths_a_sample"] = paths_a_sample.into();
    plan["rays_ratio"] = rays_ratio.into();
    plan["other_work"] = ahead.into();
    plan["pilot_rays"] = pilot_rays.into();
    plan["seldom_found_by_paths"] = seldom.into();
}

/// Stores a plan in metadata. `seconds` have passed since the start of the run.
pub(super) fn store_plan(plan: &Value, seconds: f64, metadata: &mut Metadata) {
    for (key, value) in plan.as_object().into_iter().flatten() {
        let name = format!("plan_{key}");
        match value {
            Value::Number(number) => metadata.set(&name, number.as_f64().unwrap_or(f64::NAN)),
            Value::Bool(yes) => metadata.set(&name, if *yes { "true" } else { "false" }),
            Value::String(text) => metadata.set(&name, text.as_str()),
            Value::Object(estimate) => {
                metadata.set(&name, estimate.get("value").and_then(Value::as_f64).unwrap_or(f64::NAN));
            }
            _ => {}
        }
    }
    if plan.get("asked_seconds").is_some() {
        metadata.set("plan_got_seconds_before_writing", seconds);
    }
}

/// Stores the measured error in statistics and metadata.
pub(super) fn store_error(
    found: &Verified,
    settings: &VerifySettings,
    stats: &mut Stats,
    metadata: &mut Metadata,
) {
    let errors = [
        ("relative bias", "bias", found.relative_bias),
        ("relative RMS", "rms", found.relative_rms),
        ("relative error, 95 % of pixels", "error_95", found.relative_error_95),
    ];
    for (name, key, estimate) in errors {
        stats.add(&format!("Verify/{name} [%]"), 100.0 * estimate.value);
        stats.add(&format!("Verify/{name}, from"), 100.0 * estimate.low);
        stats.add(&format!("Verify/{name}, to"), 100.0 * estimate.high);
        metadata.set(&format!("verified_{key}"), estimate.value);
        metadata.set(&format!("verified_{key}_low"), estimate.low);
        metadata.set(&format!("verified_{key}_high"), estimate.high);
    }
    stats.add("Verify/noise of the paths [%]", 100.0 * found.noise);
    stats.count("Verify/pixels", found.pixels as u64);
    stats.count("Verify/pixels at the cap", found.pixels_at_cap as u64);
    stats.count("Verify/paths", found.paths);
    stats.count("Verify/95 % hidden by noise (1: yes)", u64::from(!found.error_95_resolved));
    metadata.set("verified_against", against(settings.estimand));
    metadata.set("verified_error_95_resolved", if found.error_95_resolved { "true" } else { "false" });
    metadata.set("verified_noise", found.noise);
    metadata.set("verified_pixels", found.pixels as f64);
    metadata.set("verified_pixels_at_cap", found.pixels_at_cap as f64);
}

/// Returns the measured error for programs.
pub(super) fn error_facts(found: &Verified, settings: &VerifySettings) -> Value {
    let mut facts = json!(found);
    facts["against"] = against(settings.estimand).into();
    facts["most_samples"] = settings.max_samples.into();
    facts
}

fn against(estimand: Estimand) -> &'static str {
    match estimand {
        Estimand::Pixels => "pixels",
        Estimand::EyeSamples { .. } => "eye-samples",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_intervals_come_with_a_warning() {
        let estimate = |value: f64, width: f64| Estimate { value, low: value - width, high: value + width };
        let found = |bias: Estimate| Verified {
            relative_bias: bias,
            relative_rms: estimate(0.03, 0.01),
            relative_error_95: estimate(0.06, 0.02),
            error_95_resolved: true,
            noise: 0.01,
            pixels: 50,
            pixels_at_cap: 0,
            paths: 5000,
            nonfinite: 0,
        };
        let [Remark::Note(text)] = &of_measured(&found(estimate(-0.001, 0.01)))[..] else { panic!() };
        assert!(
            text.contains("50 pixels: RMS 3.00 % (2.00 to 4.00), bias -0.10 % (-1.10 to 0.90)"),
            "{text}"
        );
        for wide in [estimate(0.0, 7.64), estimate(0.0, f64::NAN), estimate(f64::INFINITY, 0.0)] {
            let [_, Remark::Warning(text)] = &of_measured(&found(wide))[..] else { panic!("{wide:?}") };
            assert!(text.contains("more pixels (--verify) narrow"), "{text}");
        }
    }
}
