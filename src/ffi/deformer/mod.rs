//! The deformer: made once, applied as often as something changes

use super::arrays::{self, Input, Output, Structs, not_null, write_out};
use super::basics::*;
use super::character::mesh_of;
use super::guard::{self, Failure, Outcome, call, progress_of};
use super::handles::{self, Object};
use super::memory;
use super::options::{self, SdefOptions};
use crate::error::Named;
use crate::geometry::distinct;
use crate::progress::Progress;
use crate::report::FigureReport;
use crate::shape::GroupShape;
use core::ffi::{c_char, c_void};
use deformer_state::DeformerState;
use glam::DVec3;
use safer_ffi::prelude::*;
use std::sync::{Arc, RwLock};
use targets::Deltas;

mod colliders;
pub mod deformer_state;
pub mod deformer_types;
mod targets;

pub use deformer_types::*;

/// Makes the deformation that gives a character a style. What it needs of the character is read before it begins: that
/// may be changed meanwhile.
///
/// options:        NULL for the defaults; rig_* are not read
/// progress, user: see Progress above; user is handed on
/// deformer:       receives the handle
///
/// Errors: BAD_OPTION, BAD_STYLE, NO_HUMANOID, NO_GEOMETRY, CANCELLED.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_create(
    character: SdefCharacter,
    style: SdefStyle,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    deformer: *mut SdefDeformer,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        not_null("deformer", deformer)?;
        let character = handles::character(character)?;
        let style = handles::style(style)?;
        let (options, _) = options::read(options)?;
        let mut callback = progress_of(progress, user);
        // The character is free again from here on: what is read of it is ours.
        let ready = handles::read(&character, "character")?.ready();
        let state = DeformerState::new(&ready, &style, &options, &mut Progress::new(&mut callback))?;
        let id = handles::insert(Object::Deformer(Arc::new(RwLock::new(state))))?;
        write_out(deformer, SdefDeformer { id });
        Ok(())
    };
    unsafe { call(error, body) }
}

/// Changes the options of a deformer, with the same results as a new one and for less: only what depends on the change
/// is done again. For sliders.
///
/// Errors: as sdef_deformer_create, after which the deformer is as it was; BUSY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_set_options(
    deformer: SdefDeformer,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::deformer(deformer)?;
        let (options, _) = options::read(options)?;
        let mut callback = progress_of(progress, user);
        handles::write(&state, "deformer")?.set_options(&options, &mut Progress::new(&mut callback))
    };
    unsafe { call(error, body) }
}

/// Changes the style of a deformer, with the same results as a new one and for less: the character is not measured
/// again.
///
/// Errors: as sdef_deformer_create, after which the deformer is as it was; BUSY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_set_style(
    deformer: SdefDeformer,
    style: SdefStyle,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || {
        let state = handles::deformer(deformer)?;
        let style = handles::style(style)?;
        let mut callback = progress_of(progress, user);
        handles::write(&state, "deformer")?.set_style(&style, &mut Progress::new(&mut callback))
    };
    unsafe { call(error, body) }
}

/// Deforms the meshes, into the caller's arrays.
///
/// results:        mesh_count structs in the order of the character's meshes, all of one struct_size
/// mesh_count:     as many as the character has
/// progress, user: see Progress above
///
/// Errors: BAD_ARGUMENT, BUFFER_TOO_SMALL with the mesh, OUT_OF_MEMORY, CANCELLED.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_apply(
    deformer: SdefDeformer,
    results: *const SdefMeshResult,
    mesh_count: usize,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = |state: &DeformerState| unsafe {
        state.check_count(mesh_count)?;
        let results = Structs::new("results", results, mesh_count)?;
        state.apply(&results, &mut Progress::new(&mut progress_of(progress, user)))
    };
    unsafe { call_on(deformer, error, body) }
}

/// Gives the joints where they are now, in the order of sdef_character_get_joints. They move, and neither turn nor
/// scale: the new rest matrix is the old one with this translation.
///
/// positions:     3 doubles a joint, model space
/// inverse_binds: 16 doubles a joint, the inverse of the new rest matrix: model space to joint space
/// capacity:      joints that each array can hold
/// joint_count:   receives how many there are; may be NULL
///
/// Errors: BAD_INPUT where inverse_binds is asked for and a rest matrix has no inverse.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_get_joints(
    deformer: SdefDeformer,
    positions: *mut f64,
    inverse_binds: *mut f64,
    capacity: usize,
    joint_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = |state: &DeformerState| unsafe {
        let skeleton = &state.deformer().character().skeleton;
        let count = skeleton.joints.len();
        write_out(joint_count, count);
        let places = Output::<[f64; 3]>::new("positions", positions.cast(), count, capacity, 0)?;
        let binds = Output::<[f64; 16]>::new("inverse_binds", inverse_binds.cast(), count, capacity, 0)?;
        let joints = state.deformer().deformed_joints();
        if !inverse_binds.is_null() {
            let mut inverses = arrays::reserved(count, "inverse binds")?;
            for (index, (joint, at)) in skeleton.joints.iter().zip(&joints).enumerate() {
                let mut rest = joint.rest;
                rest.w_axis = at.extend(1.0);
                let inverse = rest.inverse();
                if rest.determinant() == 0.0 || !inverse.is_finite() {
                    let message = format!(
                        "joint {index} ({}): its rest matrix has no inverse: give one that flattens nothing",
                        Named(&joint.name)
                    );
                    return Err(Failure::input(message).at(SDEF_ELEMENT_JOINT, index));
                }
                inverses.push(inverse.to_cols_array());
            }
            binds.write_all(&inverses);
        }
        places.write_each(joints.iter().map(|at| at.to_array()));
        Ok(())
    };
    unsafe { call_on(deformer, error, body) }
}

/// Maps points that move with joints: colliders, eyes, viewpoints, the tails of springs.
///
/// joints:    the joint that each point moves with
/// points:    3 doubles a point, model space
/// count:     points; every array holds as many
/// positions: receives 3 doubles a point, model space
/// scales:    receives a number a point: by how much small things there grow (the radius of a collider)
/// jacobians: receives 9 doubles a point, column by column: how directions and lengths there change
///
/// Errors: BAD_INPUT with the point as the element.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_map_points(
    deformer: SdefDeformer,
    joints: *const u32,
    points: *const f64,
    count: usize,
    positions: *mut f64,
    scales: *mut f64,
    jacobians: *mut f64,
    error: *mut SdefError,
) -> SdefStatus {
    let body = |state: &DeformerState| unsafe {
        let deformer = state.deformer();
        let joints = Input::new("joints", joints, count, 0)?;
        let points = Input::<[f64; 3]>::new("points", points.cast(), count, 0)?;
        let positions = Output::<[f64; 3]>::new("positions", positions.cast(), count, count, 0)?;
        let scales = Output::new("scales", scales, count, count, 0)?;
        let jacobians = Output::<[f64; 9]>::new("jacobians", jacobians.cast(), count, count, 0)?;
        let mut mapped = arrays::reserved(count, "points")?;
        for (index, (joint, point)) in joints.iter().zip(points.iter()).enumerate() {
            let point = DVec3::from_array(point);
            let failed = |message| Failure::input(message).at(SDEF_ELEMENT_POINT, index);
            colliders::check_joint(deformer, &format_args!("point {index}"), joint).map_err(failed)?;
            if !point.is_finite() {
                return Err(failed(format!("point {index} is at {point}: points must be finite numbers")));
            }
            mapped.push(deformer.map(joint as usize, point));
        }
        positions.write_each(mapped.iter().map(|point| point.position.to_array()));
        scales.write_each(mapped.iter().map(|point| point.local_scale()));
        jacobians.write_each(mapped.iter().map(|point| point.jacobian.to_cols_array()));
        Ok(())
    };
    unsafe { call_on(deformer, error, body) }
}

/// Maps colliders of springs: their points go as map_points has it, and they are as thick as the mesh around them, a
/// capsule across its axis. One that a spring would start nearer to than it was, or deeper in, yields by a fifth of its
/// radius at most. Distances count for the spring's size, and no further than its own radius.
///
/// colliders:    count structs, all of one struct_size
/// springs:      spring_count structs, all of one struct_size: what colliders may name
/// results:      receives count structs, struct_size of the first is set before; may be colliders
///
/// Errors: BAD_INPUT with the collider as the element (SDEF_ELEMENT_COLLIDER), or the spring (SDEF_ELEMENT_POINT).
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_map_colliders(
    deformer: SdefDeformer,
    colliders: *const SdefCollider,
    count: usize,
    springs: *const SdefSpringBall,
    spring_count: usize,
    results: *mut SdefCollider,
    error: *mut SdefError,
) -> SdefStatus {
    let body = |state: &DeformerState| unsafe {
        let deformer = state.deformer();
        let given = arrays::structs_in("colliders", colliders, count)?;
        let springs = colliders::springs_of(deformer, arrays::structs_in("springs", springs, spring_count)?)?;
        let mut mapped = arrays::reserved(count, "colliders")?;
        for (index, collider) in given.iter().enumerate() {
            mapped.push(colliders::map(deformer, index, collider, &springs)?);
        }
        if count > 0 {
            arrays::structs_out("results", results, count, &mapped)?;
        }
        Ok(())
    };
    unsafe { call_on(deformer, error, body) }
}

/// Maps morph targets of a mesh, in place and only where they change something; they need not be the character's own.
/// The results are those of an apply. For hosts with more targets than there is memory for all of them at once.
///
/// mesh:          the mesh that they are of
/// vertex_counts: how many vertices each target changes
/// count:         targets
/// vertices:      those of each target, ascending, one target after the other
/// positions:     3 floats for each of these: what is added at weight 1, read and written
/// normals:       likewise, of meshes that were given with normals; NULL where the targets have none
/// tangents:      likewise
///
/// Errors: BAD_ARGUMENT also for a mesh that is none; BAD_INPUT with the vertex as the element; OUT_OF_MEMORY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_map_morph_targets(
    deformer: SdefDeformer,
    mesh: u32,
    vertex_counts: *const u32,
    count: usize,
    vertices: *const u32,
    positions: *mut f32,
    normals: *mut f32,
    tangents: *mut f32,
    error: *mut SdefError,
) -> SdefStatus {
    let body = |state: &DeformerState| unsafe {
        let deformer = state.deformer();
        let (character, index) = (deformer.character(), mesh as usize);
        let mesh = mesh_of(character, index)?;
        let (counts, vertices) = targets::vertices_of(vertex_counts, count, vertices)?;
        let deltas = Deltas::new([positions, normals, tangents], vertices.len())?;
        deltas.check(index, mesh, &counts, &vertices)?;
        let bytes = memory::to_map_targets(character, vertices.len());
        memory::with(bytes, deformer.options().thread_count, || {
            Ok(deltas.map(deformer, index, &counts, &vertices)?)
        })
    };
    unsafe { call_on(deformer, error, body) }
}

/// Gives what is done to each bone group.
///
/// groups:      struct_size of the first is set before; may be NULL
/// capacity:    groups that the array can hold
/// group_count: receives how many there are; may be NULL
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_get_groups(
    deformer: SdefDeformer,
    groups: *mut SdefGroup,
    capacity: usize,
    group_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = |state: &DeformerState| unsafe {
        let deformer = state.deformer();
        let target = deformer.group_shapes(&deformer.target().shape);
        let reference =
            deformer.style().shape().map(|shape| deformer.group_shapes(shape)).unwrap_or_default();
        let names = distinct(deformer.coefficients().keys().chain(target.keys()));
        write_out(group_count, names.len());
        let sizes = |shape: Option<&GroupShape>| {
            shape.map_or([f64::NAN; 2], |shape| [shape.length, shape.radius.unwrap_or(f64::NAN)])
        };
        let found = names.iter().map(|&name| {
            let [length_scale, thickness_scale] = match deformer.coefficients().get(name) {
                Some(coefficient) => [coefficient.length_scale, coefficient.thickness_scale],
                None => [f64::NAN; 2],
            };
            let [target_length, target_radius] = sizes(target.get(name));
            let [reference_length, reference_radius] = sizes(reference.get(name));
            let mut text = [0; 64];
            for (to, byte) in text.iter_mut().zip(guard::cut(name, 64).bytes()) {
                *to = byte as c_char;
            }
            SdefGroup {
                struct_size: 0,
                reserved: 0,
                name: text,
                length_scale,
                thickness_scale,
                target_length,
                target_radius,
                reference_length,
                reference_radius,
            }
        });
        arrays::structs_out("groups", groups, capacity, &found.collect::<Vec<_>>())
    };
    unsafe { call_on(deformer, error, body) }
}

/// Measures the result, as the first call of sdef_deformer_get_figure or _get_report after a change does, and says how
/// far it is; after it both are for free. It takes as long as an apply and a measurement together.
///
/// progress, user: see Progress above
///
/// Errors: NO_GEOMETRY where the result is too flat to be measured; OUT_OF_MEMORY; CANCELLED.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_measure(
    deformer: SdefDeformer,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body =
        |state: &DeformerState| state.report(&mut Progress::new(&mut progress_of(progress, user))).map(drop);
    unsafe { call_on(deformer, error, body) }
}

/// Gives what was measured on a figure.
///
/// which:  SDEF_FIGURE_*
/// figure: struct_size is set before
///
/// The first call after a change measures the result: sdef_deformer_measure says how far that is.
///
/// Errors: BAD_ARGUMENT; NO_GEOMETRY where the result is too flat to be measured; OUT_OF_MEMORY.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_get_figure(
    deformer: SdefDeformer,
    which: u32,
    figure: *mut SdefFigure,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::deformer(deformer)?;
        arrays::check_struct_out(figure)?;
        let which = options::one_of("which", "SDEF_FIGURE_", which, &[0, 1, 2])?;
        let state = handles::read(&state, "deformer")?;
        let report = state.report(&mut Progress::none())?;
        let asked = match which {
            SDEF_FIGURE_TARGET => Some(&report.target),
            SDEF_FIGURE_REFERENCE => report.reference.as_ref(),
            _ => Some(&report.result),
        };
        arrays::struct_out(figure, &figure_of(asked))
    };
    unsafe { call(error, body) }
}

/// Gives the numbers of the run. The first call after a change measures the result: sdef_deformer_measure says how far
/// that is.
///
/// report:   may be NULL
/// json:     receives everything as JSON text, by the keys that README lists: figures, groups, joints, times, warnings.
///           Heads and heights alone: sdef_deformer_get_figure
/// capacity: bytes that json can hold
/// size:     receives the bytes needed, the terminating NUL among them; may be NULL
///
/// Errors: NO_GEOMETRY where the result is too flat to be measured; BUFFER_TOO_SMALL.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_deformer_get_report(
    deformer: SdefDeformer,
    report: *mut SdefReport,
    json: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::deformer(deformer)?;
        arrays::check_struct_out(report)?;
        let state = handles::read(&state, "deformer")?;
        let found = state.report(&mut Progress::none())?;
        let text = serde_json::to_string_pretty(found).map_err(|error| {
            Failure::new(SDEF_STATUS_INTERNAL, format!("the report cannot be written: {error}"))
        })?;
        arrays::text_out(&text, json, capacity, size)?;
        if report.is_null() {
            return Ok(());
        }
        let value = SdefReport {
            struct_size: 0,
            rig_made: u32::from(found.rig.source == "auto"),
            head_ratio: found.g,
            unreached_vertices: found.rig.unreached_vertices as u64,
            fallback_vertices: found.rig.fallback_vertices.values().sum::<usize>() as u64,
        };
        arrays::struct_out(report, &value)
    };
    unsafe { call(error, body) }
}

/// The numbers of a figure, NAN where there is none.
fn figure_of(figure: Option<&FigureReport>) -> SdefFigure {
    let number = |of: fn(&FigureReport) -> f64| figure.map_or(f64::NAN, of);
    SdefFigure {
        struct_size: 0,
        reserved: 0,
        height: number(|figure| figure.height),
        head_length: number(|figure| figure.head_length),
        heads: number(|figure| figure.heads),
        crown: number(|figure| figure.landmarks.crown),
        chin: number(|figure| figure.landmarks.chin),
        shoulder_line: number(|figure| figure.landmarks.shoulder_line),
        crotch: number(|figure| figure.landmarks.crotch),
        sole: number(|figure| figure.landmarks.sole),
    }
}

/// Runs `body` on the deformer of a handle, beside other uses of it, and writes how it ended.
///
/// # Safety
/// As [`call`].
unsafe fn call_on(
    deformer: SdefDeformer,
    error: *mut SdefError,
    body: impl FnOnce(&DeformerState) -> Outcome,
) -> SdefStatus {
    let body = || {
        let state = handles::deformer(deformer)?;
        let state = handles::read(&state, "deformer")?;
        body(&state)
    };
    unsafe { call(error, body) }
}
