//! Shapes: meshes from files and analytic shapes.

use super::Converter;
use super::tree::Object;
use crate::error::SceneError;
use crate::file::stem_of;
use crate::mesh::{Normals, Placement, shapes};
use crate::plan::{Geometry, MaterialPlan, MeshPlan, Selection};
use glam::{DMat4, DVec3};
use scene::{Material, MaterialId};

impl Converter<'_> {
    /// Adds a shape that `outer` places: a mesh, or those of a group.
    pub(super) fn shape(&mut self, shape: &Object, outer: DMat4) -> Result<(), SceneError> {
        match shape.plugin.as_str() {
            // A group shows itself by its instances.
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
                .wrong("an instance of no group, or of several", "refer to one shapegroup"));
        };
        if group.plugin != "shapegroup" {
            let what = format!("an instance of a shape \"{}\"", group.plugin);
            return Err(instance.place.wrong(what, "refer to a shapegroup"));
        }
        let to_world = instance.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        instance.report_unused(self.log)?;
        let before = self.contents.meshes.len();
        self.members(group, outer * to_world)?;
        self.instances.0 += self.contents.meshes.len() - before;
        self.instances.1.get_or_insert(instance.place.clone());
        Ok(())
    }

    fn members(&mut self, group: &Object, outer: DMat4) -> Result<(), SceneError> {
        let members = self.tagged(group, "shape")?;
        group.report_unused(self.log)?;
        for member in &members {
            if matches!(member.plugin.as_str(), "shapegroup" | "instance" | "merge") {
                return Err(member.place.wrong("a group in a group", "instance each by itself"));
            }
            self.shape(member, outer)?;
        }
        Ok(())
    }

    /// Notes that instances are copies.
    pub(super) fn report_instances(&mut self) {
        if let (count, Some(place)) = (self.instances.0, &self.instances.1) {
            let what = format!("{count} meshes are placed by instances");
            self.log.note(place, what, "each is a copy, and takes about 100 bytes of memory a triangle");
        }
    }

    fn mesh(&mut self, shape: &Object, outer: DMat4) -> Result<(), SceneError> {
        let mut v_down = true;
        let geometry = match shape.plugin.as_str() {
            // The file's v, flipped by default for OBJ, counts downwards; ours counts upwards.
            "obj" => {
                v_down = !shape.boolean("flip_tex_coords", true)?;
                Geometry::Obj(self.file(shape, "filename")?, Selection::default())
            }
            "ply" => {
                v_down = !shape.boolean("flip_tex_coords", false)?;
                Geometry::Ply(self.file(shape, "filename")?)
            }
            "serialized" => {
                let index = shape.integer("shape_index")?.unwrap_or(0);
                let negative = || shape.place.wrong(format!("shape_index is {index}"), "give 0 or more");
                let index = usize::try_from(index).map_err(|_| negative())?;
                Geometry::Serialized(self.file(shape, "filename")?, index)
            }
            "rectangle" => Geometry::Ready(shapes::rectangle()),
            "cube" => Geometry::Ready(shapes::cube()),
            "disk" => {
                self.tessellated(shape);
                Geometry::Ready(shapes::disk())
            }
            "sphere" => {
                self.tessellated(shape);
                let centre = shape.vector("center")?.unwrap_or(DVec3::ZERO);
                Geometry::Ready(shapes::sphere(centre, shape.positive("radius", 1.0)?))
            }
            "cylinder" => {
                self.tessellated(shape);
                let p0 = shape.vector("p0")?.unwrap_or(DVec3::ZERO);
                let p1 = shape.vector("p1")?.unwrap_or(DVec3::Z);
                Geometry::Ready(shapes::cylinder(p0, p1, shape.positive("radius", 1.0)?))
            }
            other => {
                let what = format!("the shape \"{other}\" is not modelled");
                self.log.warn(&shape.place, what, "it is left out")?;
                return Ok(());
            }
        };
        let emission = match self.tagged(shape, "emitter")?.first() {
            Some(emitter) => self.area_emitter(emitter)?,
            None => None,
        };
        let bsdfs = self.tagged(shape, "bsdf")?;
        let material = self.material_of_shape(bsdfs.first(), emission.is_some())?;
        let textured = self.is_textured(material) || emission.is_some_and(|e| e.texture.is_some());
        let placement = Placement {
            to_world: outer * shape.transform("to_world")?.unwrap_or(DMat4::IDENTITY),
            normals: if shape.boolean("face_normals", false)? { Normals::Flat } else { Normals::Smooth },
            flip_normals: shape.boolean("flip_normals", false)?,
            v_down,
            needs_uv: textured,
        };
        shape.ignore(&["collapse", "silhouette_sampling_weight", "max_smooth_angle"]);
        shape.report_unused(self.log)?;
        let name = shape.id.clone().unwrap_or_else(|| match &geometry {
            Geometry::Obj(path, _) | Geometry::Ply(path) => stem_of(path),
            Geometry::Serialized(path, index) => format!("{}@{index}", stem_of(path)),
            Geometry::Ready(_) | Geometry::Shared(_) => shape.plugin.clone(),
        });
        let place = shape.place.clone();
        let material = MaterialPlan::One(material);
        self.contents.add_mesh(MeshPlan { place, name, geometry, placement, material, emission })
    }

    fn tessellated(&mut self, shape: &Object) {
        let what = format!("the {} is tessellated", shape.plugin);
        self.log.note(&shape.place, what, "128 facets around, area and normals exact");
    }

    fn is_textured(&self, id: MaterialId) -> bool {
        self.contents.materials.get(id.0 as usize).is_some_and(Material::is_textured)
    }
}
