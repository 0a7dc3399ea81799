//! From a character to its joints: how it stands, the way it looks, what its meshes depict, where its joints are.

use super::candidates::Place;
use super::facing::find_forward;
use super::far::gathered;
use super::joints::{DOUBTFUL, FoundJoints, find_joints};
use super::mesh_kinds::{Surroundings, guess_kinds};
use super::solid::{CELLS, FEW_CELLS};
use super::{RigOptions, UnitFigure};
use crate::character::mesh_list::MeshList;
use crate::character::{Character, MeshKind, Role};
use crate::error::{ErrorKind, Result, Warning};
use crate::progress::Progress;
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Left limb joints by which, with those of the right, it is judged whether a character stands.
const LIMBS: [Role; 6] = {
    use Role::*;
    [LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftUpperArm, LeftLowerArm, LeftHand]
};
/// The first try is this much of the progress: it is nearly always the only one.
const STANDING: f32 = 0.8;
/// A joint of at least this confidence is trusted: below it a person is told.
pub const TRUSTED: f64 = 0.5;
/// A character half of whose limb joints are seen stands: no other way is tried.
const STANDS: usize = 6;
/// Another way up has so many more limb joints to be taken: a leg and an arm.
const MORE: usize = 6;

/// A character that is laid out, with its joints.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Its meshes in one space.
    pub figure: UnitFigure,
    /// From the feet to the head, model space.
    pub up: DVec3,
    /// The way it looks, model space.
    pub forward: DVec3,
    /// What each mesh depicts, guessed before joints were known.
    pub kinds: Vec<MeshKind>,
    /// What that was guessed from.
    pub surroundings: Surroundings,
    /// Its joints, in the figure's space.
    pub found: FoundJoints,
    /// Where else each joint may be that is doubted, the figure's space: the place that was taken, then the likeliest.
    pub candidates: BTreeMap<Role, Vec<Place>>,
    /// What a person should know.
    pub warnings: Vec<Warning>,
}

impl Placed {
    /// Lays `character` out and finds its joints.
    ///
    /// Where nobody said which way is up, and hardly a limb is seen, the character is turned with each axis up in turn,
    /// and stands the way in which most limbs are seen: the warning `up_guessed` says so.
    ///
    /// # Errors
    /// `NoGeometry` where nothing has an extent along up; `Cancelled`.
    pub fn of(character: &Character, options: &RigOptions, progress: &mut Progress) -> Result<Self> {
        let gathered = gathered(character);
        let character = gathered.as_ref();
        let first = Self::standing(character, options, CELLS, &mut progress.part(0.0, STANDING));
        if first.as_ref().is_err_and(|error| error.kind == ErrorKind::Cancelled) {
            return first;
        }
        let seen = first.as_ref().map_or(0, Self::seen_count);
        let is_open =
            !character.axes.up_is_known && character.axes.forward.is_none() && options.given.is_empty();
        if !is_open || first.as_ref().is_ok_and(Self::stands) {
            progress.at(1.0)?;
            return first.map(Self::doubted);
        }
        let up = character.axes.up.normalize_or(Vec3::Y);
        let mut turned = character.clone();
        let mut stand = |up: Vec3, cells: f64| {
            turned.axes.up = up;
            let placed = Self::standing(&turned, options, cells, &mut Progress::none()).ok()?;
            let count = placed.seen_count();
            (count >= seen + MORE).then_some((count, placed))
        };
        let mut best: Option<(usize, Vec3)> = None;
        let others = [Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Y, Vec3::X, Vec3::NEG_X, Vec3::Y];
        for (index, other) in others.into_iter().enumerate() {
            progress.at(STANDING + (1.0 - STANDING) * index as f32 / others.len() as f32)?;
            if other.dot(up) > 0.99 {
                continue;
            }
            if let Some((count, _)) = stand(other, FEW_CELLS)
                && best.is_none_or(|(most, _)| count > most)
            {
                best = Some((count, other));
            }
        }
        // Looked at closely, limbs must show as well.
        let best = best.and_then(|(_, other)| stand(other, CELLS));
        progress.at(1.0)?;
        let Some((_, mut best)) = best else { return first.map(Self::doubted) };
        let message = format!(
            "the character stands as people do with {} up, not {}: if that is wrong, say which way is up",
            axis_name(best.up),
            axis_name(up.as_dvec3())
        );
        best.warnings.push(Warning::new("up_guessed", message).about("up"));
        Ok(best.doubted())
    }

    /// How many limb joints are seen.
    fn seen_count(&self) -> usize {
        LIMBS.iter().flat_map(|&role| [role, role.mirrored()]).filter(|role| self.sees(role)).count()
    }

    fn sees(&self, role: &Role) -> bool {
        self.found.joints.get(role).is_some_and(|joint| joint.confidence >= TRUSTED)
    }

    /// True where half of its limb joints are seen, and ankles among them: what seem to be arms of someone who lies may be
    /// legs, or locks of hair.
    fn stands(&self) -> bool {
        let feet = [Role::LeftFoot, Role::RightFoot];
        self.seen_count() >= STANDS && feet.iter().any(|role| self.sees(role))
    }

    /// Doubts all joints that were not given where front and back may be swapped.
    fn doubted(mut self) -> Self {
        if self.warnings.iter().any(|warning| warning.code == "facing_guessed") {
            self.found.candidates.swap_sides(&self.found.joints);
            for joint in self.found.joints.values_mut().filter(|joint| joint.confidence < 1.0) {
                joint.confidence = joint.confidence.min(DOUBTFUL);
            }
        }
        self.candidates = self.found.candidates.of_doubted(&self.found.joints, TRUSTED);
        self
    }

    /// As [`Placed::of`], of a character that stands as its axes say; `cells` of the solid are as high as it is.
    ///
    /// Where it may look one of two ways, it is the one in which more limbs are seen.
    fn standing(
        character: &Character,
        options: &RigOptions,
        cells: f64,
        progress: &mut Progress,
    ) -> Result<Self> {
        let ways = find_forward(character);
        progress.at(0.2)?;
        let count = ways.len() as f32;
        let part = |index: usize| 0.2 + 0.8 * index as f32 / count;
        let placed = ways.into_iter().enumerate().map(|(index, (forward, warnings))| {
            let progress = &mut progress.part(part(index), part(index + 1));
            Self::looking(character, forward, warnings, options, cells, progress)
        });
        let placed: Vec<Self> = placed.collect::<Result<_>>()?;
        placed.into_iter().reduce(Self::or_turned).ok_or_else(MeshList::no_extent)
    }

    /// The one of two ways to look in which more limbs are seen, with the joints of the other one as candidates.
    fn or_turned(self, other: Self) -> Self {
        let (mut best, other) =
            if other.seen_count() > self.seen_count() { (other, self) } else { (self, other) };
        let score = (1 + other.seen_count()) as f64 / (1 + best.seen_count()) as f64;
        for (&role, joint) in &other.found.joints {
            let position = best.figure.to_unit(other.figure.to_model(joint.position));
            best.found.candidates.add(role, position, score);
        }
        best
    }

    fn looking(
        character: &Character,
        forward: DVec3,
        mut warnings: Vec<Warning>,
        options: &RigOptions,
        cells: f64,
        progress: &mut Progress,
    ) -> Result<Self> {
        let figure = UnitFigure::in_axes(character, forward, options.left_handed)?;
        progress.at(0.25)?;
        let (kinds, kind_warnings, surroundings) =
            guess_kinds(&figure, options.thread_count, &mut progress.part(0.25, 0.5))?;
        warnings.extend(kind_warnings);
        let given = options.given.iter().map(|(&role, &at)| (role, figure.to_unit(at))).collect();
        let mut found = find_joints(
            &figure,
            &kinds,
            &given,
            options.fingers,
            cells,
            options.thread_count,
            &mut progress.part(0.5, 1.0),
        )?;
        warnings.append(&mut found.warnings);
        progress.at(1.0)?;
        let up = character.axes.up.as_dvec3().normalize_or(DVec3::Y);
        let candidates = BTreeMap::new();
        Ok(Self { figure, up, forward, kinds, surroundings, found, candidates, warnings })
    }
}

/// An axis as the command line names it.
fn axis_name(up: DVec3) -> &'static str {
    let names =
        [("+X", DVec3::X), ("-X", DVec3::NEG_X), ("+Y", DVec3::Y), ("-Y", DVec3::NEG_Y), ("+Z", DVec3::Z)];
    names.into_iter().find(|(_, axis)| axis.dot(up) > 0.99).map_or("-Z", |(name, _)| name)
}
