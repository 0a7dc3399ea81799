//! Characters: arrays in, joints and weights out.

use super::arrays::{self, Input, Output, reserved, tell, wanted};
use super::exports::basics::*;
use super::exports::character::*;
use super::exports::options::SdefOptions;
use super::guard::{Failure, Outcome, call};
use super::options::one_of;
use super::table::{self, Object};
use crate::character::roles::find_roles;
use crate::character::{
    Axes, Character, Humanoid, Joint, Mesh, MeshKind, MorphTarget, Role, Skeleton, Weights,
};
use crate::error::Warning;
use crate::pipeline::Rig;
use crate::progress::Progress;
use crate::rig::RigOptions;
use core::ffi::c_void;
use glam::Vec3;
use std::sync::{Arc, Mutex, PoisonError, RwLock};

/// A character behind a handle.
pub struct CharacterState {
    resolved: Mutex<Resolved>,
    /// The roles that the host gave.
    given: Humanoid,
    rig: Option<MadeRig>,
}

/// A character whose roles are found when they are first asked for: until then meshes may still come.
struct Resolved {
    character: Arc<Character>,
    warnings: Vec<Warning>,
    roles_found: bool,
}

#[derive(Clone)]
struct MadeRig {
    rig: Arc<Rig>,
    rigged: Arc<Character>,
}

/// What a study or a deformer needs of a character.
pub struct Ready {
    /// With its own rig.
    pub own: Arc<Character>,
    /// With a made rig in place.
    pub rigged: Option<(Arc<Rig>, Arc<Character>)>,
    /// What is to be known about the roles.
    pub warnings: Vec<Warning>,
}

impl Ready {
    /// The character to work with.
    pub fn character(&self) -> &Arc<Character> {
        self.rigged.as_ref().map_or(&self.own, |(_, rigged)| rigged)
    }
}

impl CharacterState {
    /// An empty one.
    pub fn new(axes: Axes) -> Self {
        let character = Arc::new(Character { axes, ..Character::default() });
        let resolved = Resolved { character, warnings: Vec::new(), roles_found: false };
        Self { resolved: Mutex::new(resolved), given: Humanoid::default(), rig: None }
    }

    fn resolved(&mut self) -> &mut Resolved {
        self.resolved.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the character; what was found before does not count any more. A deformer keeps it as it was.
    fn change(&mut self, change: impl FnOnce(&mut Character)) {
        let resolved = self.resolved();
        change(Arc::make_mut(&mut resolved.character));
        resolved.roles_found = false;
        resolved.warnings.clear();
        self.rig = None;
    }

    fn character(&self) -> Arc<Character> {
        self.resolved.lock().unwrap_or_else(PoisonError::into_inner).character.clone()
    }

    /// The character with its roles.
    pub fn ready(&self) -> Ready {
        let mut resolved = self.resolved.lock().unwrap_or_else(PoisonError::into_inner);
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
            resolved.roles_found = true;
        }
        Ready {
            own: resolved.character.clone(),
            rigged: self.rig.as_ref().map(|made| (made.rig.clone(), made.rigged.clone())),
            warnings: resolved.warnings.clone(),
        }
    }

    /// Gives it joints; its meshes must fit them.
    pub fn set_skeleton(&mut self, skeleton: Skeleton, roles: Humanoid) -> Outcome {
        let count = skeleton.joints.len();
        for (index, mesh) in self.character().meshes.iter().enumerate() {
            mesh.weights.validate(mesh.positions.len(), count).map_err(|(vertex, message)| {
                let failure =
                    Failure::input(format!("{}: {message}", place(index, &mesh.name))).in_mesh(index);
                vertex.map_or(failure.clone(), |vertex| failure.at(vertex))
            })?;
        }
        self.given = roles.clone();
        self.change(|character| {
            character.skeleton = skeleton;
            character.humanoid = roles;
        });
        Ok(())
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
            return Err(Failure::input(format!(
                "{}: with it the character has {vertices} vertices: give at most 4294967294",
                place(index, &mesh.name)
            ))
            .in_mesh(index));
        }
        // Released, so that the change need not copy the character.
        drop(character);
        self.change(|character| character.meshes.push(mesh));
        Ok(index)
    }

    /// Makes a rig.
    pub fn make_rig(&mut self, options: &RigOptions, progress: &mut Progress) -> Outcome {
        let own = self.ready().own;
        let rig = Rig::with_progress(&own, options, progress)?;
        let rigged = Arc::new(rig.applied_to(&own));
        self.rig = Some(MadeRig { rig: Arc::new(rig), rigged });
        Ok(())
    }
}

fn place(index: usize, name: &str) -> String {
    if name.is_empty() { format!("mesh {index}") } else { format!("mesh {index} ({name})") }
}

/// Reads the axes.
///
/// # Safety
/// Each is NULL or points to 3 floats.
pub unsafe fn axes(up: *const f32, forward: *const f32) -> Outcome<Axes> {
    let mut axes = Axes::default();
    unsafe {
        if !up.is_null() {
            axes.up = up.cast::<Vec3>().read_unaligned();
        }
        if !forward.is_null() {
            axes.forward = Some(forward.cast::<Vec3>().read_unaligned());
        }
    }
    Character { axes, ..Character::default() }.validate()?;
    Ok(axes)
}

/// Reads a skeleton with its roles.
///
/// # Safety
/// The struct and its arrays are as the header says.
pub unsafe fn read_skeleton(skeleton: *const SdefSkeleton) -> Outcome<(Skeleton, Humanoid)> {
    let given = unsafe { arrays::zeroed_in("SdefSkeleton", skeleton) }?;
    let count = given.joint_count;
    if i32::try_from(count).is_err() {
        return Err(Failure::argument(format!("joint_count is {count}: give at most 2147483647")));
    }
    let parents = unsafe { Input::new("parents", given.parents, count, 0) }?;
    let rests = unsafe {
        Input::<[f64; 16]>::new("rest_matrices", given.rest_matrices.cast(), count, given.rest_stride)
    }?;
    let mut joints = reserved(count, "joints")?;
    for index in 0..count {
        let name = match given.names.is_null() {
            true => String::new(),
            false => unsafe { arrays::text(given.names.add(index).read_unaligned()) },
        };
        let parent = match parents.get(index) {
            -1 => None,
            parent => Some(usize::try_from(parent).map_err(|_| {
                let message =
                    format!("joint {index} ({name}): its parent is {parent}: give a joint, or -1 for none");
                Failure::input(message).at(index)
            })?),
        };
        joints.push(Joint { name, parent, rest: arrays::matrix(rests.get(index)) });
    }
    let skeleton = Skeleton { joints };
    skeleton.validate()?;
    let mut humanoid = Humanoid::default();
    if given.role_count as usize > Role::COUNT {
        return Err(Failure::argument(format!(
            "role_count is {}: give at most {}, as many as there are roles",
            given.role_count,
            Role::COUNT
        )));
    }
    let roles = unsafe { Input::new("role_joints", given.role_joints, given.role_count as usize, 0) }?;
    for (role, joint) in Role::all().zip(roles.iter()) {
        if joint == -1 {
            continue;
        }
        match usize::try_from(joint) {
            Ok(joint) if joint < count => {
                if let Some((other, _)) = humanoid.iter().find(|&(_, taken)| taken == joint) {
                    return Err(Failure::input(format!(
                        "role_joints gives {other} and {role} the joint {joint}: a joint plays one role, and -1 stands for none"
                    ))
                    .at(joint));
                }
                humanoid.set(role, joint);
            }
            _ => {
                return Err(Failure::input(format!(
                    "role_joints gives {role} the joint {joint}, but there are {count} joints: give one of them, or -1"
                )));
            }
        }
    }
    Ok((skeleton, humanoid))
}

/// As [`read_mesh`], with the mesh in what is said of a mistake: it will be number `index`.
///
/// # Safety
/// The struct and its arrays are as the header says.
pub unsafe fn read_mesh_at(index: usize, given: &SdefMesh) -> Outcome<Mesh> {
    unsafe { read_mesh(given) }.map_err(|failure| {
        let name = unsafe { arrays::text(given.name) };
        Failure { message: format!("{}: {}", place(index, &name), failure.message), ..failure }.in_mesh(index)
    })
}

/// Reads a mesh, but for what needs the character.
///
/// # Safety
/// The struct and its arrays are as the header says.
unsafe fn read_mesh(given: &SdefMesh) -> Outcome<Mesh> {
    let name = unsafe { arrays::text(given.name) };
    let kinds = [
        // What stands last says most about it: a material more than the node that shows it.
        name.rsplit('/').find_map(MeshKind::guess),
        Some(MeshKind::Body),
        Some(MeshKind::Garment),
        Some(MeshKind::Hair),
        Some(MeshKind::FacePart),
        Some(MeshKind::Accessory),
    ];
    let kind = one_of("kind", given.kind, &kinds)?;
    let count = given.vertex_count;
    if count >= u32::MAX as usize {
        return Err(Failure::argument(format!("vertex_count is {count}: give at most 4294967294")));
    }
    unsafe {
        let positions =
            Input::<Vec3>::new("positions", given.positions.cast(), count, given.position_stride)?;
        let triangles = Triangles::new(given)?;
        let weights = Rows::new(given)?;
        Ok(Mesh {
            kind,
            positions: positions.to_vec("positions")?,
            triangles: triangles.read()?,
            normals: arrays::optional("normals", given.normals, count, given.normal_stride)?,
            tangents: arrays::optional("tangents", given.tangents, count, given.tangent_stride)?,
            morph_targets: Vec::new(),
            weights: weights.read()?,
            name,
        })
    }
}

/// The caller's indices.
enum Triangles {
    U8(Input<u8>),
    U16(Input<u16>),
    U32(Input<[u32; 3]>),
}

impl Triangles {
    unsafe fn new(given: &SdefMesh) -> Outcome<Self> {
        let (start, count) = (given.indices, given.index_count);
        if !count.is_multiple_of(3) {
            return Err(Failure::argument(format!("index_count is {count}: give 3 for each triangle")));
        }
        unsafe {
            match given.index_type {
                SDEF_TYPE_DEFAULT | SDEF_TYPE_U32 => {
                    Ok(Self::U32(Input::new("indices", start.cast(), count / 3, 0)?))
                }
                SDEF_TYPE_U16 => Ok(Self::U16(Input::new("indices", start.cast(), count, 0)?)),
                SDEF_TYPE_U8 => Ok(Self::U8(Input::new("indices", start.cast(), count, 0)?)),
                other => Err(bad_type("index_type", other, "SDEF_TYPE_U8, _U16 or _U32")),
            }
        }
    }

    fn read(&self) -> Outcome<Vec<[u32; 3]>> {
        match self {
            Self::U32(indices) => indices.to_vec("triangles"),
            Self::U16(indices) => widened(indices),
            Self::U8(indices) => widened(indices),
        }
    }
}

fn widened<T: arrays::Plain + Into<u32>>(indices: &Input<T>) -> Outcome<Vec<[u32; 3]>> {
    let count = indices.len() / 3;
    let mut triangles = reserved(count, "triangles")?;
    triangles
        .extend((0..count).map(|triangle| [0, 1, 2].map(|corner| indices.get(3 * triangle + corner).into())));
    Ok(triangles)
}

fn bad_type(what: &str, number: u32, known: &str) -> Failure {
    Failure::argument(format!("{what} is {number}: give {known}"))
}

/// The caller's joints or weights: some numbers for each of some rows.
struct Columns {
    start: *const u8,
    stride: usize,
    kind: u32,
}

impl Columns {
    unsafe fn new(
        what: &str,
        start: *const c_void,
        (rows, columns): (usize, usize),
        stride: usize,
        kind: u32,
    ) -> Outcome<Self> {
        let size = match kind {
            SDEF_TYPE_U8 => 1,
            SDEF_TYPE_U16 => 2,
            _ => 4,
        };
        let row = columns.checked_mul(size).filter(|&row| isize::try_from(row).is_ok()).ok_or_else(|| {
            Failure::argument(format!("{what}: {columns} are more than memory can hold: give fewer"))
        })?;
        let stride = arrays::stride_of(&what, start.is_null(), if row == 0 { 0 } else { rows }, stride, row)?;
        Ok(Self { start: start.cast(), stride, kind })
    }

    /// # Safety
    /// Row and column lie within what was checked.
    #[inline]
    unsafe fn joint(&self, row: usize, column: usize) -> u32 {
        unsafe {
            let at = self.start.add(row * self.stride);
            match self.kind {
                SDEF_TYPE_U8 => u32::from(*at.add(column)),
                SDEF_TYPE_U16 => u32::from(at.cast::<u16>().add(column).read_unaligned()),
                _ => at.cast::<u32>().add(column).read_unaligned(),
            }
        }
    }

    /// # Safety
    /// As [`Columns::joint`].
    #[inline]
    unsafe fn weight(&self, row: usize, column: usize) -> f32 {
        unsafe {
            let at = self.start.add(row * self.stride);
            match self.kind {
                SDEF_TYPE_U8 => f32::from(*at.add(column)) / 255.0,
                SDEF_TYPE_U16 => f32::from(at.cast::<u16>().add(column).read_unaligned()) / 65535.0,
                _ => at.cast::<f32>().add(column).read_unaligned(),
            }
        }
    }
}

/// The caller's weights.
struct Rows {
    joints: Columns,
    weights: Columns,
    vertex_count: usize,
    influence_count: usize,
    starts: Option<Input<u32>>,
}

impl Rows {
    unsafe fn new(given: &SdefMesh) -> Outcome<Self> {
        let (vertices, influences) = (given.vertex_count, given.influence_count);
        if !matches!(given.joint_type, SDEF_TYPE_DEFAULT | SDEF_TYPE_U8 | SDEF_TYPE_U16 | SDEF_TYPE_U32) {
            return Err(bad_type("joint_type", given.joint_type, "SDEF_TYPE_U8, _U16 or _U32"));
        }
        if !matches!(given.weight_type, SDEF_TYPE_DEFAULT | SDEF_TYPE_U8 | SDEF_TYPE_U16 | SDEF_TYPE_F32) {
            return Err(bad_type("weight_type", given.weight_type, "SDEF_TYPE_F32, _U8 or _U16"));
        }
        unsafe {
            let starts = match given.row_starts.is_null() {
                true => None,
                false => Some(Input::new("row_starts", given.row_starts, vertices + 1, 0)?),
            };
            let shape = match starts {
                // One row that holds everything.
                Some(_) => (1, influences),
                None => (vertices, influences),
            };
            let rows = Self {
                joints: Columns::new("joints", given.joints, shape, given.joint_stride, given.joint_type)?,
                weights: Columns::new(
                    "weights",
                    given.weights,
                    shape,
                    given.weight_stride,
                    given.weight_type,
                )?,
                vertex_count: vertices,
                influence_count: influences,
                starts,
            };
            rows.check_starts()?;
            Ok(rows)
        }
    }

    fn check_starts(&self) -> Outcome {
        let Some(starts) = &self.starts else { return Ok(()) };
        let mut before = 0;
        for (vertex, start) in starts.iter().enumerate() {
            if start < before || (vertex == 0 && start != 0) {
                return Err(Failure::input(format!(
                    "row_starts {vertex} is {start}, after {before}: the numbers rise from 0"
                ))
                .at(vertex));
            }
            before = start;
        }
        if before as usize != self.influence_count {
            return Err(Failure::input(format!(
                "row_starts ends at {before}, but influence_count is {}: give the same",
                self.influence_count
            )));
        }
        Ok(())
    }

    /// Where the influences of a vertex are: row, and first and last column.
    #[inline]
    fn row(&self, vertex: usize) -> (usize, std::ops::Range<usize>) {
        match &self.starts {
            Some(starts) => (0, starts.get(vertex) as usize..starts.get(vertex + 1) as usize),
            None => (vertex, 0..self.influence_count),
        }
    }

    fn read(&self) -> Outcome<Weights> {
        if self.vertex_count == 0 || self.influence_count == 0 {
            return Ok(Weights::default());
        }
        let mut starts = reserved(self.vertex_count + 1, "rows of weights")?;
        // Counted first: many of a fixed number of influences are 0.
        let mut count = 0usize;
        for vertex in 0..self.vertex_count {
            starts.push(count as u32);
            let (row, columns) = self.row(vertex);
            // SAFETY: the row lies within what was checked.
            count += columns.filter(|&column| unsafe { self.weights.weight(row, column) } != 0.0).count();
            if count > u32::MAX as usize {
                return Err(Failure::input("there are more than 4294967295 weights in one mesh: give fewer"));
            }
        }
        starts.push(count as u32);
        let mut entries = reserved(count, "weights")?;
        for vertex in 0..self.vertex_count {
            let (row, columns) = self.row(vertex);
            for column in columns {
                // SAFETY: the row lies within what was checked.
                let (joint, weight) =
                    unsafe { (self.joints.joint(row, column), self.weights.weight(row, column)) };
                if weight != 0.0 && entries.len() < count {
                    entries.push((joint, weight));
                }
            }
        }
        Ok(Weights::from_parts(starts, entries))
    }
}

/// The body of `sdef_character_create`.
pub unsafe fn create(
    up: *const f32,
    forward: *const f32,
    character: *mut SdefCharacter,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        wanted("character", character)?;
        let state = CharacterState::new(axes(up, forward)?);
        let id = table::insert(Object::Character(Arc::new(RwLock::new(state))))?;
        tell(character, SdefCharacter { id });
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_character_set_skeleton`.
pub unsafe fn set_skeleton(
    character: SdefCharacter,
    skeleton: *const SdefSkeleton,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::character(character)?;
        let (skeleton, roles) = read_skeleton(skeleton)?;
        table::write(&state, "character")?.set_skeleton(skeleton, roles)
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_character_add_mesh`.
pub unsafe fn add_mesh(
    character: SdefCharacter,
    mesh: *const SdefMesh,
    index: *mut u32,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::character(character)?;
        let given = arrays::zeroed_in("SdefMesh", mesh)?;
        let index_to_be = table::read(&state, "character")?.character().meshes.len();
        let mesh = read_mesh_at(index_to_be, &given)?;
        let added = table::write(&state, "character")?.add_mesh(mesh)?;
        tell(index, added as u32);
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_character_add_morph_target`.
pub unsafe fn add_morph_target(
    character: SdefCharacter,
    mesh: u32,
    target: *const SdefMorphTarget,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::character(character)?;
        let given = arrays::zeroed_in("SdefMorphTarget", target)?;
        let mut state = table::write(&state, "character")?;
        let known = state.character();
        let index = mesh as usize;
        let mesh = mesh_of(&known, index)?;
        let count = mesh.positions.len();
        let deltas = |what, start, stride| arrays::optional(what, start, count, stride);
        if count > 0 && given.positions.is_null() {
            return Err(Failure::argument(format!(
                "positions is NULL, but {count} are to be there: give the array"
            )));
        }
        let target = MorphTarget {
            name: arrays::text(given.name),
            positions: deltas("positions", given.positions, given.position_stride)?,
            normals: deltas("normals", given.normals, given.normal_stride)?,
            tangents: deltas("tangents", given.tangents, given.tangent_stride)?,
        };
        target.validate(mesh.morph_targets.len(), count).map_err(|(vertex, message)| {
            let failure = Failure::input(format!("{}: {message}", place(index, &mesh.name))).in_mesh(index);
            vertex.map_or(failure.clone(), |vertex| failure.at(vertex))
        })?;
        drop(known);
        state.change(|character| character.meshes[index].morph_targets.push(target));
        Ok(())
    };
    unsafe { call(error, body) }
}

fn mesh_of(character: &Character, mesh: usize) -> Outcome<&Mesh> {
    let count = character.meshes.len();
    character.meshes.get(mesh).ok_or_else(|| {
        Failure::argument(format!("there is no mesh {mesh}: the character has {count}, counted from 0"))
    })
}

/// The body of `sdef_character_get_info`.
pub unsafe fn get_info(
    character: SdefCharacter,
    info: *mut SdefCharacterInfo,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::character(character)?;
        let state = table::read(&state, "character")?;
        let own = state.character();
        let whole = state.rig.as_ref().map_or(&own, |made| &made.rigged);
        let value = SdefCharacterInfo {
            struct_size: 0,
            mesh_count: own.meshes.len() as u32,
            joint_count: whole.skeleton.joints.len() as u32,
            own_joint_count: own.skeleton.joints.len() as u32,
            morph_target_count: own.meshes.iter().map(|mesh| mesh.morph_targets.len()).sum::<usize>() as u32,
            rig_made: u32::from(state.rig.is_some()),
            vertex_count: own.vertex_count() as u64,
            triangle_count: own.triangle_count() as u64,
        };
        arrays::struct_out("SdefCharacterInfo", info, &value)
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_character_get_joints`.
#[allow(clippy::too_many_arguments)]
pub unsafe fn get_joints(
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
        let state = table::character(character)?;
        let ready = table::read(&state, "character")?.ready();
        let whole = ready.character();
        let joints = &whole.skeleton.joints;
        let count = joints.len();
        tell(joint_count, count);
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
        roles.write(&role_of);
        rests.write_each(joints.iter().map(|joint| joint.rest.to_cols_array()));
        let mut sure = vec![1.0; count];
        if let Some((rig, _)) = &ready.rigged {
            let own = ready.own.skeleton.joints.len();
            sure[own..].copy_from_slice(&rig.confidence);
        }
        confidence.write(&sure);
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_character_get_weights`.
pub unsafe fn get_weights(
    character: SdefCharacter,
    mesh: u32,
    influence_count: u32,
    joints: *mut u32,
    weights: *mut f32,
    capacity: usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::character(character)?;
        let ready = table::read(&state, "character")?.ready();
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
        let fits = |what: &str| match capacity < count {
            true => Err(Failure::new(
                SDEF_STATUS_BUFFER_TOO_SMALL,
                format!("{what} can hold {capacity} vertices, but the mesh has {count}: give a larger array"),
            )
            .in_mesh(index)),
            false => Ok(()),
        };
        if !joints.is_null() {
            fits("joints")?;
        }
        if !weights.is_null() {
            fits("weights")?;
        }
        let numbers = count.saturating_mul(most);
        let joints = Output::new("joints", joints, numbers, numbers, 0)?;
        let weights = Output::new("weights", weights, numbers, numbers, 0)?;
        let limited = all.limited(most);
        let entry = |vertex: usize, influence: usize| limited.row(vertex).get(influence).copied();
        let entries = || (0..count).flat_map(|vertex| (0..most).map(move |influence| (vertex, influence)));
        joints.write_each(entries().map(|(v, i)| entry(v, i).map_or(0, |(joint, _)| joint + first)));
        weights.write_each(entries().map(|(v, i)| entry(v, i).map_or(0.0, |(_, weight)| weight)));
        Ok(())
    };
    unsafe { call(error, body) }
}

/// The body of `sdef_character_rig`.
pub unsafe fn rig(
    character: SdefCharacter,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = table::character(character)?;
        let (_, options) = super::options::read(options)?;
        let mut tell = super::bodies::teller(progress, user);
        table::write(&state, "character")?.make_rig(&options, &mut Progress::new(&mut tell))
    };
    unsafe { call(error, body) }
}
