//! What stands behind a handle of a deformer, and where its results go.

use super::deformer_types::SdefMeshResult;
use crate::character::Character;
use crate::character::mesh::place;
use crate::error::Warning;
use crate::ffi::arrays::{Output, Structs};
use crate::ffi::basics::SDEF_STATUS_BUFFER_TOO_SMALL;
use crate::ffi::character::character_state::Ready;
use crate::ffi::guard::{self, Failure, Outcome};
use crate::ffi::memory;
use crate::options::Options;
use crate::pipeline::morphs::SparseTarget;
use crate::pipeline::places::MeshPlaces;
use crate::pipeline::{Deformer, MeshOutputs};
use crate::progress::Progress;
use crate::report::Report;
use crate::shape::style::Style;
use glam::{Vec3, Vec4};
use std::fmt;
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
        });
        let deformer = deformer.map_err(|failure| ready.explained(failure))?;
        let notes = if ready.rigged.is_some() { Vec::new() } else { ready.warnings.clone() };
        Ok(Self { deformer, notes, report: OnceLock::new() })
    }

    /// The deformer.
    pub fn deformer(&self) -> &Deformer {
        &self.deformer
    }

    /// Changes its options; after an error it is as it was.
    pub fn set_options(&mut self, options: &Options, progress: &mut Progress) -> Outcome {
        let bytes = memory::to_change_options(&self.deformer, options);
        self.change(bytes, options.thread_count, |deformer| deformer.set_options(options, progress))
    }

    /// Changes its style; after an error it is as it was.
    pub fn set_style(&mut self, style: &Style, progress: &mut Progress) -> Outcome {
        let threads = self.deformer.options().thread_count;
        let bytes = memory::to_change_style(self.deformer.character());
        self.change(bytes, threads, |deformer| deformer.set_style(style, progress))
    }

    fn change(
        &mut self,
        bytes: usize,
        threads: usize,
        change: impl FnOnce(&mut Deformer) -> crate::Result<()>,
    ) -> Outcome {
        memory::with(bytes, threads, || Ok(change(&mut self.deformer)?))?;
        self.report = OnceLock::new();
        Ok(())
    }

    /// All warnings so far, a line each: those of the report once there is one.
    pub fn warnings(&self) -> String {
        match self.report.get() {
            Some(report) => guard::lines(report.warnings.iter()),
            None => guard::lines(self.notes.iter().chain(self.deformer.warnings())),
        }
    }

    /// The numbers of the run, measured where that was not done since the last change.
    pub fn report(&self, progress: &mut Progress) -> Outcome<&Report> {
        if let Some(report) = self.report.get() {
            progress.at(1.0)?;
            return Ok(report);
        }
        let bytes = memory::to_report(self.deformer.character());
        let threads = self.deformer.options().thread_count;
        let mut report = memory::with(bytes, threads, || {
            let deformed = self.deformer.apply_with(&mut progress.part(0.0, 0.2))?;
            Ok(self.deformer.report_with(&deformed, &mut progress.part(0.2, 1.0))?)
        })?;
        report.warnings.splice(0..0, self.notes.iter().cloned());
        for warning in &mut report.warnings {
            warning.message = guard::with_field(&warning.message, warning.option.take());
        }
        Ok(self.report.get_or_init(|| report))
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
    pub unsafe fn apply(&self, results: &Structs<SdefMeshResult>, progress: &mut Progress) -> Outcome {
        let character = self.deformer.character();
        self.check_count(results.len())?;
        let places = |index: usize| {
            unsafe { Places::new(character, index, &results.get(index)?) }
                .map_err(|error| error.in_mesh(index))
        };
        // All are checked before anything is written.
        let mut asked = MeshOutputs::default();
        for index in 0..results.len() {
            let outputs = places(index)?.outputs();
            asked.normals |= outputs.normals;
            asked.tangents |= outputs.tangents;
            asked.morph_targets |= outputs.morph_targets;
        }
        let bytes = if self.deformer.apply_allocates(asked) { memory::to_apply(character) } else { 0 };
        memory::with(bytes, self.deformer.options().thread_count, || {
            let checked = |index| places(index).expect("it was checked");
            let mut targets = Vec::new();
            if asked.morph_targets {
                let is_asked = |index| checked(index).outputs().morph_targets;
                targets = self.deformer.deformed_targets(is_asked, &mut progress.part(0.0, 0.8))?;
            }
            let all = (0..results.len()).map(|index| checked(index).of_mesh());
            self.deformer.apply_into(all, &mut progress.part(0.8, 1.0))?;
            for (index, targets) in targets.iter().enumerate() {
                checked(index).write_targets(targets);
            }
            Ok(())
        })
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
        let name = |what| Named { index, mesh: &mesh.name, what };
        unsafe {
            let vectors = |what, start: *mut f32, stride| {
                Output::<Vec3>::new(name(what), start.cast(), count, capacity, stride)
            };
            let positions = vectors("positions", result.positions, result.position_stride)?;
            let normals = vectors("normals", result.normals, result.normal_stride)?;
            let (tangents, stride) = (result.tangents.cast(), result.tangent_stride);
            let tangents = Output::new(name("tangents"), tangents, count, capacity, stride)?;
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
            let is_asked = starts.iter().any(|(_, start)| !start.is_null());
            for target in 0..if is_asked { targets } else { 0 } {
                let mut places = [Output::none(); 3];
                for (place, (what, start)) in places.iter_mut().zip(starts) {
                    if !start.is_null() {
                        *place = vectors(what, start.wrapping_add(3 * target * count), 0)?;
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

    /// Where the library writes.
    fn of_mesh(&self) -> MeshPlaces<Output<Vec3>, Output<Vec4>> {
        MeshPlaces {
            positions: self.positions.is_given().then_some(self.positions),
            normals: self.normals.is_given().then_some(self.normals),
            tangents: self.tangents.is_given().then_some(self.tangents),
        }
    }

    fn write_targets(&self, targets: &[SparseTarget]) {
        for (target, places) in targets.iter().zip(&self.morphs) {
            for (place, deltas) in places.iter().zip(&target.deltas) {
                place.write_sparse(&target.vertices, deltas.as_deref().unwrap_or_default(), Vec3::ZERO);
            }
        }
    }
}

/// An array in sentences, put together when there is something to say.
struct Named<'a> {
    index: usize,
    mesh: &'a str,
    what: &'a str,
}

impl fmt::Display for Named<'_> {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        write!(to, "{}: {}", place(self.index, self.mesh), self.what)
    }
}
