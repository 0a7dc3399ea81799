//! The character
//!
//! Meshes and joints in rest pose: the pose in which vertices and joints fit together, best with arms out (T or A pose).

use super::arrays::{self, Output, not_null, write_out};
use super::basics::*;
use super::guard::{Failure, Outcome, call};
use super::handles::{self, Object};
use super::memory;
use crate::character::mesh::place;
use crate::character::{Character, Mesh, MorphTarget};
use crate::face::eyes::closes_an_eye;
use character_state::CharacterState;
use core::ffi::c_char;
use safer_ffi::prelude::*;
use std::sync::{Arc, RwLock};

pub mod character_state;
pub mod character_types;
pub mod read;

pub use character_types::*;

/// Makes an empty character.
///
/// up:        3 floats, from the feet to the head, of a length from 1e-15 to 1e15; NULL: (0, 1, 0), or for a character
///            without a rig another axis along which it stands as people do
/// forward:   3 floats, the way the face looks, a tenth of a degree or more off up. NULL: found, from left and right
///            limbs where there are joints, else from feet and face. Left and right are told as in right-handed axes: a
///            host with left-handed ones gives forward, and rig_left_handed to sdef_character_rig
/// character: receives the handle
///
/// Errors: BAD_ARGUMENT, BAD_INPUT.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_create(
    up: *const f32,
    forward: *const f32,
    character: *mut SdefCharacter,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        not_null("character", character)?;
        let state = CharacterState::new(read::axes(up, forward)?);
        let id = handles::insert(Object::Character(Arc::new(RwLock::new(state))))?;
        write_out(character, SdefCharacter { id });
        Ok(())
    };
    unsafe { call(error, body) }
}

/// Gives a character its joints, in place of any that it had. Comes before meshes with weights, which name joints.
///
/// Errors: BAD_ARGUMENT; BAD_INPUT with the joint as the element: a parent that is none, a circle of parents, a number
/// that is not finite, a matrix row by row, a joint that is given two roles; BAD_INPUT without one for a role whose
/// joint is none; or weights of a mesh for a joint that is no more.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_set_skeleton(
    character: SdefCharacter,
    skeleton: *const SdefSkeleton,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let (skeleton, roles) = read::skeleton(skeleton)?;
        handles::write(&state, "character")?.set_skeleton(skeleton, roles)
    };
    unsafe { call(error, body) }
}

/// Adds a mesh; everything is copied. A rig made before goes: it did not know this mesh.
///
/// index: receives the mesh's index, counted from 0; may be NULL
///
/// Errors: BAD_ARGUMENT; BAD_INPUT with the vertex or triangle as the element; OUT_OF_MEMORY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_add_mesh(
    character: SdefCharacter,
    mesh: *const SdefMesh,
    index: *mut u32,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let given = arrays::struct_in(mesh)?;
        let (index_to_be, image) = {
            let state = handles::read(&state, "character")?;
            (state.character().meshes.len(), state.image(given.image))
        };
        let mesh = read::mesh_at(index_to_be, &given, image)?;
        let added = handles::write(&state, "character")?.add_mesh(mesh)?;
        write_out(index, added as u32);
        Ok(())
    };
    unsafe { call(error, body) }
}

/// Adds an image that meshes show, before these meshes; it is copied.
///
/// number: receives what SdefMesh's image names it by, counted from 1
///
/// Errors: BAD_ARGUMENT; OUT_OF_MEMORY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_add_image(
    character: SdefCharacter,
    image: *const SdefImage,
    number: *mut u32,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        not_null("number", number)?;
        let image = read::image(&arrays::struct_in(image)?)?;
        let added = handles::write(&state, "character")?.add_image(image)?;
        write_out(number, added);
        Ok(())
    };
    unsafe { call(error, body) }
}

/// Says what the host knows of the face, in place of what was said before.
///
/// Errors: BAD_ARGUMENT; BAD_INPUT for numbers that are not finite, and sizes below 0; OUT_OF_MEMORY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_set_face_hints(
    character: SdefCharacter,
    hints: *const SdefFaceHints,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let hints = read::face_hints(&arrays::struct_in(hints)?)?;
        handles::write(&state, "character")?.change(|character| character.face_hints = hints)
    };
    unsafe { call(error, body) }
}

/// Adds a morph target to a mesh, after those that it has.
///
/// Errors: BAD_ARGUMENT also for a mesh that is none; BAD_INPUT with the vertex as the element; OUT_OF_MEMORY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_add_morph_target(
    character: SdefCharacter,
    mesh: u32,
    target: *const SdefMorphTarget,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let given = arrays::struct_in(target)?;
        let mut state = handles::write(&state, "character")?;
        let known = state.character();
        let index = mesh as usize;
        let mesh = mesh_of(&known, index)?;
        let count = mesh.positions.len();
        let deltas = |what, start, stride| arrays::optional(what, start, count, stride);
        if count > 0 && given.positions.is_null() {
            return Err(Failure::argument(format!(
                "positions is NULL, but {count} are needed: give the array"
            )));
        }
        let target = MorphTarget {
            name: arrays::text(given.name),
            positions: deltas("positions", given.positions, given.position_stride)?,
            normals: deltas("normals", given.normals, given.normal_stride)?,
            tangents: deltas("tangents", given.tangents, given.tangent_stride)?,
        };
        let checked = target.check(mesh.morph_targets.len(), count);
        checked.map_err(|fault| mesh.error(index, fault))?;
        // Released, so that the change need not copy the character.
        drop(known);
        state.change(|character| character.meshes[index].morph_targets.push(target))
    };
    unsafe { call(error, body) }
}

/// Tells whether morph targets of this name say something of the character to the library, as blinks say where the eyes
/// open. 1: add them to the character (sdef_character_add_morph_target). 0: that is not needed;
/// sdef_deformer_map_morph_targets maps them as well.
///
/// name: NULL is none
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_morph_target_is_read(name: *const c_char) -> u32 {
    u32::from(closes_an_eye(&unsafe { arrays::text(name) }))
}

/// Counts what a character holds.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_get_info(
    character: SdefCharacter,
    info: *mut SdefCharacterInfo,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let state = handles::read(&state, "character")?;
        let own = state.character();
        let whole = state.rigged().unwrap_or(&own);
        let value = SdefCharacterInfo {
            struct_size: 0,
            mesh_count: own.meshes.len() as u32,
            joint_count: whole.skeleton.joints.len() as u32,
            own_joint_count: own.skeleton.joints.len() as u32,
            morph_target_count: own.meshes.iter().map(|mesh| mesh.morph_targets.len()).sum::<usize>() as u32,
            rig_made: u32::from(state.rigged().is_some()),
            vertex_count: own.vertex_count() as u64,
            triangle_count: own.triangle_count() as u64,
        };
        arrays::struct_out(info, &value)
    };
    unsafe { call(error, body) }
}

/// Gives the joints back: own ones first, then those of a made rig, parents in any order.
///
/// parents:       the parent of each joint, or -1
/// roles:         SDEF_ROLE_* as given, guessed or made, or SDEF_NONE
/// rest_matrices: 16 doubles a joint
/// confidence:    0 to 1; below 0.5 a made joint was placed by ratio or is doubtful; 1 for given and own joints
/// capacity:      joints that each array can hold
/// joint_count:   receives how many joints there are; may be NULL
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_get_joints(
    character: SdefCharacter,
    parents: *mut i32,
    roles: *mut u32,
    rest_matrices: *mut f64,
    confidence: *mut f64,
    capacity: usize,
    joint_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let ready = handles::read(&state, "character")?.ready();
        let whole = ready.character();
        let joints = &whole.skeleton.joints;
        let count = joints.len();
        write_out(joint_count, count);
        let parents = Output::new("parents", parents, count, capacity, 0)?;
        let roles = Output::new("roles", roles, count, capacity, 0)?;
        let rests = Output::<[f64; 16]>::new("rest_matrices", rest_matrices.cast(), count, capacity, 0)?;
        let confidence = Output::new("confidence", confidence, count, capacity, 0)?;
        parents.write_each(joints.iter().map(|joint| joint.parent.map_or(-1, |parent| parent as i32)));
        let mut role_of = vec![SDEF_NONE; count];
        for (role, joint) in whole.humanoid.iter() {
            if role_of[joint] == SDEF_NONE {
                role_of[joint] = role as u32;
            }
        }
        roles.write_all(&role_of);
        rests.write_each(joints.iter().map(|joint| joint.rest.to_cols_array()));
        let mut sure = vec![1.0; count];
        if let Some((rig, _)) = &ready.rigged {
            let own = ready.own.skeleton.joints.len();
            sure[own..].copy_from_slice(&rig.confidence);
        }
        confidence.write_all(&sure);
        Ok(())
    };
    unsafe { call(error, body) }
}

/// Gives the weights that animate one mesh: those of a made rig, else its own.
///
/// influence_count: joints a vertex, 1 to 255: the largest weights, largest first, scaled to sum 1; what a vertex has no
///                  use for is joint 0 with weight 0
/// joints, weights: influence_count numbers a vertex
/// capacity:        vertices that each array can hold
///
/// Errors: BAD_ARGUMENT also for a mesh that is none; BAD_INPUT for a mesh without weights.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_get_weights(
    character: SdefCharacter,
    mesh: u32,
    influence_count: u32,
    joints: *mut u32,
    weights: *mut f32,
    capacity: usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let ready = handles::read(&state, "character")?.ready();
        let index = mesh as usize;
        let mesh = mesh_of(&ready.own, index)?;
        let most = influence_count as usize;
        if !(1..=255).contains(&most) {
            return Err(Failure::argument(format!("influence_count is {most}: give 1 to 255")));
        }
        let (all, first) = match &ready.rigged {
            Some((rig, _)) => (&rig.skin_weights[index], ready.own.skeleton.joints.len() as u32),
            None => (&mesh.weights, 0),
        };
        let count = mesh.positions.len();
        if all.is_empty() && count > 0 {
            return Err(Failure::input(format!(
                "{} has no weights: give it some, or call sdef_character_rig",
                place(index, &mesh.name)
            ))
            .in_mesh(index));
        }
        for (what, is_asked) in [("joints", !joints.is_null()), ("weights", !weights.is_null())] {
            if is_asked && capacity < count {
                let message = format!(
                    "{what} can hold {capacity} vertices, but the mesh has {count}: give a larger array"
                );
                return Err(Failure::new(SDEF_STATUS_BUFFER_TOO_SMALL, message).in_mesh(index));
            }
        }
        let numbers = count.saturating_mul(most);
        let joints = Output::new("joints", joints, numbers, numbers, 0)?;
        let weights = Output::new("weights", weights, numbers, numbers, 0)?;
        let limited = memory::with(numbers.saturating_mul(8), 1, || Ok(all.limited(most)))?;
        let entry = |vertex: usize, influence: usize| limited.row(vertex).get(influence).copied();
        let entries = || (0..count).flat_map(|vertex| (0..most).map(move |influence| (vertex, influence)));
        joints.write_each(entries().map(|(v, i)| entry(v, i).map_or(0, |(joint, _)| joint + first)));
        weights.write_each(entries().map(|(v, i)| entry(v, i).map_or(0.0, |(_, weight)| weight)));
        Ok(())
    };
    unsafe { call(error, body) }
}

/// A mesh by its index.
///
/// # Errors
/// BAD_ARGUMENT where there is none.
pub fn mesh_of(character: &Character, mesh: usize) -> Outcome<&Mesh> {
    let count = character.meshes.len();
    character.meshes.get(mesh).ok_or_else(|| {
        Failure::argument(format!("there is no mesh {mesh}: the character has {count}, counted from 0"))
    })
}
