//! Conversion of shapes: meshes from files, and analytic shapes.

use super::converter::Converter;
use super::tree::Object;
use crate::error::SceneError;
use crate::file::stem_of;
use crate::mesh::{Normals, Placement, shapes};
use crate::plan::{MaterialPlan, MeshPlan, MeshSource};
use crate::selection::PartSelection;
use glam::{DMat3, DMat4, DVec3};
use scene::{MaterialId, TextureId};
use std::rc::Rc;

impl Converter<'_> {
    /// Adds a shape with the outer transform `outer`: a mesh, or the meshes of a group.
    pub(super) fn shape(&mut self, shape: &Object, outer: DMat4) -> Result<(), SceneError> {
        match shape.plugin.as_str() {
            // A group is visible through its instances only.
            "shapegroup" => Ok(()),
            "instance" => self.instance(shape, outer),
            "merge" => self.members(shape, outer),
            _ => self.mesh(shape, outer),
        }
    }

    /// Places the meshes of a group.
    fn instance(&mut self, instance: &Object, outer: DMat4) -> Result<(), SceneError> {
        let groups = self.tagged(instance, "shape")?;
        let [group] = &groups[..] else {
            return Err(instance
                .place
                .wrong("an instance without a group, or with several", "refer to one shapegroup"));
        };
        if group.plugin != "shapegroup" {
            let what = format!("an instance of a shape \"{}\"", group.plugin);
            return Err(instance.place.wrong(what, "refer to a shapegroup"));
        }
        let to_world = outer * instance.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        if !DMat3::from_mat4(to_world).determinant().is_finite() {
            let what = "the transform of an instance is not finite";
            return Err(instance.place.wrong(what, "give smaller numbers"));
        }
        instance.report_unused(self.log)?;
        let group = self.group(group)?;
        self.contents.show_group(group, to_world, None);
        Ok(())
    }

    /// Returns the number of a group, whose meshes are read at its first instance.
    fn group(&mut self, group: &Rc<Object>) -> Result<usize, SceneError> {
        let known = self.groups.iter().find(|(known, _)| Rc::ptr_eq(known, group));
        if let Some((_, number)) = known {
            return Ok(*number);
        }
        let number = self.contents.add_group();
        self.groups.push((group.clone(), number));
        self.into_group = Some(number);
        let members = self.members(group, DMat4::IDENTITY);
        self.into_group = None;
        members.map(|()| number)
    }

    fn members(&mut self, group: &Object, outer: DMat4) -> Result<(), SceneError> {
        let members = self.tagged(group, "shape")?;
        group.report_unused(self.log)?;
        if members.is_empty() {
            let what = format!("the {} has no shape", group.plugin);
            return Err(group.place.wrong(what, "add shapes to it, or leave it out"));
        }
        for member in &members {
            if matches!(member.plugin.as_str(), "shapegroup" | "instance" | "merge") {
                return Err(member.place.wrong("a group in a group", "instance each by itself"));
            }
            self.shape(member, outer)?;
        }
        Ok(())
    }

    /// Returns the source of a mesh, and whether its v counts downwards; `None` for a shape that is not supported.
    fn geometry(&mut self, shape: &Object) -> Result<Option<(MeshSource, bool)>, SceneError> {
        let mut v_down = true;
        let geometry = match shape.plugin.as_str() {
            // OBJ files of Mitsuba flip v by default, so it counts downwards. The renderer counts upwards.
            "obj" => {
                v_down = !shape.boolean("flip_tex_coords", true)?;
                MeshSource::Obj(self.file(shape, "filename")?, PartSelection::default())
            }
            "ply" => {
                v_down = !shape.boolean("flip_tex_coords", false)?;
                MeshSource::Ply(self.file(shape, "filename")?)
            }
            "serialized" => {
                let index = shape.integer("shape_index")?.unwrap_or(0);
                let negative = || shape.place.wrong(format!("shape_index is {index}"), "give 0 or more");
                let index = usize::try_from(index).map_err(|_| negative())?;
                MeshSource::Serialized(self.file(shape, "filename")?, index)
            }
            "rectangle" => MeshSource::Ready(shapes::rectangle()),
            "cube" => MeshSource::Ready(shapes::cube()),
            "disk" => {
                self.tessellated(shape);
                MeshSource::Ready(shapes::disk())
            }
            "sphere" => {
                self.tessellated(shape);
                let centre = shape.vector("center")?.unwrap_or(DVec3::ZERO);
                MeshSource::Ready(shapes::sphere(centre, shape.positive("radius", 1.0)?))
            }
            "cylinder" => {
                self.tessellated(shape);
                let p0 = shape.vector("p0")?.unwrap_or(DVec3::ZERO);
                let p1 = shape.vector("p1")?.unwrap_or(DVec3::Z);
                MeshSource::Ready(shapes::cylinder(p0, p1, shape.positive("radius", 1.0)?))
            }
            other => {
                let what = format!("the shape \"{other}\" is not supported");
                self.log.warn(&shape.place, what, "it is left out")?;
                return Ok(None);
            }
        };
        Ok(Some((geometry, v_down)))
    }

    fn mesh(&mut self, shape: &Object, outer: DMat4) -> Result<(), SceneError> {
        let Some((geometry, v_down)) = self.geometry(shape)? else { return Ok(()) };
        let emission = match self.first(shape, "emitter")? {
            Some(emitter) => self.area_emitter(&emitter)?,
            None => None,
        };
        for sensor in self.tagged(shape, "sensor")? {
            let what = format!("the sensor \"{}\" of a shape is not supported", sensor.plugin);
            self.log.warn(&sensor.place, what, "it is left out")?;
        }
        let bsdf = self.first(shape, "bsdf")?;
        let material = self.material_of_shape(bsdf.as_ref(), emission.is_some())?;
        let of_emission = emission.and_then(|emission| emission.texture);
        let textured =
            self.reads_images(material) || of_emission.is_some_and(|texture| self.contents.is_image(texture));
        let to_world = shape.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        // Mitsuba turns a sphere inside out if the sphere's own transform mirrors it.
        let is_turned = shape.plugin == "sphere" && to_world.determinant() < 0.0;
        let placement = Placement {
            to_world: outer * to_world,
            normals: if shape.boolean("face_normals", false)? { Normals::Flat } else { Normals::Smooth },
            flip_normals: shape.boolean("flip_normals", false)? != is_turned,
            v_down,
            needs_uv: textured,
        };
        shape.report_unused(self.log)?;
        let name = shape.id.clone().unwrap_or_else(|| match &geometry {
            MeshSource::Obj(path, _) | MeshSource::Ply(path) | MeshSource::Stl(path) => stem_of(path),
            MeshSource::Serialized(path, index) => format!("{}@{index}", stem_of(path)),
            MeshSource::Ready(_) | MeshSource::Shared(_) => shape.plugin.clone(),
        });
        let place = shape.place.clone();
        let material = MaterialPlan::One(material);
        let plan = MeshPlan { place, name, geometry, placement, material, emission };
        match self.into_group {
            Some(group) => self.contents.add_member(group, plan),
            None => self.contents.add_mesh(plan),
        }
    }

    fn tessellated(&mut self, shape: &Object) {
        let what = format!("the {} is tessellated", shape.plugin);
        self.log.note(&shape.place, what, "128 facets around, area and normals exact");
    }

    /// Returns true if a material looks images up.
    fn reads_images(&self, id: MaterialId) -> bool {
        let is_image = |texture: &TextureId| self.contents.is_image(*texture);
        self.contents
            .materials
            .get(id.0 as usize)
            .is_some_and(|material| material.relief.is_some() || material.textures().iter().any(is_image))
    }
}
