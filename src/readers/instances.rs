//! Choice of the groups that are stored once and seen at several places.
//!
//! The meshes of a group are copied to each place if
//! - the group is seen at one place,
//! - its meshes emit, or
//! - the copies are few: groups are copied from the fewest triangles of all copies up, as long as all copies together
//!   have at most a given number of triangles.
//!
//! Copies are traced faster than instances. A place is a copy, too, if its transform rounds too much: offsets of rays
//! would not cover the rounding of coordinates that are moved to the group and back.

use crate::draft::{DraftGroup, DraftMesh};
use crate::error::{SceneError, Warning};
use crate::mesh::RawMesh;
use crate::plan::{Contents, MeshPlan, SeenPlan};
use crate::surfaces::{self, MeshPart};
use glam::{DMat3, DMat4};
use rayon::prelude::*;

/// Number of triangles up to which instances are copies.
pub(crate) const MOST_COPIED: u64 = 1_000_000;

/// Factor up to which a transform and its inverse may magnify the rounding of coordinates. Rotations and stretches
/// along axes of the group stay below 3.1.
const MAX_MAGNIFIED: f64 = 24.0;

/// Meshes of a plan.
#[derive(Clone, Debug, Default)]
pub(crate) struct ReadPlan {
    /// Meshes where the plan places them: in the world, or in the group's coordinates.
    pub meshes: Vec<DraftMesh>,
    /// Parts of the meshes as in their file, for copies of members of groups; else empty.
    parts: Vec<MeshPart>,
}

impl ReadPlan {
    /// Places the meshes of a plan. Those of a group are kept for copies, too.
    pub fn new(plan: &MeshPlan, raw: RawMesh, is_member: bool, remarks: &mut Vec<Warning>) -> ReadPlan {
        let parts = surfaces::parts(plan, raw, remarks);
        let kept = if is_member { parts.clone() } else { Vec::new() };
        let placed = |part: MeshPart| part.placed(plan, plan.placement.to_world, None);
        ReadPlan { meshes: parts.into_iter().map(placed).collect(), parts: kept }
    }

    fn triangles(&self) -> u64 {
        self.meshes.iter().map(|mesh| mesh.triangles.len() as u64).sum()
    }
}

impl Contents {
    /// Returns for each mesh whether it is in a group.
    pub fn are_members(&self) -> Vec<bool> {
        let mut are_members = vec![false; self.meshes.len()];
        self.groups.iter().flatten().for_each(|&mesh| are_members[mesh] = true);
        are_members
    }
}

/// Size of a group and of all its copies.
#[derive(Clone, Copy, Debug, Default)]
struct GroupSize {
    triangles: u64,
    places: u64,
    emits: bool,
}

impl GroupSize {
    fn copies(&self) -> u64 {
        self.triangles.saturating_mul(self.places)
    }
}

/// Returns the meshes of a scene, those of groups that are stored once last, and these groups.
///
/// # Errors
/// If the copies do not fit into memory.
pub(crate) fn assemble(
    contents: &Contents,
    mut read: Vec<ReadPlan>,
    most_copied: u64,
) -> Result<(Vec<DraftMesh>, Vec<DraftGroup>), SceneError> {
    let sizes = sizes(contents, &read);
    let is_stored = choose(&sizes, most_copied);
    let is_instance =
        |group: usize, to_world: &DMat4| is_stored[group] && magnified(to_world) <= MAX_MAGNIFIED;
    reserve(contents, &sizes, is_instance)?;
    let copy = |seen: &SeenPlan| match seen {
        SeenPlan::Group { group, to_world, name } if !is_instance(*group, to_world) => {
            copies(contents, &read, *group, to_world, name.as_deref())
        }
        SeenPlan::Mesh(_) | SeenPlan::Group { .. } => Vec::new(),
    };
    let copied: Vec<Vec<DraftMesh>> = contents.seen.par_iter().map(copy).collect();
    let (mut meshes, mut placements) = (Vec::new(), vec![Vec::new(); contents.groups.len()]);
    for (seen, mut copied) in contents.seen.iter().zip(copied) {
        match seen {
            SeenPlan::Mesh(mesh) => meshes.append(&mut read[*mesh].meshes),
            SeenPlan::Group { group, to_world, .. } if is_instance(*group, to_world) => {
                placements[*group].push(*to_world);
            }
            SeenPlan::Group { .. } => meshes.append(&mut copied),
        }
    }
    let mut groups = Vec::new();
    for (members, placements) in contents.groups.iter().zip(placements) {
        if placements.is_empty() {
            continue;
        }
        let number = Some(groups.len());
        let stored = members.iter().flat_map(|&member| std::mem::take(&mut read[member].meshes));
        meshes.extend(stored.map(|mesh| DraftMesh { group: number, ..mesh }));
        groups.push(DraftGroup { placements, ..DraftGroup::default() });
    }
    Ok((meshes, groups))
}

/// Returns the sizes of all groups.
fn sizes(contents: &Contents, read: &[ReadPlan]) -> Vec<GroupSize> {
    let size = |members: &Vec<usize>| GroupSize {
        triangles: members.iter().map(|&member| read[member].triangles()).sum(),
        places: 0,
        emits: members.iter().any(|&member| read[member].meshes.iter().any(|mesh| mesh.emission.is_some())),
    };
    let mut sizes: Vec<GroupSize> = contents.groups.iter().map(size).collect();
    for seen in &contents.seen {
        if let SeenPlan::Group { group, .. } = seen {
            sizes[*group].places += 1;
        }
    }
    sizes
}

/// Returns for each group whether it is stored once.
fn choose(sizes: &[GroupSize], most_copied: u64) -> Vec<bool> {
    let may_be_stored = |size: &GroupSize| size.places > 1 && !size.emits;
    let mut copied: u64 =
        sizes.iter().filter(|size| size.places > 1 && size.emits).map(GroupSize::copies).sum();
    let mut order: Vec<usize> = (0..sizes.len()).filter(|&group| may_be_stored(&sizes[group])).collect();
    order.sort_by_key(|&group| sizes[group].copies());
    let mut is_stored = vec![false; sizes.len()];
    for group in order {
        copied = copied.saturating_add(sizes[group].copies());
        is_stored[group] = copied > most_copied;
    }
    is_stored
}

/// Counts the triangles of copies in the budget. Each group is counted once already.
fn reserve(
    contents: &Contents,
    sizes: &[GroupSize],
    is_instance: impl Fn(usize, &DMat4) -> bool,
) -> Result<(), SceneError> {
    let mut is_counted = vec![false; sizes.len()];
    for seen in &contents.seen {
        let SeenPlan::Group { group, to_world, .. } = seen else { continue };
        let plan = contents.groups[*group].first().map(|&member| &contents.meshes[member]);
        let is_first = !std::mem::replace(&mut is_counted[*group], true);
        if let Some(plan) = plan.filter(|_| !is_first && !is_instance(*group, to_world)) {
            contents.budget.take(sizes[*group].triangles as usize, &plan.place)?;
        }
    }
    Ok(())
}

/// Returns the meshes of a group in the world.
fn copies(
    contents: &Contents,
    read: &[ReadPlan],
    group: usize,
    to_world: &DMat4,
    name: Option<&str>,
) -> Vec<DraftMesh> {
    let of_member = |&member: &usize| {
        let plan = &contents.meshes[member];
        // A product with the identity may change the sign of zeros.
        let mesh_to_world = match plan.placement.to_world == DMat4::IDENTITY {
            true => *to_world,
            false => *to_world * plan.placement.to_world,
        };
        let parts = read[member].parts.iter().cloned();
        parts.map(move |part| part.placed(plan, mesh_to_world, name)).collect::<Vec<_>>()
    };
    contents.groups[group].iter().flat_map(of_member).collect()
}

/// Returns the factor by which a transform and its inverse magnify the rounding of coordinates; infinity without an
/// inverse.
///
/// Reference: R. D. Skeel, *Scaling for Numerical Stability in Gaussian Elimination*, 1979. The factor is the norm of
/// |A| |A⁻¹|, which does not depend on lengths along the axes of the group.
fn magnified(to_world: &DMat4) -> f64 {
    let linear = DMat3::from_mat4(*to_world);
    let abs = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    let product = abs(linear) * abs(linear.inverse());
    let rows = product.transpose();
    let sums = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.element_sum());
    let most = sums.into_iter().fold(0.0, f64::max);
    if product.is_finite() && linear.determinant() != 0.0 { most } else { f64::INFINITY }
}
