//! Conversion of emitters of shapes and of the scene.

use super::converter::Converter;
use super::sensor::field_of_view;
use super::tree::Object;
use crate::check;
use crate::error::SceneError;
use crate::plan::EnvironmentPlan;
use base::math::{Rgb, unit};
use glam::{DMat3, DMat4, DVec3, Vec3};
use scene::{DeltaLight, Emission, Projector, Reflectance, SpotImage, TextureId};
use std::f32::consts::PI;

impl Converter<'_> {
    /// Converts a shape's emitter to its emission.
    pub(super) fn area_emitter(&mut self, emitter: &Object) -> Result<Option<Emission>, SceneError> {
        if emitter.plugin != "area" {
            let what = format!("a shape cannot emit as \"{}\"", emitter.plugin);
            self.log.warn(&emitter.place, what, "the shape does not emit")?;
            return Ok(None);
        }
        let textured = self.document.named(emitter, "radiance")?;
        let emission = match textured {
            Some(texture) => match self.texture(&texture, 0)? {
                Reflectance::Constant(radiance) => Emission { radiance, texture: None, two_sided: false },
                Reflectance::Textured { texture, scale } => {
                    Emission { radiance: scale, texture: Some(texture), two_sided: false }
                }
            },
            None => {
                let radiance = self.emissive_colour(emitter, "radiance")?.unwrap_or(Rgb::ONE);
                Emission { radiance, texture: None, two_sided: false }
            }
        };
        emitter.report_unused(self.log)?;
        Ok(Some(emission))
    }

    pub(super) fn scene_emitter(&mut self, emitter: &Object) -> Result<(), SceneError> {
        let to_world = self.axes(emitter)?;
        match emitter.plugin.as_str() {
            "point" => {
                let intensity = self.emissive_colour(emitter, "intensity")?.unwrap_or(Rgb::ONE);
                let at = to_world.unwrap_or(DMat4::IDENTITY).transform_point3(DVec3::ZERO);
                let position = emitter.vector("position")?.unwrap_or(at);
                self.contents.lights.push((DeltaLight::Point { position: Vec3::ZERO, intensity }, position));
            }
            "spot" => self.spot(emitter, to_world.unwrap_or(DMat4::IDENTITY))?,
            "projector" => self.projector(emitter, to_world.unwrap_or(DMat4::IDENTITY))?,
            "directional" => {
                let irradiance = self.emissive_colour(emitter, "irradiance")?.unwrap_or(Rgb::ONE);
                let along = to_world.unwrap_or(DMat4::IDENTITY).transform_vector3(DVec3::Z);
                let direction = emitter.vector("direction")?.unwrap_or(along);
                let direction = check::unit(direction, &emitter.place)?;
                self.contents.lights.push((DeltaLight::Directional { direction, irradiance }, DVec3::ZERO));
            }
            "constant" => {
                let radiance = self.emissive_colour(emitter, "radiance")?.unwrap_or(Rgb::ONE);
                self.environment(emitter, EnvironmentPlan::Constant(radiance))?;
            }
            "envmap" => {
                let path = self.file(emitter, "filename")?;
                let scale = emitter.float("scale")?.unwrap_or(1.0) as f32;
                let to_world = self.rotation(emitter, to_world.unwrap_or(DMat4::IDENTITY))?;
                let place = emitter.place.clone();
                self.environment(emitter, EnvironmentPlan::Map { place, path, scale, to_world })?;
            }
            "sky" | "sun" | "sunsky" => self.sky(emitter, to_world.unwrap_or(DMat4::IDENTITY))?,
            other => {
                let what = format!("the emitter \"{other}\" is not supported");
                self.log.warn(&emitter.place, what, "it gives no light")?;
                return Ok(());
            }
        }
        emitter.report_unused(self.log)
    }

    fn spot(&mut self, emitter: &Object, to_world: DMat4) -> Result<(), SceneError> {
        let mut intensity = self.emissive_colour(emitter, "intensity")?.unwrap_or(Rgb::ONE);
        let outer = emitter.positive("cutoff_angle", 20.0)?;
        let inner = emitter.float("beam_width")?.unwrap_or(0.75 * outer);
        let names = ["beam_width", "cutoff_angle"];
        let [inner_angle, outer_angle] = check::cone(names, [inner, outer], &emitter.place)?;
        let direction = check::unit(to_world.transform_vector3(DVec3::Z), &emitter.place)?;
        let position = to_world.transform_point3(DVec3::ZERO);
        let mut image = None;
        if let Some(texture) = self.document.named(emitter, "texture")? {
            if outer >= 90.0 {
                let what = format!("a spot of cutoff_angle {outer} has a texture");
                return Err(emitter.place.wrong(what, "give less than 90 degrees"));
            }
            match self.texture(&texture, 0)? {
                Reflectance::Constant(colour) => intensity *= colour,
                Reflectance::Textured { texture, scale } => {
                    self.must_be_image(emitter, texture)?;
                    intensity *= scale;
                    let to_local = self.rotation(emitter, to_world)?.transpose();
                    image = Some(SpotImage { texture, to_local: DMat3::from_mat4(to_local).as_mat3() });
                }
            }
        }
        let light =
            DeltaLight::Spot { position: Vec3::ZERO, direction, intensity, inner_angle, outer_angle, image };
        self.contents.lights.push((light, position));
        Ok(())
    }

    /// Rejects attributes of meshes, which no light can project.
    fn must_be_image(&self, emitter: &Object, texture: TextureId) -> Result<(), SceneError> {
        let wrong = || emitter.place.wrong("a light projects an attribute of a mesh", "give an image");
        if self.contents.is_image(texture) { Ok(()) } else { Err(wrong()) }
    }

    /// Adds a projector. Its `irradiance` is that of a plane at distance 1, over π.
    fn projector(&mut self, emitter: &Object, to_world: DMat4) -> Result<(), SceneError> {
        let irradiance = match self.document.named(emitter, "irradiance")? {
            Some(texture) => self.texture(&texture, 0)?,
            None => Reflectance::Constant(self.emissive_colour(emitter, "irradiance")?.unwrap_or(Rgb::ONE)),
        };
        let (colour, texture) = match irradiance {
            Reflectance::Constant(colour) => (colour, None),
            Reflectance::Textured { texture, scale } => {
                self.must_be_image(emitter, texture)?;
                (scale, Some(texture))
            }
        };
        let intensity = colour * (PI * emitter.float("scale")?.unwrap_or(1.0) as f32);
        let (tan_half, axis) = field_of_view(emitter)?;
        // Mitsuba's images have x to the left and y up in the frame of a sensor.
        let to_local = DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0))
            * DMat3::from_mat4(self.rotation(emitter, to_world)?.transpose());
        let to_local = to_local.as_mat3();
        let projector = Projector { intensity, texture, to_local, tan_half: tan_half as f32, axis };
        let position = to_world.transform_point3(DVec3::ZERO);
        self.contents.lights.push((DeltaLight::Projector { position: Vec3::ZERO, projector }, position));
        Ok(())
    }

    /// Returns the `to_world` of a lamp or sensor, with a scale of 1 in place of each scale of 0.
    pub(super) fn axes(&mut self, object: &Object) -> Result<Option<DMat4>, SceneError> {
        let Some([to_world, axes]) = object.transforms("to_world")? else { return Ok(None) };
        if axes != to_world {
            let what = format!("the to_world of {} \"{}\" has a scale of 0", object.tag, object.plugin);
            self.log.note(&object.place, what, "it counts as 1: scales do not change lamps and cameras");
        }
        Ok(Some(axes))
    }

    /// Returns the transform without its scale.
    ///
    /// # Errors
    /// If the transform shears or is singular.
    pub(super) fn rotation(&mut self, emitter: &Object, m: DMat4) -> Result<DMat4, SceneError> {
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(|a| a.truncate());
        let [Some(a), Some(b), Some(c)] = [x, y, z].map(unit) else {
            return Err(emitter.place.wrong("to_world is singular", "use a rotation"));
        };
        if a.dot(b).abs().max(b.dot(c).abs()).max(c.dot(a).abs()) > 1e-4 {
            return Err(emitter.place.wrong("to_world shears", "use a rotation"));
        }
        if [x, y, z].iter().any(|a| (a.length() - 1.0).abs() > 1e-4) {
            self.log.warn(
                &emitter.place,
                format!("the to_world of \"{}\" scales", emitter.plugin),
                "the scale is left out",
            )?;
        }
        Ok(DMat4::from_cols(a.extend(0.0), b.extend(0.0), c.extend(0.0), DVec3::ZERO.extend(1.0)))
    }

    pub(super) fn environment(&mut self, emitter: &Object, plan: EnvironmentPlan) -> Result<(), SceneError> {
        if self.contents.environment.is_some() {
            let what = "the scene has more than one environment";
            return Err(emitter.place.wrong(what, "leave one"));
        }
        self.contents.environment = Some(plan);
        Ok(())
    }
}
