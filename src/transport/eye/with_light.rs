//! The eye pass of a method: with direct light if it is sampled, and with the light that comes by mirrors and glass.

use super::{EyePass, EyeSettings, LightBySpecularLobes, LightSources};
use crate::caustics::Caustics;
use base::progress::Control;
use base::stats::Contributions;
use world::World;
use world::view::View;

impl<'w> EyePass<'w> {
    /// Traces the eye rays of every pixel in the view's window, and finds the light that comes by mirrors and glass.
    /// Direct light is included if it is ordered.
    pub fn of(
        world: &'w World,
        view: &View,
        settings: EyeSettings,
        direct: Option<LightSources>,
        caustics: Option<&Caustics>,
        control: &Control,
    ) -> EyePass<'w> {
        match direct {
            Some(direct) => {
                let mut pass = EyePass::with_direct_light(world, view, settings, direct, control);
                let luminance = pass.known.luminance();
                pass.contributions.add(Contributions::PHOTONS, pass.chains.by_photons(luminance));
                pass.contributions.rest("eye samples", luminance);
                pass
            }
            None => {
                let mut pass = EyePass::trace(world, view, settings, control);
                let light = LightBySpecularLobes::new(world, view, settings, caustics, control);
                pass.contributions.add("emitters in view", pass.known.luminance());
                light.add_to(&mut pass.known, &mut pass.contributions);
                pass.chains += light.chains;
                pass.nonfinite += light.nonfinite;
                pass
            }
        }
    }
}
