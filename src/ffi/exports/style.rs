//! Styles: what a character should become
//!
//! A style is numbers, not a model: it can be saved, mixed, and used with any character.

use super::basics::{SdefCharacter, SdefError, SdefStatus, SdefStyle};
use super::options::SdefOptions;
use crate::ffi::style;
use core::ffi::c_char;
use safer_ffi::prelude::*;

/// SdefBone.end of the bone from the head joint to the top of the head.
pub const SDEF_BONE_HEAD_TOP: u32 = 55;

/// One bone of a measured body.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SdefBone {
    /// SDEF_ROLE_* at its end, or SDEF_BONE_HEAD_TOP
    pub end: u32,
    /// 0
    pub reserved: u32,
    /// 0 or more
    pub length: f64,
    /// mean distance of the surface, above 0; NAN: not known
    pub radius: f64,
}

/// A style as plain numbers, in the units of its model; NAN: not known. Product mode transfers what is from
/// head_half_width on, paper mode the bones.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefStyleNumbers {
    /// sizeof(SdefStyleNumbers)
    pub struct_size: u32,
    /// 0
    pub reserved: u32,
    /// how many heads tall; what is read of a style for N heads, else only given
    pub heads: f64,
    /// head joint to head top, above 0
    pub bone_head_length: f64,
    /// heights of landmarks along up, model space
    pub crown: f64,
    /// height
    pub chin: f64,
    /// height
    pub shoulder_line: f64,
    /// height
    pub crotch: f64,
    /// height
    pub sole: f64,
    /// chin to crown
    pub head_length: f64,
    /// half the head's width
    pub head_half_width: f64,
    /// shoulder line to chin
    pub neck: f64,
    /// crotch to shoulder line
    pub torso: f64,
    /// shoulder to wrist
    pub arm: f64,
    /// sole to crotch
    pub leg: f64,
    /// sole to ankle
    pub ankle_height: f64,
    /// wrist to finger tips
    pub hand: f64,
    /// heel to toe
    pub foot: f64,
    /// median half width of the trunk
    pub trunk_half_width: f64,
    /// mean distance of the surface to the bone
    pub upper_arm_radius: f64,
    /// likewise
    pub lower_arm_radius: f64,
    /// likewise
    pub upper_leg_radius: f64,
    /// likewise
    pub lower_leg_radius: f64,
}

/// A style of so many heads.
///
/// heads: 1.8 to 6, crown to sole over crown to chin
/// like:  a style with everything below its head stretched or shortened; the handle 0: everything after the target
///
/// Errors: BAD_OPTION; BAD_STYLE where like has no proportions.
#[ffi_export]
pub unsafe extern "C" fn sdef_style_from_heads(
    heads: f64,
    like: SdefStyle,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { style::from_heads(heads, like, style, error) }
}

/// A built-in style, or a saved one.
///
/// text: "sd2", "sd2.5", "sd3" or "sd4"; or the JSON that sdef_style_to_json gave
/// size: bytes of text, without any NUL
///
/// Errors: BAD_STYLE.
#[ffi_export]
pub unsafe extern "C" fn sdef_style_from_text(
    text: *const c_char,
    size: usize,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { style::from_text(text, size, style, error) }
}

/// Measures a super-deformed character, so that others can be made like it. It needs a skeleton or a made rig.
///
/// name:    of the style; may be NULL
/// options: NULL for the defaults; mode, rays, bone_groups and thread_count are read
///
/// Errors: BAD_OPTION, NO_HUMANOID, NO_GEOMETRY.
#[ffi_export]
pub unsafe extern "C" fn sdef_style_measure(
    character: SdefCharacter,
    name: *const c_char,
    options: *const SdefOptions,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { style::measure(character, name, options, style, error) }
}

/// A style from numbers, as sdef_style_get_numbers gives them.
///
/// name: of the style; may be NULL
///
/// Errors: BAD_STYLE for numbers out of their range.
#[ffi_export]
pub unsafe extern "C" fn sdef_style_from_numbers(
    name: *const c_char,
    numbers: *const SdefStyleNumbers,
    bones: *const SdefBone,
    bone_count: usize,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { style::from_numbers(name, numbers, bones, bone_count, style, error) }
}

/// A style between two, measured in heads.
///
/// amount: 0 is first, 1 second; may go beyond
///
/// Errors: BAD_STYLE for a style of N heads that is like none, or where the result would be no body; BAD_OPTION.
#[ffi_export]
pub unsafe extern "C" fn sdef_style_blend(
    first: SdefStyle,
    second: SdefStyle,
    amount: f64,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { style::blend(first, second, amount, style, error) }
}

/// Gives a style's numbers back.
///
/// numbers:    may be NULL
/// bones:      in the order of their ends, the head's last
/// capacity:   bones that the array can hold
/// bone_count: receives how many there are; may be NULL
#[ffi_export]
pub unsafe extern "C" fn sdef_style_get_numbers(
    style: SdefStyle,
    numbers: *mut SdefStyleNumbers,
    bones: *mut SdefBone,
    capacity: usize,
    bone_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { style::get_numbers(style, numbers, bones, capacity, bone_count, error) }
}

/// Gives a style as JSON text, to be saved.
///
/// text:     receives the text
/// capacity: bytes that text can hold
/// size:     receives the bytes needed, the terminating NUL among them; may be NULL
///
/// Errors: BAD_STYLE for a style of N heads that is like none: save the number.
#[ffi_export]
pub unsafe extern "C" fn sdef_style_to_json(
    style: SdefStyle,
    text: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { style::to_json(style, text, capacity, size, error) }
}
