//! Options, from the caller's struct to the library's.

use super::arrays::{self, Input};
use super::exports::options::*;
use super::guard::{Failure, Outcome};
use crate::character::Role;
use crate::options::{FaceCurve, GroupSettings, Mode, Options, Stage};
use crate::rig::{GarmentWeights, RigOptions, WeightMethod};
use glam::DVec3;
use std::ptr::null;

/// The defaults, as C sees them.
pub fn defaults() -> SdefOptions {
    let (options, rig) = (Options::default(), RigOptions::default());
    SdefOptions {
        struct_size: size_of::<SdefOptions>() as u32,
        thread_count: 0,
        mode: SDEF_MODE_PRODUCT,
        stage: SDEF_STAGE_FACE,
        rays: 0,
        limits: u32::from(options.limits),
        head_scale: options.head_scale,
        amount: options.amount,
        hair_length: options.hair_length,
        face_squash: f64::NAN,
        face_curve: SDEF_FACE_CURVE_F4,
        group_count: 0,
        groups: null(),
        bone_groups: null(),
        bone_group_count: 0,
        rig_weights: SDEF_WEIGHTS_AUTO,
        rig_garments: SDEF_GARMENTS_ROBUST,
        rig_voxel_resolution: rig.voxel_resolution as u32,
        rig_fingers: u32::from(rig.fingers),
        rig_chin_segment: u32::from(rig.chin_segment),
        rig_heat: rig.heat,
        rig_joints: null(),
        rig_joint_count: 0,
        rig_left_handed: 0,
    }
}

/// Writes the defaults, as far as the caller's struct reaches.
///
/// # Safety
/// `options` is NULL or points to `struct_size` bytes.
pub unsafe fn init(options: *mut SdefOptions, struct_size: u32) -> Outcome {
    arrays::wanted("options", options)?;
    let all = SdefOptions { struct_size, ..defaults() };
    unsafe {
        arrays::struct_in("SdefOptions", &raw const all, all)?;
        let size = (struct_size as usize).min(size_of::<SdefOptions>());
        options.cast::<u8>().copy_from_nonoverlapping((&raw const all).cast(), size);
        // What a newer host has beyond our struct is 0.
        options.cast::<u8>().add(size).write_bytes(0, struct_size as usize - size);
    }
    Ok(())
}

/// One of several constants, which stand in the order of their numbers.
pub fn one_of<T: Copy>(what: &str, number: u32, values: &[T]) -> Outcome<T> {
    values.get(number as usize).copied().ok_or_else(|| {
        Failure::argument(format!("{what} is {number}: give one of its constants, 0 to {}", values.len() - 1))
    })
}

/// The curve of a face.
pub fn face_curve(number: u32) -> Outcome<FaceCurve> {
    one_of("face_curve", number, &[FaceCurve::F4, FaceCurve::F2, FaceCurve::Sphere])
}

/// The role with a number.
pub fn role(what: &str, number: u32) -> Outcome<Role> {
    Role::from_number(number as usize).ok_or_else(|| {
        Failure::argument(format!("{what} has the role {number}: give SDEF_ROLE_*, 0 to {}", Role::COUNT - 1))
    })
}

fn unless_nan(number: f64) -> Option<f64> {
    (!number.is_nan()).then_some(number)
}

/// Reads the caller's options; NULL is the defaults.
///
/// # Safety
/// The struct and its arrays are as the header says.
pub unsafe fn read(options: *const SdefOptions) -> Outcome<(Options, RigOptions)> {
    let given = match options.is_null() {
        true => defaults(),
        false => unsafe { arrays::struct_in("SdefOptions", options, defaults()) }?,
    };
    let mut options = Options {
        mode: one_of("mode", given.mode, &[Mode::Product, Mode::Paper])?,
        rays: (given.rays != 0).then_some(given.rays as usize),
        head_scale: given.head_scale,
        face_squash: unless_nan(given.face_squash),
        face_curve: face_curve(given.face_curve)?,
        amount: given.amount,
        limits: one_of("limits", given.limits, &[false, true])?,
        hair_length: given.hair_length,
        stage: one_of("stage", given.stage, &[Stage::Length, Stage::Thickness, Stage::Face])?,
        thread_count: given.thread_count as usize,
        ..Options::default()
    };
    let groups = unsafe { Input::new("groups", given.groups, given.group_count as usize, 0) }?;
    for (index, settings) in groups.iter().enumerate() {
        let name = unsafe { arrays::text(settings.group) };
        let settings = GroupSettings {
            length_scale: unless_nan(settings.length_scale),
            thickness_scale: unless_nan(settings.thickness_scale),
            length_transfer: unless_nan(settings.length_transfer),
            thickness_transfer: unless_nan(settings.thickness_transfer),
        };
        if options.groups.insert(name.clone(), settings).is_some() {
            return Err(
                Failure::argument(format!("groups {index} is {name} again: set each group once")).at(index)
            );
        }
    }
    let bones = unsafe { Input::new("bone_groups", given.bone_groups, given.bone_group_count as usize, 0) }?;
    for (index, bone) in bones.iter().enumerate() {
        let role = role(&format!("bone_groups {index}"), bone.role).map_err(|error| error.at(index))?;
        options.bone_groups.insert(role, unsafe { arrays::text(bone.group) });
    }
    let mut rig = RigOptions {
        method: one_of(
            "rig_weights",
            given.rig_weights,
            &[WeightMethod::Auto, WeightMethod::Heat, WeightMethod::Volume],
        )?,
        garments: one_of(
            "rig_garments",
            given.rig_garments,
            &[GarmentWeights::Robust, GarmentWeights::Nearest, GarmentWeights::Heat],
        )?,
        heat: given.rig_heat,
        chin_segment: one_of("rig_chin_segment", given.rig_chin_segment, &[false, true])?,
        voxel_resolution: given.rig_voxel_resolution as usize,
        fingers: one_of("rig_fingers", given.rig_fingers, &[false, true])?,
        left_handed: one_of("rig_left_handed", given.rig_left_handed, &[false, true])?,
        thread_count: given.thread_count as usize,
        ..RigOptions::default()
    };
    let joints = unsafe { Input::new("rig_joints", given.rig_joints, given.rig_joint_count as usize, 0) }?;
    for (index, joint) in joints.iter().enumerate() {
        let role = role(&format!("rig_joints {index}"), joint.role).map_err(|error| error.at(index))?;
        rig.given.insert(role, DVec3::new(joint.x, joint.y, joint.z));
    }
    Ok((options, rig))
}
