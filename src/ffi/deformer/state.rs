//! What stands behind a handle of a deformer, and where its results go.

use super::types::SdefMeshResult;
use crate::character::Character;
use crate::character::mesh::place;
use crate::error::Warning;
use crate::ffi::arrays::{self, Output};
use crate::ffi::basics::SDEF_STATUS_BUFFER_TOO_SMALL;
use crate::ffi::character::state::Ready;
use crate::ffi::guard::{self, Failure, Outcome};
use crate::ffi::memory;
use crate::options::Options;
use crate::pipeline::{Deformed, Deformer, MeshOutputs, Style};
use crate::progress::Progress;
use crate::report::Report;
use glam::{Vec3, Vec4};
use std::sync::OnceLock;

/// A deformer behind a handle.
pub struct DeformerState {
    deformer: Deformer,
    /// Warnings about the character's roles.
    notes: Vec<Warning>,
    /// Made when it is first asked for, gone with every change.
    report: OnceLock<Report>,
}

impl DeformerState {
    /// Gives a character a style.
    pub fn new(ready: &Ready, style: &Style, options: &Options, progress: &mut Progress) -> Outcome<Self> {
        let bytes = memory::to_deform(ready.character());
        let deformer = memory::with(bytes, options.thread_count, || match &ready.rigged {
            Some((rig, rigged)) => {
                Ok(Deformer::with_rigged(rigged.clone(), &ready.own, rig, style, options, progress)?)
            }
            None => Ok(Deformer::with_progress(ready.own.clone(), style, options, progress)?),
        })?;
        let notes = if ready.rigged.is_some() { Vec::new() } else { ready.warnings.clone() };
        Ok(Self { deformer, notes, report: OnceLock::new() })
    }

    /// The deformer.
    pub fn deformer(&self) -> &Deformer {
        &self.deformer
    }

    /// Changes its options; after an error it is as it was.
    pub fn set_options(&mut self, options: &Options, progress: &mut Progress) -> Outcome {
        let bytes = memory::to_deform(self.deformer.character());
        memory::with(bytes, options.thread_count, || Ok(self.deformer.set_options(options, progress)?))?;
        self.report = OnceLock::new();
        Ok(())
    }

    /// All warnings so far.
    pub fn warnings(&self) -> impl Iterator<Item = &Warning> {
        self.notes.iter().chain(self.deformer.warnings())
    }

    /// The numbers of the run.
    pub fn report(&self) -> Outcome<&Report> {
        if self.report.get().is_none() {
            let bytes = memory::to_report(self.deformer.character());
            let threads = self.deformer.options().thread_count;
            let mut report =
                memory::with(bytes, threads, || Ok(self.deformer.report(&self.deformer.apply())?))?;
            report.warnings.splice(0..0, self.notes.iter().cloned());
            for warning in &mut report.warnings {
                warning.message = guard::with_field(&warning.message, warning.option.take());
            }
            return Ok(self.report.get_or_init(|| report));
        }
        Ok(self.report.get().expect("it is there"))
    }

    /// Checks that there is a result for each mesh.
    pub fn check_count(&self, mesh_count: usize) -> Outcome {
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
        let threads = self.deformer.options().thread_count;
        let deformed = memory::with(memory::to_apply(character), threads, || {
            Ok(self.deformer.apply_to(&outputs, progress)?)
        })?;
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
        let lacks = |what: &str, asked: bool, has: bool| {
            if asked && !has && count > 0 {
                return Err(Failure::argument(format!(
                    "{}: {what} are asked for, but it was given none: leave the array NULL",
                    place(index, &mesh.name)
                )));
            }
            Ok(())
        };
        lacks("normals", !result.normals.is_null(), !mesh.normals.is_empty())?;
        lacks("tangents", !result.tangents.is_null(), !mesh.tangents.is_empty())?;
        let name = |what: &str| format!("{}: {what}", place(index, &mesh.name));
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
            normals: self.normals.is_given(),
            tangents: self.tangents.is_given(),
            morph_targets: self.morphs.iter().flatten().any(Output::is_given),
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
                if deltas.is_empty() {
                    place.write_each(std::iter::repeat_n(Vec3::ZERO, count));
                } else {
                    place.write(deltas);
                }
            }
        }
    }
}
