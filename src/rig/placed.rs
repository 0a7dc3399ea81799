//! From a character to its joints: the way it looks, what its meshes depict, where its joints are.

use super::facing::find_forward;
use super::joints::{FoundJoints, find_joints};
use super::mesh_kinds::guess_kinds;
use super::{RigOptions, UnitFigure};
use crate::character::{Character, MeshKind};
use crate::error::{Result, Warning};
use crate::progress::Progress;
use glam::DVec3;

/// A character that is laid out, with its joints.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Its meshes in one space.
    pub figure: UnitFigure,
    /// The way it looks, model space.
    pub forward: DVec3,
    /// What each mesh depicts, guessed before joints were known.
    pub kinds: Vec<MeshKind>,
    /// Its joints, in the figure's space.
    pub found: FoundJoints,
    /// What a person should know.
    pub warnings: Vec<Warning>,
}

impl Placed {
    /// Lays `character` out and finds its joints.
    ///
    /// # Errors
    /// `NoGeometry` where nothing has an extent along up; `Cancelled`.
    pub fn of(character: &Character, options: &RigOptions, progress: &mut Progress) -> Result<Self> {
        let (forward, mut warnings) = find_forward(character);
        progress.at(0.2)?;
        let figure = UnitFigure::in_axes(character, forward, options.left_handed)?;
        progress.at(0.4)?;
        let (kinds, kind_warnings) = guess_kinds(&figure);
        warnings.extend(kind_warnings);
        let given = options.given.iter().map(|(&role, &at)| (role, figure.to_unit(at))).collect();
        let guessed: Vec<Option<MeshKind>> = kinds.iter().copied().map(Some).collect();
        let mut found = find_joints(
            &figure,
            &guessed,
            &given,
            options.fingers,
            options.thread_count,
            &mut progress.part(0.4, 1.0),
        )?;
        warnings.append(&mut found.warnings);
        progress.at(1.0)?;
        Ok(Self { figure, forward, kinds, found, warnings })
    }
}
