//! Groups of meshes and instances, by name, and the places at which their meshes are seen.
//!
//! Instances may be members of groups themselves. The renderer has one level, so the transforms of all levels are
//! multiplied here.

use crate::budget::lacking;
use crate::error::{Location, SceneError};
use crate::plan::{Contents, SeenPlan};
use glam::DMat4;
use scene::requirements::INSTANCE_BYTES;
use std::collections::BTreeMap;

/// All groups of a description.
#[derive(Debug, Default)]
pub(super) struct NamedGroups {
    by_name: BTreeMap<String, NamedGroup>,
    /// Instances that are no members of groups.
    shown: Vec<Instance>,
}

/// A group of a description.
#[derive(Debug)]
struct NamedGroup {
    /// Location of its first member.
    place: Location,
    /// Number of the group of its meshes, if it has some.
    meshes: Option<usize>,
    instances: Vec<Instance>,
    /// Number of places at which one instance of it shows meshes, once it is known.
    places: Option<u64>,
}

/// A group at several places.
#[derive(Clone, Debug)]
pub(super) struct Instance {
    /// Location of its description.
    pub place: Location,
    /// Name of the group.
    pub group: String,
    pub placements: Vec<DMat4>,
}

impl NamedGroups {
    /// Returns the number of the group for meshes of the group `name`.
    pub fn meshes_of(&mut self, name: &str, place: &Location, contents: &mut Contents) -> usize {
        *self.named(name, place).meshes.get_or_insert_with(|| contents.add_group())
    }

    /// Adds an instance to the scene, or to the group `member_of`.
    pub fn add(&mut self, instance: Instance, member_of: Option<&str>) {
        match member_of {
            Some(name) => {
                let place = instance.place.clone();
                self.named(name, &place).instances.push(instance);
            }
            None => self.shown.push(instance),
        }
    }

    fn named(&mut self, name: &str, place: &Location) -> &mut NamedGroup {
        let new = || NamedGroup { place: place.clone(), meshes: None, instances: Vec::new(), places: None };
        self.by_name.entry(name.to_owned()).or_insert_with(new)
    }

    /// Shows all meshes of groups at their places. Returns the groups that no instance shows, with their locations.
    ///
    /// # Errors
    /// If an instance is of an unknown group, or of a group that contains the instance. Also if memory is short.
    pub fn show(mut self, contents: &mut Contents) -> Result<Vec<(String, Location)>, SceneError> {
        let mut all: u64 = 0;
        let shown = std::mem::take(&mut self.shown);
        for instance in &shown {
            let places = self.count(instance, &mut Vec::new())?;
            all = all.saturating_add(places);
            let bytes = all.saturating_mul((INSTANCE_BYTES + size_of::<SeenPlan>()) as u64);
            if let Some(lack) = lacking(bytes) {
                let what = format!("the instances place meshes {all} times, which takes {lack}");
                return Err(instance.place.wrong(what, "leave some of them out"));
            }
        }
        for instance in &shown {
            self.place(instance, &DMat4::IDENTITY, contents);
        }
        let unseen = self.by_name.into_iter().filter(|(_, group)| group.places.is_none());
        Ok(unseen.map(|(name, group)| (name, group.place)).collect())
    }

    /// Returns the number of places at which an instance shows meshes. `above` has the names of the groups around it.
    fn count(&mut self, instance: &Instance, above: &mut Vec<String>) -> Result<u64, SceneError> {
        let name = &instance.group;
        if above.contains(name) {
            let what = format!("the group \"{name}\" is a member of itself: {} > {name}", above.join(" > "));
            return Err(instance.place.wrong(what, "leave this instance out"));
        }
        let Some(group) = self.by_name.get(name) else {
            return Err(instance.place.undefined("group", name));
        };
        let each = match group.places {
            Some(known) => known,
            None => {
                let mut places = u64::from(group.meshes.is_some());
                above.push(name.clone());
                for inner in group.instances.clone() {
                    places = places.saturating_add(self.count(&inner, above)?);
                }
                above.pop();
                if let Some(group) = self.by_name.get_mut(name) {
                    group.places = Some(places);
                }
                places
            }
        };
        Ok(each.saturating_mul(instance.placements.len() as u64))
    }

    /// Shows the meshes of an instance, whose places `outer` moves.
    fn place(&self, instance: &Instance, outer: &DMat4, contents: &mut Contents) {
        let Some(group) = self.by_name.get(&instance.group) else { return };
        for placement in &instance.placements {
            let to_world = *outer * *placement;
            if let Some(meshes) = group.meshes {
                contents.show_group(meshes, to_world, None);
            }
            for inner in &group.instances {
                self.place(inner, &to_world, contents);
            }
        }
    }
}
