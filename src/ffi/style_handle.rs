//! Styles: what a character should become
//!
//! A style is numbers, not a model: it can be saved, mixed, and used with any character.

use super::arrays::{self, Input, host_structs, not_null, write_out};
use super::basics::*;
use super::guard::{Failure, Outcome, call};
use super::handles::{self, Object};
use super::memory;
use super::options::{self, SdefOptions, known};
use crate::character::Role;
use crate::character::bones::HEAD_TOP;
use crate::error::Named;
use crate::options::table;
use crate::shape::body_shape::FaceStyle;
use crate::shape::product::anatomy::Proportions;
use crate::shape::style::BUILT_IN;
use crate::shape::style::Style;
use crate::shape::{BodyShape, BoneShape, Heights, Measured};
use core::ffi::c_char;
use safer_ffi::prelude::*;
use std::sync::Arc;

/// SdefBone.end of the bone from the head joint to the top of the head.
pub const SDEF_BONE_HEAD_TOP: u32 = 55;

/// One bone of a measured body.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SdefBone {
    /// sizeof(SdefBone)
    pub struct_size: u32,
    /// SDEF_ROLE_* at its end, or SDEF_BONE_HEAD_TOP
    pub end: u32,
    /// 0 or more
    pub length: f64,
    /// mean distance of the surface, above 0; NAN: not known
    pub radius: f64,
}
host_structs!(SdefBone);

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
    /// how many heads tall. It makes a style that is nothing but a number of heads; of others it is told, and not read
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
    /// half the torso's breadth, the median of its slices
    pub torso_half_width: f64,
    /// its radius, the median of its slices
    pub upper_arm_radius: f64,
    /// likewise
    pub lower_arm_radius: f64,
    /// likewise
    pub upper_leg_radius: f64,
    /// likewise
    pub lower_leg_radius: f64,
    /// the eyes' height above the chin over head_length, 0 to 1
    pub eye_height: f64,
    /// square root of half an eye's width by half its height, over head_length, 0 to 0.5
    pub eye_size: f64,
    /// half the head's depth; product mode transfers it too
    pub head_half_depth: f64,
}
host_structs!(SdefStyleNumbers(reserved) = UNKNOWN);

/// A style of so many heads.
///
/// heads: 1.8 to 6, crown to sole over crown to chin
/// like:  the style whose body it takes, stretched or shortened below the head until that is so many heads; the handle
///        0: the body follows from the number and from each target's own. The built-in ones ("sd2.5") are fixed bodies
///
/// Errors: BAD_OPTION; BAD_STYLE where like has no proportions.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_style_from_heads(
    heads: f64,
    like: SdefStyle,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    let make = || {
        let plain = Style::heads(heads)?;
        if like.id == 0 {
            return Ok(plain);
        }
        match &*handles::style(like)? {
            Style::Heads(_) => Ok(plain),
            Style::Shape(like) if like.proportions.is_none() => Err(bad(format!(
                "the style {} holds no proportions to stretch: measure its model again",
                Named(&like.name)
            ))),
            Style::Shape(like) => valid(like.with_heads(heads)),
        }
    };
    unsafe { give(style, error, make) }
}

/// A built-in style, or a saved one.
///
/// text: "sd2", "sd2.5", "sd3" or "sd4"; or the JSON that sdef_style_to_json gave
/// size: bytes of text, without a NUL at its end: strlen(text)
///
/// Errors: BAD_STYLE.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_style_from_text(
    text: *const c_char,
    size: usize,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    let make = || unsafe {
        let bytes = Input::<u8>::new("text", text.cast(), size, 0)?.to_vec("bytes of text")?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            bad(format!("the style's text is no UTF-8 at byte {at}: give what sdef_style_to_json gave"))
        })?;
        if let Some(at) = text.find('\0') {
            let message = format!("the style's text holds a NUL at byte {at}: give strlen(text) as its size");
            return Err(Failure::argument(message));
        }
        let made = match BodyShape::built_in(text.trim()) {
            Some(shape) => shape,
            None if !text.trim_start().starts_with('{') => {
                return Err(bad(format!(
                    "\"{}\" is neither a saved style nor one of {}: give one of them",
                    Named(&text),
                    BUILT_IN.join(", ")
                )));
            }
            None => BodyShape::from_json(&text)?,
        };
        Ok(shape(made))
    };
    unsafe { give(style, error, make) }
}

/// Measures a super-deformed character, so that others can be made like it. It needs a skeleton or a made rig.
///
/// name:    of the style; may be NULL
/// options: NULL for the defaults; mode, rays, bone_groups and thread_count are read
///
/// Errors: BAD_OPTION, NO_HUMANOID, NO_GEOMETRY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_style_measure(
    character: SdefCharacter,
    name: *const c_char,
    options: *const SdefOptions,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    let make = || unsafe {
        let state = handles::character(character)?;
        let (options, _) = options::read(options)?;
        options.validate()?;
        let ready = handles::read(&state, "character")?.ready();
        let character = ready.character();
        let study = memory::with(memory::to_measure(character), options.thread_count, || {
            Ok(Measured::of(character, &options)?)
        });
        let study = study.map_err(|failure| ready.explained(failure))?;
        Ok(shape(BodyShape { name: arrays::text(name), ..study.shape }))
    };
    unsafe { give(style, error, make) }
}

/// A style from numbers, as sdef_style_get_numbers gives them.
/// Its slices are those of a body of so many heads: measured ones go as text (sdef_style_to_json).
///
/// name: of the style; may be NULL
///
/// Errors: BAD_STYLE for numbers out of their range.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_style_from_numbers(
    name: *const c_char,
    numbers: *const SdefStyleNumbers,
    bones: *const SdefBone,
    bone_count: usize,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    let make = || unsafe {
        let given = arrays::struct_in(numbers)?;
        let bones = arrays::structs_in("bones", bones, bone_count)?;
        if bone_count == 0 && given.bone_head_length.is_nan() && given.head_length.is_nan() {
            return Ok(Style::heads(given.heads)?);
        }
        let mut made = BodyShape {
            name: arrays::text(name),
            head_length: given.bone_head_length,
            landmarks: given.landmarks(),
            proportions: given.proportions(),
            face: known(given.eye_height)
                .zip(known(given.eye_size))
                .map(|(eye_height, eye_size)| FaceStyle { eye_height, eye_size }),
            ..BodyShape::default()
        };
        for (index, bone) in bones.iter().enumerate() {
            let at = |failure: Failure| failure.at(SDEF_ELEMENT_BONE, index);
            let name = match bone.end {
                SDEF_BONE_HEAD_TOP => HEAD_TOP,
                end => options::role(&format!("bones {index}"), end).map_err(at)?.name(),
            };
            let measured = BoneShape { length: bone.length, radius: known(bone.radius) };
            if made.bones.insert(name.to_string(), measured).is_some() {
                return Err(at(bad(format!("bones {index} ends at {name} again: give each end once"))));
            }
        }
        valid(made)
    };
    unsafe { give(style, error, make) }
}

/// A style between two, measured in heads.
///
/// amount: 0 is first, 1 second; 0 to 1
///
/// Errors: BAD_STYLE where one of the two is nothing but a number of heads and the other is not, or where the result
/// would be no body; BAD_OPTION.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_style_blend(
    first: SdefStyle,
    second: SdefStyle,
    amount: f64,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    let make = || {
        let (first, second) = (handles::style(first)?, handles::style(second)?);
        table::option("blend").check(amount)?;
        match (&*first, &*second) {
            (Style::Heads(first), Style::Heads(second)) => {
                Ok(Style::heads(first + amount * (second - first))?)
            }
            (Style::Shape(first), Style::Shape(second)) => valid(first.blended(second, amount)),
            _ => Err(bad(
                "one style is nothing but a number of heads, the other a body: give the other as like to sdef_style_from_heads, and blend with what that makes",
            )),
        }
    };
    unsafe { give(style, error, make) }
}

/// Gives a style's numbers back.
///
/// numbers:    may be NULL
/// bones:      in the order of their ends, the head's last; struct_size of the first is set before; may be NULL
/// capacity:   bones that the array can hold
/// bone_count: receives how many there are; may be NULL
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_style_get_numbers(
    style: SdefStyle,
    numbers: *mut SdefStyleNumbers,
    bones: *mut SdefBone,
    capacity: usize,
    bone_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let style = handles::style(style)?;
        arrays::check_struct_out(numbers)?;
        let known = bones_of(&style);
        write_out(bone_count, known.len());
        arrays::structs_out("bones", bones, capacity, &known)?;
        if numbers.is_null() {
            return Ok(());
        }
        arrays::struct_out(numbers, &numbers_of(&style))
    };
    unsafe { call(error, body) }
}

/// Gives a style as JSON text, to be saved.
///
/// text:     receives the text
/// capacity: bytes that text can hold
/// size:     receives the bytes needed, the terminating NUL among them; may be NULL
///
/// Errors: BAD_STYLE for a style that is nothing but a number of heads: save the number.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_style_to_json(
    style: SdefStyle,
    text: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        match &*handles::style(style)? {
            Style::Heads(heads) => Err(bad(format!(
                "a style of {heads} heads, like no other, has no body to save: save the number"
            ))),
            Style::Shape(shape) => arrays::text_out(&shape.to_json(), text, capacity, size),
        }
    };
    unsafe { call(error, body) }
}

fn bad(message: impl Into<String>) -> Failure {
    Failure::new(SDEF_STATUS_BAD_STYLE, message)
}

/// Gives the style that `make` makes a handle, and writes how it ended.
///
/// # Safety
/// As [`call`]; `to` is NULL or can be written.
unsafe fn give(
    to: *mut SdefStyle,
    error: *mut SdefError,
    make: impl FnOnce() -> Outcome<Style>,
) -> SdefStatus {
    let body = || {
        not_null("style", to)?;
        let id = handles::insert(Object::Style(Arc::new(make()?)))?;
        unsafe { write_out(to, SdefStyle { id }) };
        Ok(())
    };
    unsafe { call(error, body) }
}

/// A style of a body whose numbers are in their ranges.
fn valid(made: BodyShape) -> Outcome<Style> {
    made.validate()?;
    Ok(shape(made))
}

fn shape(shape: BodyShape) -> Style {
    Style::Shape(Box::new(shape))
}

/// What [`SdefStyleNumbers`] has under the same names as the library: heights of landmarks, proportions, and proportions that
/// may not be known beside them.
macro_rules! style_numbers {
    ($($height:ident)+; $($proportion:ident)+; $($optional:ident)+) => {
        const UNKNOWN: SdefStyleNumbers = SdefStyleNumbers {
            struct_size: 0,
            reserved: 0,
            heads: f64::NAN,
            bone_head_length: f64::NAN,
            eye_height: f64::NAN,
            eye_size: f64::NAN,
            $($height: f64::NAN,)+
            $($proportion: f64::NAN,)+
            $($optional: f64::NAN,)+
        };

        impl SdefStyleNumbers {
            fn landmarks(&self) -> Option<Heights> {
                known(self.crown).map(|_| Heights { $($height: self.$height),+ })
            }

            fn proportions(&self) -> Option<Proportions> {
                known(self.head_length).map(|_| Proportions {
                    $($proportion: self.$proportion,)+
                    $($optional: known(self.$optional),)+
                })
            }

            fn set_landmarks(&mut self, landmarks: &Heights) {
                $(self.$height = landmarks.$height;)+
            }

            fn set_proportions(&mut self, proportions: &Proportions) {
                $(self.$proportion = proportions.$proportion;)+
                $(self.$optional = proportions.$optional.unwrap_or(f64::NAN);)+
            }
        }
    };
}
style_numbers!(
    crown chin shoulder_line crotch sole;
    head_length head_half_width neck torso arm leg ankle_height;
    head_half_depth hand foot torso_half_width upper_arm_radius lower_arm_radius upper_leg_radius lower_leg_radius
);

fn numbers_of(style: &Style) -> SdefStyleNumbers {
    let shape = match style {
        Style::Heads(heads) => return SdefStyleNumbers { heads: *heads, ..UNKNOWN },
        Style::Shape(shape) => shape,
    };
    let mut numbers = SdefStyleNumbers {
        heads: shape.heads().unwrap_or(f64::NAN),
        bone_head_length: shape.head_length,
        ..UNKNOWN
    };
    if let Some(FaceStyle { eye_height, eye_size }) = shape.face {
        numbers = SdefStyleNumbers { eye_height, eye_size, ..numbers };
    }
    if let Some(landmarks) = &shape.landmarks {
        numbers.set_landmarks(landmarks);
    }
    if let Some(proportions) = &shape.proportions {
        numbers.set_proportions(proportions);
    }
    numbers
}

fn bones_of(style: &Style) -> Vec<SdefBone> {
    let Style::Shape(shape) = style else { return Vec::new() };
    let ends = Role::all().map(|role| (role as u32, role.name()));
    ends.chain([(SDEF_BONE_HEAD_TOP, HEAD_TOP)])
        .filter_map(|(end, name)| shape.bones.get(name).map(|bone| (end, bone)))
        .map(|(end, bone)| SdefBone {
            struct_size: 0,
            end,
            length: bone.length,
            radius: bone.radius.unwrap_or(f64::NAN),
        })
        .collect()
}
