//! What stands behind a handle of a character.

use crate::character::kinds::{MeshNames, kinds_from_names};
use crate::character::mesh::place;
use crate::character::roles::find_roles;
use crate::character::{Axes, Character, GreyImage, Humanoid, Mesh, Skeleton};
use crate::error::Warning;
use crate::ffi::basics::SDEF_STATUS_NO_HUMANOID;
use crate::ffi::guard::{Failure, Outcome};
use crate::ffi::memory;
use crate::parallel::lock;
use crate::pipeline::Rig;
use crate::progress::Progress;
use crate::rig::RigOptions;
use std::sync::{Arc, Mutex, PoisonError};

/// A character behind a handle.
pub struct CharacterState {
    resolved: Mutex<Resolved>,
    /// The roles that the host gave.
    given: Humanoid,
    /// By mesh: whether the host left open what it is.
    kind_is_open: Vec<bool>,
    /// What meshes show.
    images: Vec<Arc<GreyImage>>,
    /// What was made, and the character with it in place.
    rig: Option<(Arc<Rig>, Arc<Character>)>,
    /// True where a made rig went as the character changed.
    rig_went: bool,
}

/// A character whose roles, and kinds of meshes, are found when they are first asked for: until then meshes may still
/// come.
struct Resolved {
    character: Arc<Character>,
    warnings: Vec<Warning>,
    roles_found: bool,
}

/// What a study or a deformer needs of a character.
pub struct Ready {
    /// With its own rig.
    pub own: Arc<Character>,
    /// With a made rig in place.
    pub rigged: Option<(Arc<Rig>, Arc<Character>)>,
    /// Warnings about the roles.
    pub warnings: Vec<Warning>,
    rig_went: bool,
}

impl Ready {
    /// The character to work with.
    pub fn character(&self) -> &Arc<Character> {
        self.rigged.as_ref().map_or(&self.own, |(_, rigged)| rigged)
    }

    /// Says of joints that are missing that a rig was made, and why it is none any more.
    pub fn explained(&self, mut failure: Failure) -> Failure {
        if failure.status == SDEF_STATUS_NO_HUMANOID && self.rigged.is_none() && self.rig_went {
            failure.message += "; the rig that was made went when the character changed: make it again";
        }
        failure
    }
}

impl CharacterState {
    /// An empty one.
    pub fn new(axes: Axes) -> Self {
        let character = Arc::new(Character { axes, ..Character::default() });
        let resolved = Resolved { character, warnings: Vec::new(), roles_found: false };
        Self {
            resolved: Mutex::new(resolved),
            given: Humanoid::default(),
            kind_is_open: Vec::new(),
            images: Vec::new(),
            rig: None,
            rig_went: false,
        }
    }

    /// Changes the character; what was found before does not count any more. A deformer keeps it as it was, in a copy whose
    /// memory is asked for first.
    pub fn change(&mut self, change: impl FnOnce(&mut Character)) -> Outcome {
        let resolved = self.resolved.get_mut().unwrap_or_else(PoisonError::into_inner);
        if Arc::strong_count(&resolved.character) > 1 {
            memory::with(memory::to_copy(&resolved.character), 1, || Ok(()))?;
        }
        change(Arc::make_mut(&mut resolved.character));
        resolved.roles_found = false;
        resolved.warnings.clear();
        self.rig_went |= self.rig.take().is_some();
        Ok(())
    }

    /// The character with its own rig; its roles may not be found yet.
    pub fn character(&self) -> Arc<Character> {
        lock(&self.resolved).character.clone()
    }

    /// The character with the rig that was made for it.
    pub fn rigged(&self) -> Option<&Arc<Character>> {
        self.rig.as_ref().map(|(_, rigged)| rigged)
    }

    /// The character with its roles.
    pub fn ready(&self) -> Ready {
        let mut resolved = lock(&self.resolved);
        if !resolved.roles_found {
            let mut humanoid = self.given.clone();
            if !humanoid.missing().is_empty() && !resolved.character.skeleton.joints.is_empty() {
                let character = &resolved.character;
                let (found, warnings) = find_roles(&character.skeleton, &character.meshes, character.axes.up);
                for (role, joint) in found.iter() {
                    if !humanoid.has(role) && humanoid.iter().all(|(_, taken)| taken != joint) {
                        humanoid.set(role, joint);
                    }
                }
                resolved.warnings = warnings;
            }
            if resolved.character.humanoid != humanoid {
                Arc::make_mut(&mut resolved.character).humanoid = humanoid;
            }
            self.guess_kinds(&mut resolved.character);
            resolved.roles_found = true;
        }
        Ready {
            own: resolved.character.clone(),
            rigged: self.rig.clone(),
            warnings: resolved.warnings.clone(),
            rig_went: self.rig_went,
        }
    }

    /// Reads from their names what the meshes are that the host left open.
    fn guess_kinds(&self, character: &mut Arc<Character>) {
        let names: Vec<MeshNames> =
            character.meshes.iter().map(|mesh| MeshNames::of_path(&mesh.name)).collect();
        for (index, kind) in kinds_from_names(character, &names).into_iter().enumerate() {
            if self.kind_is_open[index] && character.meshes[index].kind != kind {
                Arc::make_mut(character).meshes[index].kind = kind;
            }
        }
    }

    /// Gives it joints; its meshes must fit them.
    pub fn set_skeleton(&mut self, skeleton: Skeleton, roles: Humanoid) -> Outcome {
        let count = skeleton.joints.len();
        for (index, mesh) in self.character().meshes.iter().enumerate() {
            let checked = mesh.weights.check(mesh.positions.len(), count);
            checked.map_err(|fault| mesh.error(index, fault))?;
        }
        self.change(|character| {
            character.skeleton = skeleton;
            character.humanoid = roles.clone();
        })?;
        self.given = roles;
        Ok(())
    }

    /// Adds an image, and gives its number.
    pub fn add_image(&mut self, image: GreyImage) -> Outcome<u32> {
        self.images.push(Arc::new(image));
        u32::try_from(self.images.len())
            .map_err(|_| Failure::argument("the character has 4294967295 images already: give fewer"))
    }

    /// The image of this number; none of 0.
    pub fn image(&self, number: u32) -> Outcome<Option<Arc<GreyImage>>> {
        match (number as usize).checked_sub(1) {
            None => Ok(None),
            Some(index) => self.images.get(index).cloned().map(Some).ok_or_else(|| {
                let count = self.images.len();
                Failure::argument(format!(
                    "image is {number}, but the character has {count}: give what sdef_character_add_image gave, or 0"
                ))
            }),
        }
    }

    /// Adds a mesh, and gives its index.
    pub fn add_mesh(&mut self, mesh: Mesh) -> Outcome<usize> {
        let character = self.character();
        let index = character.meshes.len();
        if !mesh.weights.is_empty() && character.skeleton.joints.is_empty() {
            let message =
                "has weights, but the character has no joints: call sdef_character_set_skeleton first";
            return Err(Failure::input(format!("{} {message}", place(index, &mesh.name))).in_mesh(index));
        }
        mesh.validate(index, character.skeleton.joints.len())?;
        let vertices = character.vertex_count() + mesh.positions.len();
        if vertices >= u32::MAX as usize {
            let message = format!("with it the character has {vertices} vertices: give at most 4294967294");
            return Err(mesh.error(index, (None, message)).into());
        }
        // Released, so that the change need not copy the character.
        drop(character);
        let kind_is_open = mesh.kind.is_none();
        self.change(|character| character.meshes.push(mesh))?;
        self.kind_is_open.push(kind_is_open);
        Ok(index)
    }

    /// Makes a rig.
    pub fn make_rig(&mut self, options: &RigOptions, progress: &mut Progress) -> Outcome {
        let own = self.ready().own;
        memory::with(memory::to_rig(&own), options.thread_count, || {
            let rig = Rig::with_progress(&own, options, progress)?;
            let rigged = Arc::new(rig.applied_to(&own));
            self.rig = Some((Arc::new(rig), rigged));
            Ok(())
        })
    }
}
