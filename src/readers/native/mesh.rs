//! Meshes of the native format: generated parts, files and shapes.

use super::builder::SceneBuilder;
use super::text::{ColourText, MeshText, NamesText, Number, ScaleText, StepText};
use crate::attributes::COLOUR;
use crate::error::{Location, SceneError};
use crate::file::stem_of;
use crate::gltf::{self, FRAMES_PER_SECOND, ImportOptions};
use crate::mesh::{Normals, Placement, RawMesh, shapes};
use crate::plan::{MaterialPlan, MeshPlan, MeshSource};
use crate::selection::PartSelection;
use base::math::{Rgb, unit};
use glam::{DMat3, DMat4, DVec3};
use lightsplat_scenes::Part;
use scene::{Emission, Material, MaterialId, Reflectance};
use std::path::{Path, PathBuf};
use toml::Spanned;

impl SceneBuilder<'_> {
    pub(super) fn mesh(&mut self, text: &Spanned<MeshText>) -> Result<(), SceneError> {
        let place = self.file.place(text.span());
        let text = text.get_ref();
        if let Some(path) = self.model(text) {
            return self.import(&path, text, &place);
        }
        let of_models = [text.lumens_per_watt, text.fps, text.time];
        if of_models.iter().any(Option::is_some) || text.thin_glass.is_some() {
            let what = "lumens_per_watt, thin_glass, fps and time are only for glTF models";
            return Err(place.wrong(what, "leave them out"));
        }
        let (name, geometry) = self.geometry(text, &place)?;
        if !matches!(geometry, MeshSource::Obj(..)) && (text.group.is_some() || text.except.is_some()) {
            return Err(place.wrong("the mesh has no groups", "leave group and except out"));
        }
        let to_world = self.transform(&text.transform)?;
        let material = match (self.named_material(text)?, &geometry) {
            (Some(material), _) => MaterialPlan::One(material),
            (None, MeshSource::Obj(path, _)) => self.mtl_materials(path, &place, &to_world)?,
            (None, source) if source.has_colours(&place)? => {
                MaterialPlan::One(self.default_material(true, &place))
            }
            (None, _) => {
                return Err(place.wrong("the mesh has no material", "add material = \"...\""));
            }
        };
        let emission =
            text.emission.as_ref().map(|colour| self.emission(colour, text, &place)).transpose()?;
        let placement = Placement {
            to_world,
            normals: Normals::AsGiven,
            flip_normals: text.flip_normals,
            // The v of a sphere counts from its north pole.
            v_down: text.shape.as_deref() == Some("sphere"),
            needs_uv: false,
        };
        let plan = MeshPlan { place, name, geometry, placement, material, emission };
        match self.member_of(text, &plan.place) {
            Some(group) => self.contents.add_member(group, plan),
            None => self.contents.add_mesh(plan),
        }
    }

    /// Returns the file of a glTF model; `None` for other meshes.
    fn model(&self, text: &MeshText) -> Option<PathBuf> {
        let path = self.folder.join(text.file.as_ref()?);
        let extension = path.extension()?.to_string_lossy().to_lowercase();
        matches!(extension.as_str(), "glb" | "gltf").then_some(path)
    }

    fn import(&mut self, path: &Path, text: &MeshText, place: &Location) -> Result<(), SceneError> {
        let positive = |value: Option<Number>, key: &str| match value.map(f64::from) {
            Some(value) if value <= 0.0 => {
                Err(place.wrong(format!("{key} is {value}"), "give a number above 0"))
            }
            value => Ok(value),
        };
        let emission = text.emission.as_ref().map(|colour| self.emission(colour, text, place)).transpose()?;
        let options = ImportOptions {
            to_world: self.transform(&text.transform)?,
            selection: selection(text),
            flip_normals: text.flip_normals,
            material: self.named_material(text)?,
            emission,
            lumens_per_watt: positive(text.lumens_per_watt, "lumens_per_watt")?.map(|lumens| lumens as f32),
            thin_glass: text.thin_glass.unwrap_or(false),
            is_scene: false,
            fps: positive(text.fps, "fps")?.unwrap_or(FRAMES_PER_SECOND),
            time: text.time.map(f64::from),
            frame: None,
            camera: None,
            group: self.member_of(text, place),
        };
        let imported = gltf::import(path, place, &options, &mut self.contents, self.log)?;
        for (path, hash) in imported.sources {
            self.add_source(&path, hash);
        }
        self.model_shot = self.model_shot.take().or(imported.shot);
        Ok(())
    }

    /// Returns the number of the group whose instances show a mesh, if it is in one.
    fn member_of(&mut self, text: &MeshText, place: &Location) -> Option<usize> {
        let name = text.member_of.as_ref()?;
        Some(self.groups.meshes_of(name, place, &mut self.contents))
    }

    fn named_material(&self, text: &MeshText) -> Result<Option<MaterialId>, SceneError> {
        let Some(name) = &text.material else { return Ok(None) };
        let unknown = || self.file.place(name.span()).undefined("material", name.get_ref());
        self.material_ids.get(name.get_ref()).copied().map(Some).ok_or_else(unknown)
    }

    fn emission(
        &mut self,
        colour: &ColourText,
        text: &MeshText,
        place: &Location,
    ) -> Result<Emission, SceneError> {
        let (radiance, texture) = match self.colour(colour, place)? {
            Reflectance::Constant(_) => (colour.rgb("the emission", place)?, None),
            Reflectance::Textured { texture, scale } => (scale, Some(texture)),
        };
        Ok(Emission { radiance, texture, two_sided: text.emission_two_sided })
    }

    fn geometry(&mut self, text: &MeshText, place: &Location) -> Result<(String, MeshSource), SceneError> {
        match (&text.part, &text.file, &text.shape) {
            (Some(part), None, None) => {
                let unknown = || place.undefined("generated part", part);
                let at = self.parts.iter().position(|p| p.name == *part).ok_or_else(unknown)?;
                self.part_used[at] = true;
                Ok((part.clone(), MeshSource::Ready(raw_part(&self.parts[at]))))
            }
            (None, Some(file), None) => {
                let path = self.folder.join(file);
                let name = stem_of(&path);
                let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
                let geometry = match extension.as_deref() {
                    Some("obj") => MeshSource::Obj(path, selection(text)),
                    Some("ply") => MeshSource::Ply(path),
                    Some("stl") => MeshSource::Stl(path),
                    Some("serialized") => MeshSource::Serialized(path, text.index.unwrap_or(0)),
                    _ => {
                        let what = format!("unknown kind of mesh file \"{file}\"");
                        return Err(place.wrong(what, "use .glb, .gltf, .obj, .ply, .stl or .serialized"));
                    }
                };
                Ok((name, geometry))
            }
            (None, None, Some(shape)) => {
                let raw = match shape.as_str() {
                    "rectangle" => shapes::rectangle(),
                    "cube" => shapes::cube(),
                    "disk" => shapes::disk(),
                    "sphere" => shapes::sphere(DVec3::ZERO, 1.0),
                    "cylinder" => shapes::cylinder(DVec3::ZERO, DVec3::Z, 1.0),
                    other => {
                        let remedy = "use rectangle, cube, sphere, disk or cylinder";
                        return Err(place.wrong(format!("unknown shape \"{other}\""), remedy));
                    }
                };
                Ok((shape.clone(), MeshSource::Ready(raw)))
            }
            _ => Err(place.wrong("the mesh has no single source", "give one of part, file or shape")),
        }
    }

    pub(super) fn transform(&self, steps: &[Spanned<StepText>]) -> Result<DMat4, SceneError> {
        let mut to_world = DMat4::IDENTITY;
        for step in steps {
            let place = self.file.place(step.span());
            to_world = matrix(step.get_ref(), &place)? * to_world;
            if !to_world.is_finite() {
                return Err(place.wrong("the transform is not finite", "write smaller numbers"));
            }
        }
        Ok(to_world)
    }

    /// Reads the materials of the OBJ's MTL files. They are assigned by name.
    pub(super) fn mtl_materials(
        &mut self,
        path: &Path,
        place: &Location,
        to_world: &DMat4,
    ) -> Result<MaterialPlan, SceneError> {
        let unit = DMat3::from_mat4(*to_world).determinant().abs().cbrt();
        let (named, has_colours) = self.read_mtl(path, place, unit as f32)?;
        let other = self.default_material(has_colours, place);
        Ok(MaterialPlan::ByName(named, other))
    }

    /// Returns the material of faces without one: diffuse, of the colours of the mesh if it has some, else grey.
    pub(super) fn default_material(&mut self, has_colours: bool, place: &Location) -> MaterialId {
        let diffuse = match has_colours {
            true => {
                let texture = self.contents.add_attribute(COLOUR, None);
                Reflectance::Textured { texture, scale: Rgb::ONE }
            }
            false => Reflectance::Constant(Rgb::splat(0.5)),
        };
        let material = Material { name: "default".into(), two_sided: true, diffuse, ..Material::default() };
        self.contents.add_material(material, place.clone())
    }
}

/// Returns the groups or nodes that a mesh selects.
fn selection(text: &MeshText) -> PartSelection {
    let names = |names: &Option<NamesText>| match names {
        None => Vec::new(),
        Some(NamesText::One(name)) => vec![name.clone()],
        Some(NamesText::Several(names)) => names.clone(),
    };
    PartSelection { only: names(&text.group), except: names(&text.except) }
}

fn matrix(step: &StepText, place: &Location) -> Result<DMat4, SceneError> {
    Ok(match (&step.scale, &step.rotate, step.translate, step.matrix) {
        (Some(ScaleText::Uniform(s)), None, None, None) => DMat4::from_scale(DVec3::splat(s.0)),
        (Some(ScaleText::Axes(s)), None, None, None) => DMat4::from_scale(DVec3::from(*s)),
        (None, Some(rotate), None, None) => {
            let axis = unit(DVec3::from(rotate.axis));
            let zero = || place.wrong("the rotation's axis is zero", "give a direction");
            DMat4::from_axis_angle(axis.ok_or_else(zero)?, rotate.angle.0.to_radians())
        }
        (None, None, Some(by), None) => DMat4::from_translation(DVec3::from(by)),
        (None, None, None, Some(rows)) => DMat4::from_cols_array(&rows.0.map(f64::from)).transpose(),
        _ => {
            let remedy =
                "write { scale = 2.0 }, { rotate = { ... } }, { translate = [...] } or { matrix = [...] }";
            return Err(place.wrong("a transform step needs exactly one operation", remedy));
        }
    })
}

fn raw_part(part: &Part) -> RawMesh {
    RawMesh {
        positions: part.positions.iter().map(|p| p.as_dvec3()).collect(),
        normals: part.normals.clone(),
        uvs: part.uvs.clone(),
        triangles: part.triangles.clone(),
        ..RawMesh::default()
    }
}
