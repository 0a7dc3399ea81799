//! Deformers: results into the caller's arrays.

use super::arrays::{self, Input, Output, tell, wanted};
use super::bodies::teller;
use super::character::Ready;
use super::exports::basics::*;
use super::exports::deformer::*;
use super::exports::options::SdefOptions;
use super::guard::{self, Failure, Outcome, call};
use super::table::{self, Object};
use crate::character::Character;
use crate::error::Warning;
use crate::options::Options;
use crate::pipeline::{Deformed, Deformer, MeshOutputs, Style};
use crate::progress::Progress;
use crate::report::{FigureReport, Report};
use crate::shape::GroupShape;
use core::ffi::{c_char, c_void};
use glam::{DVec3, Vec3, Vec4};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock, RwLock};

/// A deformer behind a handle.
pub struct DeformerState {
    deformer: Deformer,
    /// What is to be known about the character's roles.
    notes: Vec<Warning>,
    /// Made when it is first asked for, gone with every change.
    report: OnceLock<Report>,
}

impl DeformerState {
    /// Gives a character a style.
    pub fn new(ready: &Ready, style: &Style, options: &Options, progress: &mut Progress) -> Outcome<Self> {
        let deformer = match &ready.rigged {
            Some((rig, rigged)) => {
                Deformer::with_rigged(rigged.clone(), &ready.own, rig, style, options, progress)
            }
            None => Deformer::with_progress(ready.own.clone(), style, options, progress),
        }?;
        let notes = if ready.rigged.is_some() { Vec::new() } else { ready.warnings.clone() };
        Ok(Self { deformer, notes, report: OnceLock::new() })
    }

    /// Everything to be known so far.
    pub fn warnings(&self) -> impl Iterator<Item = &Warning> {
        self.notes.iter().chain(self.deformer.warnings())
    }

    fn report(&self) -> Outcome<&Report> {
        if self.report.get().is_none() {
            let mut report = self.deformer.report(&self.deformer.apply())?;
            report.warnings.splice(0..0, self.notes.iter().cloned());
            for warning in &mut report.warnings {
                warning.message = guard::in_words_of_hosts(&warning.message);
            }
            return Ok(self.report.get_or_init(|| report));
        }
        Ok(self.report.get().expect("it is there"))
    }

    /// Checks that there is a result for each mesh.
    fn check_count(&self, mesh_count: usize) -> Outcome {
        let count = self.deformer.character().meshes.len();
        if mesh_count != count {
            return Err(Failure::argument(format!(
                "mesh_count is {mesh_count}, but the character has {count} meshes: give one struct for each"
            )));
        }
        Ok(())
    }

    /// Deforms into the caller's arrays.
    ///
    /// # Safety
    /// The structs and their arrays are as the header says.
    pub unsafe fn apply(&self, results: &[SdefMeshResult], progress: &mut Progress) -> Outcome {
        let character = self.deformer.character();
        self.check_count(results.len())?;
        let mut places = arrays::reserved(results.len(), "results")?;
        for (index, result) in results.iter().enumerate() {
            places.push(
                unsafe { Places::new(character, index, result) }.map_err(|error| error.in_mesh(index))?,
            );
        }
        let outputs: Vec<MeshOutputs> = places.iter().map(Places::outputs).collect();
        let deformed = self.deformer.apply_to(&outputs, progress)?;
        for (index, places) in places.iter().enumerate() {
            places.write(&deformed, index);
        }
        Ok(())
    }
}

/// Where the results of a mesh go, checked.
struct Places {
    positions: Output<Vec3>,
    normals: Output<Vec3>,
    tangents: Output<Vec4>,
    /// Positions, normals and tangents of each morph target.
    morphs: Vec<[Output<Vec3>; 3]>,
}

impl Places {
    unsafe fn new(character: &Character, index: usize, result: &SdefMeshResult) -> Outcome<Self> {
        let mesh = &character.meshes[index];
        let (count, capacity) = (mesh.positions.len(), result.vertex_capacity);
        let lacks = |what: &str, wanted: bool, has: bool| match wanted && !has && count > 0 {
            true => Err(Failure::argument(format!(
                "mesh {index} ({}): {what} are wanted, but it was given none: leave the array NULL",
                mesh.name
            ))),
            false => Ok(()),
        };
        lacks("normals", !result.normals.is_null(), !mesh.normals.is_empty())?;
        lacks("tangents", !result.tangents.is_null(), !mesh.tangents.is_empty())?;
        let name = |what: &str| format!("mesh {index} ({}): {what}", mesh.name);
        unsafe {
            let positions = Output::new(
                name("positions"),
                result.positions.cast(),
                count,
                capacity,
                result.position_stride,
            )?;
            let normals =
                Output::new(name("normals"), result.normals.cast(), count, capacity, result.normal_stride)?;
            let tangents = Output::new(
                name("tangents"),
                result.tangents.cast(),
                count,
                capacity,
                result.tangent_stride,
            )?;
            let targets = mesh.morph_targets.len();
            let mut morphs = Vec::new();
            let starts = [
                ("morph_positions", result.morph_positions),
                ("morph_normals", result.morph_normals),
                ("morph_tangents", result.morph_tangents),
            ];
            for (what, start) in starts {
                lacks(what, !start.is_null(), targets > 0)?;
                if !start.is_null() && (result.morph_target_capacity as usize) < targets {
                    return Err(Failure::new(
                        SDEF_STATUS_BUFFER_TOO_SMALL,
                        format!(
                            "{} can hold {} morph targets, but the mesh has {targets}: give a larger array",
                            name(what),
                            result.morph_target_capacity
                        ),
                    ));
                }
            }
            for target in 0..targets {
                let mut places = [Output::none(); 3];
                for (place, (what, start)) in places.iter_mut().zip(starts) {
                    if !start.is_null() {
                        let start = start.cast::<Vec3>().wrapping_add(target * count);
                        *place = Output::new(name(what), start, count, capacity, 0)?;
                    }
                }
                morphs.push(places);
            }
            Ok(Self { positions, normals, tangents, morphs })
        }
    }

    fn outputs(&self) -> MeshOutputs {
        MeshOutputs {
            normals: self.normals.is_wanted(),
            tangents: self.tangents.is_wanted(),
            morph_targets: self.morphs.iter().flatten().any(Output::is_wanted),
        }
    }

    fn write(&self, deformed: &Deformed, index: usize) {
        let mesh = &deformed.meshes[index];
        let count = mesh.positions.len();
        self.positions.write(&mesh.positions);
        self.normals.write(&mesh.normals);
        self.tangents.write(&mesh.tangents);
        for (target, places) in mesh.morph_targets.iter().zip(&self.morphs) {
            for (place, deltas) in places.iter().zip([&target.positions, &target.normals, &target.tangents]) {
                match deltas.is_empty() {
                    true => place.write_each(std::iter::repeat_n(Vec3::ZERO, count)),
                    false => place.write(deltas),
                }
            }
        }
    }
}

/// The body of `sdef_deformer_create`.
pub unsafe fn create(
    character: SdefCharacter,
    style: SdefStyle,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    deformer: *mut SdefDeformer,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        wanted("deformer", deformer)?;
        let character = table::character(character)?;
        let style = table::style(style)?;
        let (options, _) = super::options::read(options)?;
        let mut teller = teller(progress, user);
        // The character is free again from here on: what is read of it is ours.
        let ready = table::read(&character, "character")?.ready();
        let state = DeformerState::new(&ready, &style, &options, &mut Progress::new(&mut teller))?;
        let id = table::insert(Object::Deformer(Arc::new(RwLock::new(state))))?;
        tell(deformer, SdefDeformer { id });
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_deformer_set_options`.
pub unsafe fn set_options(
    deformer: SdefDeformer,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::deformer(deformer)?;
        let (options, _) = super::options::read(options)?;
        let mut teller = teller(progress, user);
        let mut state = table::write(&state, "deformer")?;
        state.deformer.set_options(&options, &mut Progress::new(&mut teller))?;
        state.report = OnceLock::new();
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_deformer_set_face`.
pub unsafe fn set_face(deformer: SdefDeformer, squash: f64, curve: u32, error: *mut SdefError) -> SdefStatus {
    let body = || {
        let state = table::deformer(deformer)?;
        let curve = super::options::face_curve(curve)?;
        let mut state = table::write(&state, "deformer")?;
        let options = Options {
            face_squash: (!squash.is_nan()).then_some(squash),
            face_curve: curve,
            ..state.deformer.options().clone()
        };
        state.deformer.set_options(&options, &mut Progress::none())?;
        state.report = OnceLock::new();
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_deformer_apply`.
pub unsafe fn apply(
    deformer: SdefDeformer,
    meshes: *const SdefMeshResult,
    mesh_count: usize,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::deformer(deformer)?;
        let state = table::read(&state, "deformer")?;
        state.check_count(mesh_count)?;
        let results = arrays::structs_in("SdefMeshResult", meshes, mesh_count)?;
        let mut teller = teller(progress, user);
        state.apply(&results, &mut Progress::new(&mut teller))
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_deformer_get_joints`.
pub unsafe fn get_joints(
    deformer: SdefDeformer,
    positions: *mut f64,
    inverse_binds: *mut f64,
    capacity: usize,
    joint_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::deformer(deformer)?;
        let state = table::read(&state, "deformer")?;
        let skeleton = &state.deformer.character().skeleton;
        let count = skeleton.joints.len();
        tell(joint_count, count);
        let places = Output::<[f64; 3]>::new("positions", positions.cast(), count, capacity, 0)?;
        let binds = Output::<[f64; 16]>::new("inverse_binds", inverse_binds.cast(), count, capacity, 0)?;
        let joints = state.deformer.deformed_joints();
        if !inverse_binds.is_null() {
            let mut inverses = arrays::reserved(count, "inverse binds")?;
            for (index, (joint, at)) in skeleton.joints.iter().zip(&joints).enumerate() {
                let mut rest = joint.rest;
                rest.w_axis = at.extend(1.0);
                let inverse = rest.inverse();
                if rest.determinant() == 0.0 || !inverse.is_finite() {
                    let message = format!(
                        "joint {index} ({}): its rest matrix has no inverse: give one that flattens nothing",
                        joint.name
                    );
                    return Err(Failure::input(message).at(index));
                }
                inverses.push(inverse.to_cols_array());
            }
            binds.write(&inverses);
        }
        places.write_each(joints.iter().map(|at| arrays::numbers(*at)));
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_deformer_map_points`.
#[allow(clippy::too_many_arguments)]
pub unsafe fn map_points(
    deformer: SdefDeformer,
    joints: *const u32,
    points: *const f64,
    count: usize,
    positions: *mut f64,
    scales: *mut f64,
    jacobians: *mut f64,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::deformer(deformer)?;
        let state = table::read(&state, "deformer")?;
        let joint_count = state.deformer.character().skeleton.joints.len();
        let joints = Input::new("joints", joints, count, 0)?;
        let points = Input::<[f64; 3]>::new("points", points.cast(), count, 0)?;
        let positions = Output::<[f64; 3]>::new("positions", positions.cast(), count, count, 0)?;
        let scales = Output::new("scales", scales, count, count, 0)?;
        let jacobians = Output::<[f64; 9]>::new("jacobians", jacobians.cast(), count, count, 0)?;
        let mut mapped = arrays::reserved(count, "points")?;
        for (index, (joint, point)) in joints.iter().zip(points.iter()).enumerate() {
            let point = DVec3::from_array(point);
            if joint as usize >= joint_count {
                return Err(Failure::input(format!(
                    "point {index} hangs from joint {joint}, but there are {joint_count} joints: name one of them"
                ))
                .at(index));
            }
            if !point.is_finite() {
                let message = format!("point {index} is at {point}: points must be finite numbers");
                return Err(Failure::input(message).at(index));
            }
            mapped.push(state.deformer.map(joint as usize, point));
        }
        positions.write_each(mapped.iter().map(|point| arrays::numbers(point.position)));
        scales.write_each(mapped.iter().map(|point| point.local_scale()));
        jacobians.write_each(mapped.iter().map(|point| point.jacobian.to_cols_array()));
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_deformer_get_groups`.
pub unsafe fn get_groups(
    deformer: SdefDeformer,
    groups: *mut SdefGroup,
    capacity: usize,
    group_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::deformer(deformer)?;
        let state = table::read(&state, "deformer")?;
        let deformer = &state.deformer;
        let target = deformer.group_shapes(&deformer.target().shape);
        let reference = match deformer.style() {
            Style::Shape(shape) => deformer.group_shapes(shape),
            Style::Heads(_) => BTreeMap::new(),
        };
        let mut names: Vec<&String> = deformer.coefficients().keys().chain(target.keys()).collect();
        names.sort_unstable();
        names.dedup();
        tell(group_count, names.len());
        let places = Output::new("groups", groups, names.len(), capacity, 0)?;
        let sizes = |shape: Option<&GroupShape>| {
            shape.map_or([f64::NAN; 2], |shape| [shape.length, shape.radius.unwrap_or(f64::NAN)])
        };
        places.write_each(names.iter().map(|&name| {
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
                name: text,
                length_scale,
                thickness_scale,
                target_length,
                target_radius,
                reference_length,
                reference_radius,
            }
        }));
        Ok(())
    };
    unsafe { call(error, body) }
}

fn figure(figure: &FigureReport) -> SdefFigure {
    SdefFigure {
        height: figure.height,
        head_length: figure.head_length,
        heads: figure.heads,
        crown: figure.landmarks.crown,
        chin: figure.landmarks.chin,
        shoulder_line: figure.landmarks.shoulder_line,
        crotch: figure.landmarks.crotch,
        sole: figure.landmarks.sole,
    }
}

/// The body of `sdef_deformer_get_report`.
pub unsafe fn get_report(
    deformer: SdefDeformer,
    report: *mut SdefReport,
    json: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    const NO_FIGURE: SdefFigure = SdefFigure {
        height: f64::NAN,
        head_length: f64::NAN,
        heads: f64::NAN,
        crown: f64::NAN,
        chin: f64::NAN,
        shoulder_line: f64::NAN,
        crotch: f64::NAN,
        sole: f64::NAN,
    };
    let body = || unsafe {
        let state = table::deformer(deformer)?;
        arrays::check_struct_out("SdefReport", report)?;
        let state = table::read(&state, "deformer")?;
        let found = state.report()?;
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
            target: figure(&found.target),
            reference: found.reference.as_ref().map_or(NO_FIGURE, figure),
            result: figure(&found.result),
            head_ratio: found.g,
            unreached_vertices: found.rig.unreached_vertices as u64,
            fallback_vertices: found.rig.fallback_vertices.values().sum::<usize>() as u64,
        };
        arrays::struct_out("SdefReport", report, &value)
    };
    unsafe { call(error, body) }
}
