//! Options
//!
//! One struct for everything that can be set; each function reads what concerns it.

use super::arrays::{self, host_structs, not_null};
use super::basics::*;
use super::guard::{Failure, Outcome, call};
use crate::character::Role;
use crate::error::Named;
use crate::options::{
    FaceCurve, GarmentWeights, GroupSettings, Height, Mode, Options, Repair, RigOptions, Stage, WeightMethod,
};
use core::ffi::c_char;
use glam::DVec3;
use safer_ffi::prelude::*;
use std::ptr::null;

/// 15 parts that meet at landmarks of the body: what most hosts want.
pub const SDEF_MODE_PRODUCT: u32 = 0;
/// The paper's chain of bones (Wang et al., Body-shape Transfer), literally.
pub const SDEF_MODE_PAPER: u32 = 1;

/// Lengths only.
pub const SDEF_STAGE_LENGTH: u32 = 0;
/// Lengths and thickness.
pub const SDEF_STAGE_THICKNESS: u32 = 1;
/// Everything.
pub const SDEF_STAGE_FACE: u32 = 2;

/// The paper's choice (Eq. 13).
pub const SDEF_FACE_CURVE_F4: u32 = 0;
/// Eq. 12.
pub const SDEF_FACE_CURVE_F2: u32 = 1;
/// The sphere approximation of Shen et al.
pub const SDEF_FACE_CURVE_SPHERE: u32 = 2;

/// Clothes may end inside of the body.
pub const SDEF_REPAIR_OFF: u32 = 0;
/// Clothes that would are pushed out.
pub const SDEF_REPAIR_ON: u32 = 1;
/// What was pushed last is pushed by as much again, and nothing else is looked for; as ON where nothing was pushed yet.
/// It is faster than ON: for the time in which a slider moves. Set ON once it is let go.
pub const SDEF_REPAIR_KEPT: u32 = 2;

/// Heat where the body allows it, else the volume.
pub const SDEF_WEIGHTS_AUTO: u32 = 0;
/// Heat equilibrium on the surface (Baran and Popovic); for closed bodies.
pub const SDEF_WEIGHTS_HEAT: u32 = 1;
/// Distances through voxels (Dionne and de Lasa); for open and patched bodies.
pub const SDEF_WEIGHTS_VOLUME: u32 = 2;

/// Close points of the body with like normals, the rest filled in smoothly.
pub const SDEF_GARMENTS_ROBUST: u32 = 0;
/// The closest point of the body, whatever it is.
pub const SDEF_GARMENTS_NEAREST: u32 = 1;
/// Heat on the clothes themselves.
pub const SDEF_GARMENTS_HEAT: u32 = 2;

/// Settings of one bone group, left and right together: SDEF_GROUP_SETTINGS_INIT, then what is to be set. NAN in any
/// number leaves the measured or the default value. A scale is set against the character itself, a transfer against the
/// style; where both are given the scale counts. The other groups give way, within limits, to keep the number of heads.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefGroupSettings {
    /// sizeof(SdefGroupSettings)
    pub struct_size: u32,
    /// 0
    pub reserved: u32,
    /// head, neck, torso, shoulder, upper_arm, lower_arm, hand, finger, hip, upper_leg, lower_leg, foot,
    /// or a name of your own from SdefBoneGroup
    pub group: *const c_char,
    /// times the length of the character's own bones; 1 keeps it; 0.01 to 10
    pub length_scale: f64,
    /// times the character's own thickness; 1 keeps it; 0.01 to 10
    pub thickness_scale: f64,
    /// 0 keeps the target's length, 1 takes all of the reference's
    pub length_transfer: f64,
    /// 0 keeps the target's thickness, 1 takes all of the reference's
    pub thickness_transfer: f64,
}

/// Nothing is set.
impl Default for SdefGroupSettings {
    fn default() -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            reserved: 0,
            group: null(),
            length_scale: f64::NAN,
            thickness_scale: f64::NAN,
            length_transfer: f64::NAN,
            thickness_transfer: f64::NAN,
        }
    }
}

/// A bone in a group of your own.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefBoneGroup {
    /// sizeof(SdefBoneGroup)
    pub struct_size: u32,
    /// SDEF_ROLE_* at the end of the bone: LEFT_LOWER_LEG is the left thigh
    pub role: u32,
    /// the group's name
    pub group: *const c_char,
}

/// Where a joint is known to be; see sdef_character_rig.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefGivenJoint {
    /// sizeof(SdefGivenJoint)
    pub struct_size: u32,
    /// SDEF_ROLE_*
    pub role: u32,
    /// model space
    pub x: f64,
    /// model space
    pub y: f64,
    /// model space
    pub z: f64,
}
host_structs!(SdefGroupSettings(reserved) = Self::default(), SdefBoneGroup, SdefGivenJoint);

// The texts of its numbers, their ranges and defaults come from the list of options, options::table: tests/headers writes them
// into the header, for what says that they are there as well.
macro_rules! sdef_options {
    (first $_first:tt later { $(
        $(#[doc = $text:literal])+
        $name:ident: $_low:literal..=$_high:literal = $_default:expr, $_modes:ident, $_heading:ident;
    )+ }) => {
        /// Everything that can be set. Filled by sdef_options_init; NULL stands for the defaults wherever options are asked for.
        #[derive_ReprC]
        #[repr(C)]
        #[derive(Clone, Copy, Debug)]
        pub struct SdefOptions {
            /// sizeof(SdefOptions)
            pub struct_size: u32,
            /// threads to use, up to 1024; 0 (default): all cores
            pub thread_count: u32,
            /// SDEF_MODE_*; default PRODUCT
            pub mode: u32,
            /// SDEF_STAGE_*: stop after it; default FACE, which is everything
            pub stage: u32,
            /// rays around a sample of a bone, 3 to 4096; 0 (default): 48 in product mode, 12 in paper mode
            pub rays: u32,
            /// 1 (default) bounds what product mode may do to a body, 0 does not
            pub limits: u32,
            /// see the list
            pub head_scale: f64,
            /// see the list
            pub amount: f64,
            /// see the list
            pub profile: f64,
            /// see the list
            pub hair_length: f64,
            /// how much younger the face gets, -10 to 10 (bounded where it would fold); 0 leaves it;
            /// NAN (default): 0.8 in product mode where a face is found, 0 in paper mode
            pub face_squash: f64,
            /// SDEF_FACE_CURVE_*; default F4
            pub face_curve: u32,
            /// elements of groups
            pub group_count: u32,
            /// settings by bone group
            pub groups: *const SdefGroupSettings,
            /// bone groups of your own
            pub bone_groups: *const SdefBoneGroup,
            /// elements of bone_groups
            pub bone_group_count: u32,
            /// rig: SDEF_WEIGHTS_* for the body; default AUTO
            pub rig_weights: u32,
            /// rig: SDEF_GARMENTS_* for clothes; default ROBUST
            pub rig_garments: u32,
            /// rig: voxels along the longest side of the volume, 16 to 512; default 128
            pub rig_voxel_resolution: u32,
            /// rig: 1 (default) looks for fingers, 0 does not
            pub rig_fingers: u32,
            /// rig: 1 tells left from right in left-handed axes (Unity's); default 0
            pub rig_left_handed: u32,
            /// rig: how sharp weights by heat are, 0.01 to 1000; default 1
            pub rig_heat: f64,
            /// rig: joints that are known; the rest is found
            pub rig_joints: *const SdefGivenJoint,
            /// elements of rig_joints
            pub rig_joint_count: u32,
            /// SDEF_REPAIR_*: clothes that were outside of the body and would end inside; default ON; product mode alone
            pub repair: u32,
            /// how tall the result is, in the character's units, grown or shrunk as a whole about the ground; 0: as tall as the
            /// character was; NAN (default): as the style and head_scale make it, in product mode at most as tall as it was
            pub height: f64,
            $($(#[doc = $text])+ pub $name: f64,)+
        }
    };
}
crate::number_options!(sdef_options);

host_structs!(SdefOptions = defaults());

/// Fills *options with the defaults.
///
/// options:     struct_size bytes are written, struct_size among them
/// struct_size: sizeof(SdefOptions) as the host was built
///
/// Errors: BAD_ARGUMENT.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_options_init(
    options: *mut SdefOptions,
    struct_size: u32,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { call(error, || init(options, struct_size)) }
}

macro_rules! numbers {
    ($($_block:ident { $(
        $(#[doc = $_text:literal])+
        $name:ident: $_low:literal..=$_high:literal = $_default:expr, $_modes:ident, $_heading:ident;
    )+ })+) => {
        /// The defaults, as C sees them.
        fn defaults() -> SdefOptions {
            let (options, rig) = (Options::default(), RigOptions::default());
            SdefOptions {
                $($($name: options.$name,)+)+
                struct_size: size_of::<SdefOptions>() as u32,
                thread_count: 0,
                mode: options.mode as u32,
                stage: options.stage as u32,
                rays: 0,
                limits: u32::from(options.limits),
                face_squash: f64::NAN,
                face_curve: options.face_curve as u32,
                group_count: 0,
                groups: null(),
                bone_groups: null(),
                bone_group_count: 0,
                rig_weights: rig.method as u32,
                rig_garments: rig.garments as u32,
                rig_voxel_resolution: rig.voxel_resolution as u32,
                rig_fingers: u32::from(rig.fingers),
                rig_left_handed: u32::from(rig.left_handed),
                rig_heat: rig.heat,
                rig_joints: null(),
                rig_joint_count: 0,
                repair: options.repair as u32,
                height: f64::NAN,
            }
        }

        /// The defaults, and the numbers that are given.
        fn numbers_of(given: SdefOptions) -> Options {
            Options { $($($name: given.$name,)+)+ ..Options::default() }
        }
    };
}
crate::number_options!(numbers);

/// Writes the defaults, as far as the caller's struct reaches.
///
/// # Safety
/// `options` is NULL or points to `struct_size` bytes.
unsafe fn init(options: *mut SdefOptions, struct_size: u32) -> Outcome {
    not_null("options", options)?;
    let all = SdefOptions { struct_size, ..defaults() };
    let size = arrays::check_size::<SdefOptions>(struct_size)?.min(size_of::<SdefOptions>());
    unsafe {
        options.cast::<u8>().copy_from_nonoverlapping((&raw const all).cast(), size);
        // What a newer host has beyond our struct is 0.
        options.cast::<u8>().add(size).write_bytes(0, struct_size as usize - size);
    }
    Ok(())
}

/// One of several constants, which stand in the order of their numbers. `constants`: how their names begin.
pub(super) fn one_of<T: Copy>(what: &str, constants: &str, number: u32, values: &[T]) -> Outcome<T> {
    values.get(number as usize).copied().ok_or_else(|| {
        let last = values.len() - 1;
        Failure::argument(format!("{what} is {number}: give one of {constants}*, from 0 to {last}"))
    })
}

/// 0 for no, 1 for yes.
fn switch(what: &str, number: u32) -> Outcome<bool> {
    match number {
        0 | 1 => Ok(number == 1),
        _ => Err(Failure::argument(format!("{what} is {number}: give 0 or 1"))),
    }
}

/// The role with a number.
pub(super) fn role(what: &str, number: u32) -> Outcome<Role> {
    Role::from_number(number as usize).ok_or_else(|| {
        Failure::argument(format!("{what} has the role {number}: give SDEF_ROLE_*, 0 to {}", Role::COUNT - 1))
    })
}

/// A number that is set: NAN stands for none.
pub(super) fn known(number: f64) -> Option<f64> {
    (!number.is_nan()).then_some(number)
}

/// Reads the caller's options; NULL is the defaults.
///
/// # Safety
/// The struct and its arrays are as the header says.
pub unsafe fn read(options: *const SdefOptions) -> Outcome<(Options, RigOptions)> {
    let given = if options.is_null() { defaults() } else { unsafe { arrays::struct_in(options) }? };
    let mut options = Options {
        mode: one_of("mode", "SDEF_MODE_", given.mode, Mode::ALL)?,
        rays: (given.rays != 0).then_some(given.rays as usize),
        face_squash: known(given.face_squash),
        face_curve: one_of("face_curve", "SDEF_FACE_CURVE_", given.face_curve, FaceCurve::ALL)?,
        limits: switch("limits", given.limits)?,
        repair: one_of("repair", "SDEF_REPAIR_", given.repair, Repair::ALL)?,
        height: match known(given.height) {
            None => Height::Style,
            Some(0.0) => Height::Keep,
            Some(units) => Height::Units(units),
        },
        stage: one_of("stage", "SDEF_STAGE_", given.stage, Stage::ALL)?,
        thread_count: given.thread_count as usize,
        ..numbers_of(given)
    };
    let groups = unsafe { arrays::structs_in("groups", given.groups, given.group_count as usize) }?;
    for (index, settings) in groups.iter().enumerate() {
        let at = |failure: Failure| failure.at(SDEF_ELEMENT_GROUP, index);
        let name = unsafe { arrays::needed_text(format!("groups[{index}].group"), settings.group) };
        let name = name.map_err(at)?;
        let settings = GroupSettings {
            length_scale: known(settings.length_scale),
            thickness_scale: known(settings.thickness_scale),
            length_transfer: known(settings.length_transfer),
            thickness_transfer: known(settings.thickness_transfer),
        };
        if options.groups.insert(name.clone(), settings).is_some() {
            let message = format!("groups[{index}] is {} again: set each group once", Named(&name));
            return Err(at(Failure::argument(message)));
        }
    }
    let bones =
        unsafe { arrays::structs_in("bone_groups", given.bone_groups, given.bone_group_count as usize) }?;
    for (index, bone) in bones.iter().enumerate() {
        let at = |failure: Failure| failure.at(SDEF_ELEMENT_BONE_GROUP, index);
        let role = role(&format!("bone_groups[{index}]"), bone.role).map_err(at)?;
        let name = unsafe { arrays::needed_text(format!("bone_groups[{index}].group"), bone.group) };
        options.bone_groups.insert(role, name.map_err(at)?);
    }
    let mut rig = RigOptions {
        method: one_of("rig_weights", "SDEF_WEIGHTS_", given.rig_weights, WeightMethod::ALL)?,
        garments: one_of("rig_garments", "SDEF_GARMENTS_", given.rig_garments, GarmentWeights::ALL)?,
        heat: given.rig_heat,
        voxel_resolution: given.rig_voxel_resolution as usize,
        fingers: switch("rig_fingers", given.rig_fingers)?,
        left_handed: switch("rig_left_handed", given.rig_left_handed)?,
        thread_count: given.thread_count as usize,
        ..RigOptions::default()
    };
    let joints =
        unsafe { arrays::structs_in("rig_joints", given.rig_joints, given.rig_joint_count as usize) }?;
    for (index, joint) in joints.iter().enumerate() {
        let role = role(&format!("rig_joints[{index}]"), joint.role)
            .map_err(|failure| failure.at(SDEF_ELEMENT_GIVEN_JOINT, index))?;
        rig.given.insert(role, DVec3::new(joint.x, joint.y, joint.z));
    }
    Ok((options, rig))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constants_are_the_numbers_of_the_choices() {
        assert_eq!(
            [SDEF_MODE_PRODUCT, SDEF_MODE_PAPER],
            [Mode::Product, Mode::Paper].map(|mode| mode as u32)
        );
        let stages = [Stage::Length, Stage::Thickness, Stage::Face].map(|stage| stage as u32);
        assert_eq!([SDEF_STAGE_LENGTH, SDEF_STAGE_THICKNESS, SDEF_STAGE_FACE], stages);
        let curves = [FaceCurve::F4, FaceCurve::F2, FaceCurve::Sphere].map(|curve| curve as u32);
        assert_eq!([SDEF_FACE_CURVE_F4, SDEF_FACE_CURVE_F2, SDEF_FACE_CURVE_SPHERE], curves);
        let methods =
            [WeightMethod::Auto, WeightMethod::Heat, WeightMethod::Volume].map(|method| method as u32);
        assert_eq!([SDEF_WEIGHTS_AUTO, SDEF_WEIGHTS_HEAT, SDEF_WEIGHTS_VOLUME], methods);
        let rules =
            [GarmentWeights::Robust, GarmentWeights::Nearest, GarmentWeights::Heat].map(|rule| rule as u32);
        assert_eq!([SDEF_GARMENTS_ROBUST, SDEF_GARMENTS_NEAREST, SDEF_GARMENTS_HEAT], rules);
        let repairs = [Repair::Off, Repair::On, Repair::Kept].map(|repair| repair as u32);
        assert_eq!([SDEF_REPAIR_OFF, SDEF_REPAIR_ON, SDEF_REPAIR_KEPT], repairs);
        // What is read back: the n-th of all is the number n.
        assert!(Mode::ALL.iter().enumerate().all(|(number, &mode)| mode as usize == number));
        assert!(Stage::ALL.iter().enumerate().all(|(number, &stage)| stage as usize == number));
        assert!(FaceCurve::ALL.iter().enumerate().all(|(number, &curve)| curve as usize == number));
        assert!(Repair::ALL.iter().enumerate().all(|(number, &repair)| repair as usize == number));
        assert!(WeightMethod::ALL.iter().enumerate().all(|(number, &method)| method as usize == number));
        assert!(GarmentWeights::ALL.iter().enumerate().all(|(number, &rule)| rule as usize == number));
    }
}
