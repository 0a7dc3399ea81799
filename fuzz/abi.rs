//! Bytes become a sequence of calls of the C ABI, with every array exactly as long as it is said to be.
//!
//! What a host promises by the header is kept: pointers hold what their counts, strides and struct sizes say, and texts
//! end. All else is free: handles that are gone, made up or of another kind, sizes, strides, constants, numbers, NULLs.

use super::{Bytes, figure, panics_abort, rest, shape};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_char, c_void};
use std::mem::offset_of;
use std::ptr::{null, null_mut};
use std::sync::OnceLock;
use superdeform::internals::ffi::all_at_once::*;
use superdeform::internals::ffi::basics::*;
use superdeform::internals::ffi::character::*;
use superdeform::internals::ffi::deformer::*;
use superdeform::internals::ffi::lifetime::*;
use superdeform::internals::ffi::options::*;
use superdeform::internals::ffi::rig::*;
use superdeform::internals::ffi::style_handle::*;
use superdeform::{Character, Role};

/// What one run may cost, so that thousands fit into a second.
const BUDGET: i32 = 12;
const RIG: i32 = 8;
const MEASURE: i32 = 3;
const DEFORM: i32 = 3;

/// What is known of a mesh that was added.
#[derive(Clone, Copy)]
struct Known {
    vertices: usize,
    normals: bool,
    tangents: bool,
    targets: usize,
}

struct Host<'a> {
    bytes: Bytes<'a>,
    /// Handles that live as long as the process.
    lasting: &'static Lasting,
    /// Whether calls that take long are made.
    deep: bool,
    /// Every handle that was given, with the kind that it has: 0 character, 1 style, 2 deformer.
    handles: Vec<(usize, u64)>,
    meshes: BTreeMap<u64, Vec<Known>>,
    joints: BTreeMap<u64, usize>,
    budget: i32,
}

/// Memory of the host for one call. Arrays lie at the end of their allocation, so that one byte beyond is seen.
#[derive(Default)]
struct Memory {
    blocks: Vec<Box<[u8]>>,
    /// Blocks that the library may write to, as they were.
    outputs: Vec<(usize, Box<[u8]>)>,
}

impl Memory {
    fn place(&mut self, bytes: &mut Bytes, size: usize) -> (usize, *mut u8) {
        // Arrays need no alignment.
        let shift = if bytes.chance(40) { 1 + bytes.below(7) } else { 0 };
        self.blocks.push(vec![0xcd; size + shift].into_boxed_slice());
        let index = self.blocks.len() - 1;
        (index, unsafe { self.blocks[index].as_mut_ptr().add(shift) })
    }

    fn input<T>(&mut self, bytes: &mut Bytes, values: &[T], stride: usize) -> *const T {
        let size = size_of::<T>();
        let stride = if stride < size { size } else { stride };
        let all = if values.is_empty() { 0 } else { (values.len() - 1) * stride + size };
        let (_, start) = self.place(bytes, all);
        for (index, value) in values.iter().enumerate() {
            unsafe { start.add(index * stride).copy_from_nonoverlapping((&raw const *value).cast(), size) };
        }
        start.cast()
    }

    /// An array, or NULL at times.
    fn input_or_null<T>(&mut self, bytes: &mut Bytes, values: &[T], stride: usize) -> *const T {
        if bytes.chance(12) { null() } else { self.input(bytes, values, stride) }
    }

    fn output<T>(&mut self, bytes: &mut Bytes, count: usize, stride: usize) -> *mut T {
        if bytes.chance(30) {
            return null_mut();
        }
        let stride = if stride < size_of::<T>() { size_of::<T>() } else { stride };
        let all = if count == 0 { 0 } else { (count - 1) * stride + size_of::<T>() };
        let (index, start) = self.place(bytes, all);
        self.outputs.push((index, self.blocks[index].clone()));
        start.cast()
    }

    /// A struct that begins with its size; as many bytes as that says, as far as it may be true.
    fn sized<T>(&mut self, bytes: &mut Bytes, value: &T, has_pointers: bool) -> *mut T {
        self.sized_from(bytes, value, has_pointers, 0)
    }

    /// As [`Memory::sized`]; a shorter one has the first `least` bytes.
    fn sized_from<T>(&mut self, bytes: &mut Bytes, value: &T, has_pointers: bool, least: usize) -> *mut T {
        let own = size_of::<T>();
        let size = match bytes.byte() {
            0..200 => own,
            200..210 => own + 8 * bytes.below(9),
            210..240 => {
                // No struct ends within a pointer.
                let step = if has_pointers { 8 } else { 4 };
                (step * (1 + bytes.below(own / step))).max(least)
            }
            240..244 => return null_mut(),
            _ => bytes.of(&[0, 1, 4, 7, own + 1, own - 1, (1 << 16) + 8, u32::MAX as usize]),
        };
        let held = if size > 1 << 16 { own } else { size.max(4) };
        let (_, start) = self.place(bytes, held);
        unsafe {
            start.copy_from_nonoverlapping((&raw const *value).cast(), held.min(own));
            start.cast::<u32>().write_unaligned(size as u32);
        }
        start.cast()
    }

    /// An array of structs that results go to; the first says their size, which is mostly right.
    fn struct_outputs<T>(&mut self, bytes: &mut Bytes, count: usize) -> *mut T {
        let start: *mut T = self.output(bytes, count, 0);
        if !start.is_null() && count > 0 {
            let size = sizes(bytes, size_of::<T>());
            unsafe { start.cast::<u32>().write_unaligned(size) };
            let (index, before) = self.outputs.last_mut().unwrap();
            before.clone_from(&self.blocks[*index]);
        }
        start
    }

    fn text(&mut self, bytes: &mut Bytes) -> *const c_char {
        if bytes.chance(60) {
            return null();
        }
        let mut text = bytes.text(90);
        text.push(0);
        self.input(bytes, &text, 0).cast()
    }

    fn nothing_was_written(&self, what: &str) {
        for (index, before) in &self.outputs {
            assert!(&self.blocks[*index] == before, "{what} wrote into an array and failed");
        }
    }
}

/// The size that a struct of an array says: mostly its own; never more, for that much is not there.
fn sizes(bytes: &mut Bytes, own: usize) -> u32 {
    if bytes.chance(12) { bytes.below(own) as u32 } else { own as u32 }
}

/// Calls with a struct for the error, or without one.
fn ask(bytes: &mut Bytes, call: impl FnOnce(*mut SdefError) -> SdefStatus) -> SdefStatus {
    let own = size_of::<SdefError>();
    let size = match bytes.byte() {
        0..20 => return call(null_mut()),
        20..40 => 4 * bytes.below(own / 4 + 8),
        40..50 => own + 64,
        _ => own,
    };
    // 0 stands for the whole struct.
    let held = if size == 0 { own } else { size.max(4) };
    let mut memory = vec![0xcd_u8; held].into_boxed_slice();
    let error: *mut SdefError = memory.as_mut_ptr().cast();
    unsafe { error.cast::<u32>().write_unaligned(size as u32) };
    let status = call(error);
    if held >= own {
        let written = u32::from_le_bytes(memory[4..8].try_into().unwrap());
        assert_eq!(status, written, "the status returned is the one written");
        let text = CStr::from_bytes_until_nul(&memory[std::mem::offset_of!(SdefError, message)..]);
        let text = text.expect("messages end").to_str().expect("messages are UTF-8");
        assert_eq!(text.is_empty(), status == SDEF_STATUS_OK, "status {status}: {text}");
        assert_ne!(status, SDEF_STATUS_INTERNAL, "{text}");
    }
    assert_ne!(status, SDEF_STATUS_INTERNAL);
    let name = unsafe { CStr::from_ptr(sdef_status_name(status)) };
    assert_ne!(name, c"unknown status");
    status
}

/// What a progress callback does: it counts, calls back, and stops.
struct Watcher {
    calls: u32,
    stop_after: u32,
    last: f32,
    handle: u64,
    what: u8,
}

unsafe extern "C" fn watch(user: *mut c_void, fraction: f32) -> i32 {
    let watcher = unsafe { &*user.cast::<RefCell<Watcher>>() };
    let (what, handle) = {
        let mut watcher = watcher.borrow_mut();
        watcher.calls += 1;
        assert!(
            (0.0..=1.0).contains(&fraction) && fraction >= watcher.last,
            "{fraction} comes after {}",
            watcher.last
        );
        watcher.last = fraction;
        (watcher.what, watcher.handle)
    };
    unsafe {
        match what {
            0 => {
                let mut info =
                    SdefCharacterInfo { struct_size: size_of::<SdefCharacterInfo>() as u32, ..zeroed() };
                sdef_character_get_info(SdefCharacter { id: handle }, &mut info, null_mut());
            }
            1 => {
                sdef_character_set_skeleton(SdefCharacter { id: handle }, null(), null_mut());
                let mesh = SdefMesh { struct_size: size_of::<SdefMesh>() as u32, ..zeroed() };
                sdef_character_add_mesh(SdefCharacter { id: handle }, &mesh, null_mut(), null_mut());
            }
            2 => {
                sdef_deformer_set_options(SdefDeformer { id: handle }, null(), None, null_mut(), null_mut());
            }
            3 => {
                sdef_deformer_get_report(
                    SdefDeformer { id: handle },
                    null_mut(),
                    null_mut(),
                    0,
                    null_mut(),
                    null_mut(),
                );
            }
            _ => {}
        }
    }
    let watcher = watcher.borrow();
    i32::from(watcher.calls > watcher.stop_after)
}

fn zeroed<T>() -> T {
    unsafe { std::mem::zeroed() }
}

/// A stride for elements of `size` bytes, seldom one that cannot be.
fn stride(bytes: &mut Bytes, size: usize) -> usize {
    match bytes.byte() {
        0..180 => 0,
        180..200 => size,
        200..250 => size + bytes.below(20),
        250..252 => bytes.below(size),
        252 => usize::MAX,
        253 => usize::MAX / 2,
        _ => 1 << 62,
    }
}

/// What a stride stands for where it can be.
fn held(stride: usize, size: usize) -> usize {
    if (size..=4096).contains(&stride) { stride } else { size }
}

/// A count that an array of `count` elements may have, and now and then one that only NULL can have.
fn too_many(bytes: &mut Bytes) -> usize {
    bytes.of(&[
        usize::MAX,
        usize::MAX / 3,
        1 << 61,
        u32::MAX as usize,
        u32::MAX as usize - 1,
        1 << 31,
        1 << 40,
    ])
}

impl Host<'_> {
    fn given(&mut self, kind: usize, id: u64) {
        assert_ne!(id, 0);
        self.handles.push((kind, id));
    }

    /// Changing these would make a run depend on those before it.
    fn is_lasting(&self, id: u64) -> bool {
        self.lasting.handles.iter().any(|&(_, lasting)| lasting == id)
    }

    fn may_work(&mut self, cost: i32) -> bool {
        let may = self.deep && self.budget >= cost;
        if may {
            self.budget -= cost;
        }
        may
    }

    fn handle(&mut self, kind: usize) -> u64 {
        match self.bytes.byte() {
            0..215 => self.handles.iter().rev().find(|handle| handle.0 == kind).map_or(0, |handle| handle.1),
            215..235 => {
                let all: Vec<u64> =
                    self.handles.iter().filter(|handle| handle.0 == kind).map(|handle| handle.1).collect();
                if all.is_empty() { 0 } else { all[self.bytes.below(all.len())] }
            }
            235..245 => match self.handles.len() {
                0 => 0,
                count => self.handles[self.bytes.below(count)].1,
            },
            245..250 => {
                let id = self.handles.last().map_or(0, |handle| handle.1);
                id ^ 1 << (self.bytes.byte() % 64)
            }
            250..253 => self.bytes.u64(),
            _ => 0,
        }
    }

    fn progress(&mut self) -> (SdefProgress, RefCell<Watcher>) {
        let watched = self.bytes.chance(70);
        let stop_after = if self.bytes.chance(128) { u32::MAX } else { self.bytes.below(12) as u32 };
        let kind = self.bytes.below(3);
        let handle = if watched { self.handle(kind) } else { 0 };
        let what = self.bytes.byte() % 6;
        let progress: SdefProgress = if watched { Some(watch) } else { None };
        (progress, RefCell::new(Watcher { calls: 0, stop_after, last: 0.0, handle, what }))
    }

    fn options(&mut self, memory: &mut Memory) -> *const SdefOptions {
        let bytes = &mut self.bytes;
        let mut options: SdefOptions = zeroed();
        let own = size_of::<SdefOptions>() as u32;
        assert_eq!(unsafe { sdef_options_init(&mut options, own, null_mut()) }, SDEF_STATUS_OK);
        options.thread_count = 1;
        options.rays = 3 + bytes.below(6) as u32;
        options.rig_voxel_resolution = 16;
        options.rig_fingers = 0;
        for _ in 0..bytes.below(6) {
            match bytes.below(28) {
                0 => options.mode = 1,
                1 => options.stage = bytes.below(4) as u32,
                2 => options.face_curve = bytes.below(4) as u32,
                3 => options.rig_weights = bytes.below(4) as u32,
                4 => options.rig_garments = bytes.below(4) as u32,
                5 => options.limits = bytes.below(3) as u32,
                6 => options.rig_left_handed = bytes.below(3) as u32,
                7 => options.rig_fingers = bytes.below(3) as u32,
                8 => options.head_scale = bytes.number(),
                9 => options.amount = bytes.number(),
                10 => options.hair_length = bytes.number(),
                11 => options.face_squash = bytes.number(),
                12 => options.rig_heat = bytes.number(),
                13 => options.thread_count = bytes.of(&[0, 2, 3, u32::MAX]),
                14 => options.rays = bytes.of(&[0, 1, 3, 4097, u32::MAX]),
                15 => options.rig_voxel_resolution = bytes.of(&[0, 15, 17, 513, u32::MAX, 20]),
                16 => options.mode = bytes.u32(),
                17 | 18 => {
                    let count = bytes.below(4);
                    let groups: Vec<_> = (0..count)
                        .map(|_| SdefGroupSettings {
                            struct_size: sizes(bytes, size_of::<SdefGroupSettings>()),
                            reserved: 0,
                            group: memory.text(bytes),
                            length_scale: bytes.number(),
                            thickness_scale: bytes.number(),
                            length_transfer: bytes.number(),
                            thickness_transfer: bytes.number(),
                        })
                        .collect();
                    options.groups = memory.input_or_null(bytes, &groups, 0);
                    options.group_count = count as u32;
                }
                19 | 20 => {
                    let count = bytes.below(5);
                    let bones: Vec<_> = (0..count)
                        .map(|_| SdefBoneGroup {
                            struct_size: sizes(bytes, size_of::<SdefBoneGroup>()),
                            role: u32::from(bytes.byte() % 60),
                            group: memory.text(bytes),
                        })
                        .collect();
                    options.bone_groups = memory.input_or_null(bytes, &bones, 0);
                    options.bone_group_count = count as u32;
                }
                21 => {
                    let count = bytes.below(5);
                    let joints: Vec<_> = (0..count)
                        .map(|_| SdefGivenJoint {
                            struct_size: sizes(bytes, size_of::<SdefGivenJoint>()),
                            role: u32::from(bytes.byte() % 60),
                            x: bytes.number(),
                            y: bytes.number(),
                            z: bytes.number(),
                        })
                        .collect();
                    options.rig_joints = memory.input_or_null(bytes, &joints, 0);
                    options.rig_joint_count = count as u32;
                }
                22 => {
                    options.groups = null();
                    options.group_count = bytes.u32();
                }
                23 => options.youth = bytes.number(),
                24 => options.seat = bytes.number(),
                25 => options.hair_lay = bytes.number(),
                26 => options.repair = bytes.below(4) as u32,
                _ => {
                    options.rig_joints = null();
                    options.rig_joint_count = bytes.u32();
                }
            }
        }
        if bytes.chance(40) { null() } else { memory.sized(bytes, &options, true) }
    }

    /// A skeleton: of the figure, or any.
    fn skeleton(&mut self, memory: &mut Memory) -> (*const SdefSkeleton, usize) {
        let bytes = &mut self.bytes;
        let mut parents: Vec<i32> = Vec::new();
        let mut rests: Vec<[f64; 16]> = Vec::new();
        let mut roles = vec![-1i32; Role::COUNT];
        if bytes.chance(120) {
            let person = figure(3, 2, false, true);
            for joint in &person.skeleton.joints {
                parents.push(joint.parent.map_or(-1, |parent| parent as i32));
                rests.push(joint.rest.to_cols_array());
            }
            for (role, joint) in person.humanoid.iter() {
                roles[role as usize] = joint as i32;
            }
        }
        for _ in 0..bytes.below(8).saturating_sub(2) {
            parents.push(match bytes.byte() {
                0..200 => bytes.below(parents.len() + 1) as i32 - 1,
                _ => i32::from(bytes.byte() as i8),
            });
            rests.push(rest(bytes).to_cols_array());
        }
        let count = parents.len();
        for _ in 0..bytes.below(6).saturating_sub(2) {
            roles[bytes.below(Role::COUNT)] = bytes.below(count + 2) as i32 - 1;
        }
        if count > 0 && bytes.chance(30) {
            let joint = bytes.below(count);
            rests[joint][bytes.below(16)] = bytes.number();
        }
        let role_count = if bytes.chance(40) { bytes.below(60) } else { Role::COUNT };
        roles.resize(role_count, -1);
        let names: Vec<*const c_char> = (0..count).map(|_| memory.text(bytes)).collect();
        let rest_stride = stride(bytes, 128);
        let mut given = SdefSkeleton {
            struct_size: 0,
            role_count: role_count as u32,
            names: if bytes.chance(100) { null() } else { memory.input(bytes, &names, 0) },
            joint_count: count,
            parents: memory.input_or_null(bytes, &parents, 0),
            rest_matrices: memory.input_or_null(bytes, &rests, held(rest_stride, 128)).cast(),
            rest_stride,
            role_joints: memory.input_or_null(bytes, &roles, 0),
        };
        if bytes.chance(6) {
            (given.parents, given.names, given.rest_matrices) = (null(), null(), null());
            given.joint_count = too_many(bytes);
        }
        (memory.sized(bytes, &given, true), count)
    }

    /// A mesh: a limb or all of the figure, or any, with weights for about `joint_count` joints.
    fn mesh(&mut self, memory: &mut Memory, joint_count: usize) -> (SdefMesh, Known) {
        let bytes = &mut self.bytes;
        let mut made = match bytes.byte() {
            0..110 => {
                let person: Character =
                    figure(3 + bytes.below(3), 2 + bytes.below(2), bytes.chance(128), bytes.chance(170));
                let index = bytes.below(person.meshes.len());
                person.meshes[index].clone()
            }
            _ => shape(bytes),
        };
        let count = made.positions.len();
        if count > 0 && bytes.chance(20) {
            let vertex = bytes.below(count);
            made.positions[vertex].x = bytes.number() as f32;
        }
        let mut indices: Vec<u32> = made.triangles.iter().flatten().copied().collect();
        if !indices.is_empty() && bytes.chance(20) {
            let index = bytes.below(indices.len());
            indices[index] = bytes.u32();
        }
        let position_stride = stride(bytes, 12);
        let normal_stride = stride(bytes, 12);
        let tangent_stride = stride(bytes, 16);
        let threes: Vec<[f32; 3]> = made.positions.iter().map(|p| p.to_array()).collect();
        let mut mesh = SdefMesh {
            kind: match bytes.byte() {
                0..200 => bytes.below(6) as u32,
                200..205 => bytes.u32(),
                _ => 0,
            },
            name: memory.text(bytes),
            vertex_count: count,
            position_stride,
            positions: memory.input_or_null(bytes, &threes, held(position_stride, 12)).cast(),
            normal_stride,
            tangent_stride,
            ..zeroed()
        };
        if bytes.chance(60) {
            let normals: Vec<[f32; 3]> =
                (0..count).map(|_| bytes.point().normalize_or_zero().to_array()).collect();
            mesh.normals = memory.input(bytes, &normals, held(normal_stride, 12)).cast();
        }
        if bytes.chance(40) {
            let tangents: Vec<[f32; 4]> =
                (0..count).map(|_| bytes.point().normalize_or_zero().extend(1.0).to_array()).collect();
            mesh.tangents = memory.input(bytes, &tangents, held(tangent_stride, 16)).cast();
        }
        mesh.index_count = indices.len();
        match bytes.byte() {
            0..120 => mesh.indices = memory.input_or_null(bytes, &indices, 0).cast(),
            120..180 => {
                mesh.index_type = SDEF_TYPE_U16;
                let indices: Vec<u16> = indices.iter().map(|&index| index as u16).collect();
                mesh.indices = memory.input(bytes, &indices, 0).cast();
            }
            180..240 => {
                mesh.index_type = SDEF_TYPE_U8;
                let indices: Vec<u8> = indices.iter().map(|&index| index as u8).collect();
                mesh.indices = memory.input(bytes, &indices, 0).cast();
            }
            240..250 => {
                mesh.index_type = bytes.of(&[SDEF_TYPE_F32, 5, u32::MAX]);
                mesh.indices = memory.input(bytes, &indices, 0).cast();
            }
            _ => mesh.index_count = too_many(bytes),
        }
        match bytes.byte() {
            0..70 => {}
            // Rows, as the figure has them or any.
            70..140 => {
                let mut joints: Vec<u32> = Vec::new();
                let mut weights: Vec<f32> = Vec::new();
                let mut starts = vec![0u32];
                for vertex in 0..count {
                    match made.weights.is_empty() {
                        false => {
                            let (joint, weight) = made.weights.row(vertex)[0];
                            joints.push(joint);
                            weights.push(weight);
                        }
                        true => {
                            for _ in 0..bytes.below(3) {
                                joints.push(bytes.below(joint_count.max(1)) as u32);
                                weights.push(bytes.number() as f32);
                            }
                        }
                    }
                    starts.push(joints.len() as u32);
                }
                if bytes.chance(20) {
                    let vertex = bytes.below(starts.len());
                    starts[vertex] = bytes.u32();
                }
                mesh.influence_count = joints.len();
                mesh.joints = memory.input_or_null(bytes, &joints, 0).cast();
                mesh.weights = memory.input_or_null(bytes, &weights, 0).cast();
                mesh.row_starts = memory.input(bytes, &starts, 0);
            }
            140..250 => {
                let influences = bytes.below(5);
                mesh.influence_count = influences;
                let sizes = [4, 1, 2, 4, 4];
                mesh.joint_type = bytes.of(&[0, 0, 1, 2, 3, 4]);
                mesh.weight_type = bytes.of(&[0, 0, 1, 2, 4, 3]);
                let of = |kind: u32| sizes.get(kind as usize).copied().unwrap_or(4) * influences;
                let (joint_row, weight_row) = (of(mesh.joint_type), of(mesh.weight_type));
                mesh.joint_stride = stride(bytes, joint_row.max(1));
                mesh.weight_stride = stride(bytes, weight_row.max(1));
                let wide = |stride: usize, row: usize, count: usize| match count {
                    0 => 0,
                    _ => (count - 1) * held(stride, row) + row,
                };
                let joint_size = wide(mesh.joint_stride, joint_row, count);
                let weight_size = wide(mesh.weight_stride, weight_row, count);
                let limit = joint_count.max(1);
                let joints: Vec<u8> = match bytes.chance(220) {
                    true => vec![0; joint_size],
                    false => (0..joint_size)
                        .map(|at| if at % 4 == 0 { bytes.below(limit) as u8 } else { 0 })
                        .collect(),
                };
                let pattern = [bytes.byte(), bytes.byte(), 0x80, 0x3f];
                let weights: Vec<u8> = (0..weight_size).map(|at| pattern[at % 4]).collect();
                mesh.joints = memory.input_or_null(bytes, &joints, 0).cast();
                mesh.weights = memory.input_or_null(bytes, &weights, 0).cast();
            }
            _ => mesh.influence_count = too_many(bytes),
        }
        if bytes.chance(20) {
            mesh.luminance_stride = stride(bytes, 1);
            let values: Vec<u8> = (0..count).map(|_| bytes.byte()).collect();
            mesh.luminance = memory.input(bytes, &values, held(mesh.luminance_stride, 1));
        }
        if bytes.chance(20) {
            mesh.image = bytes.below(3) as u32;
            mesh.uv_stride = stride(bytes, 8);
            let uvs: Vec<[f32; 2]> = (0..count).map(|_| [(); 2].map(|()| bytes.number() as f32)).collect();
            mesh.uvs = memory.input_or_null(bytes, &uvs, held(mesh.uv_stride, 8)).cast();
        }
        if bytes.chance(4) {
            mesh = SdefMesh { vertex_count: too_many(bytes), ..zeroed() };
        }
        let known = Known {
            vertices: mesh.vertex_count,
            normals: !mesh.normals.is_null(),
            tangents: !mesh.tangents.is_null(),
            targets: 0,
        };
        (mesh, known)
    }

    fn results(&mut self, memory: &mut Memory, known: &[Known]) -> (*const SdefMeshResult, usize) {
        let bytes = &mut self.bytes;
        let count = match bytes.byte() {
            0..240 => known.len(),
            _ => bytes.below(5),
        };
        let own = size_of::<SdefMeshResult>();
        let size = match bytes.byte() {
            0..220 => own,
            220..245 => 8 * (1 + bytes.below(own / 8 + 6)),
            _ => bytes.of(&[0, 4, 9, 1 << 17, own + 1]),
        };
        let held_size = if size > 1 << 16 { own } else { size.max(4) };
        let (_, start) = memory.place(bytes, held_size * count);
        for index in 0..count {
            let mesh = known.get(index).copied().unwrap_or(Known {
                vertices: 3,
                normals: false,
                tangents: false,
                targets: 0,
            });
            let vertices = match bytes.byte() {
                0..235 => mesh.vertices.min(4096),
                _ => bytes.below(20),
            };
            let targets = match bytes.byte() {
                0..235 => mesh.targets,
                _ => bytes.below(3),
            };
            let strides = [stride(bytes, 12), stride(bytes, 12), stride(bytes, 16)];
            let mut result = SdefMeshResult {
                struct_size: 0,
                morph_target_capacity: targets as u32,
                vertex_capacity: vertices,
                positions: memory.output::<[f32; 3]>(bytes, vertices, held(strides[0], 12)).cast(),
                position_stride: strides[0],
                normals: null_mut(),
                normal_stride: strides[1],
                tangents: null_mut(),
                tangent_stride: strides[2],
                morph_positions: null_mut(),
                morph_normals: null_mut(),
                morph_tangents: null_mut(),
            };
            if mesh.normals || bytes.chance(6) {
                result.normals = memory.output::<[f32; 3]>(bytes, vertices, held(strides[1], 12)).cast();
            }
            if mesh.tangents || bytes.chance(6) {
                result.tangents = memory.output::<[f32; 4]>(bytes, vertices, held(strides[2], 16)).cast();
            }
            if mesh.targets > 0 || bytes.chance(6) {
                let all = vertices * targets;
                result.morph_positions = memory.output::<[f32; 3]>(bytes, all, 0).cast();
                result.morph_normals = memory.output::<[f32; 3]>(bytes, all, 0).cast();
                result.morph_tangents = memory.output::<[f32; 3]>(bytes, all, 0).cast();
            }
            unsafe {
                let to = start.add(index * held_size);
                to.copy_from_nonoverlapping((&raw const result).cast(), held_size.min(own));
                let told = if index > 0 && bytes.chance(3) { size + 8 } else { size };
                to.cast::<u32>().write_unaligned(told as u32);
            }
        }
        if bytes.chance(3) {
            return (null(), too_many(bytes));
        }
        (start.cast(), count)
    }

    /// Gives a character a skeleton and a body, so that what comes after works.
    fn person(&mut self) {
        let (columns, rings) = (3 + self.bytes.below(2), 2);
        let person = figure(columns, rings, true, true);
        let with_joints = self.bytes.chance(200);
        let mut character = SdefCharacter::default();
        unsafe {
            assert_eq!(sdef_character_create(null(), null(), &mut character, null_mut()), SDEF_STATUS_OK);
            self.given(0, character.id);
            let parents: Vec<i32> = person
                .skeleton
                .joints
                .iter()
                .map(|joint| joint.parent.map_or(-1, |parent| parent as i32))
                .collect();
            let rests: Vec<[f64; 16]> =
                person.skeleton.joints.iter().map(|joint| joint.rest.to_cols_array()).collect();
            let mut roles = vec![-1; Role::COUNT];
            person.humanoid.iter().for_each(|(role, joint)| roles[role as usize] = joint as i32);
            let skeleton = SdefSkeleton {
                struct_size: size_of::<SdefSkeleton>() as u32,
                role_count: Role::COUNT as u32,
                names: null(),
                joint_count: parents.len(),
                parents: parents.as_ptr(),
                rest_matrices: rests.as_ptr().cast(),
                rest_stride: 0,
                role_joints: roles.as_ptr(),
            };
            if with_joints {
                assert_eq!(sdef_character_set_skeleton(character, &skeleton, null_mut()), SDEF_STATUS_OK);
                self.joints.insert(character.id, parents.len());
            }
            let body = &person.meshes[0];
            let joints: Vec<u32> = body.weights.rows().map(|row| row[0].0).collect();
            let weights = vec![1.0f32; joints.len()];
            let mesh = SdefMesh {
                struct_size: size_of::<SdefMesh>() as u32,
                vertex_count: body.positions.len(),
                positions: body.positions.as_ptr().cast(),
                index_count: 3 * body.triangles.len(),
                indices: body.triangles.as_ptr().cast(),
                influence_count: usize::from(with_joints),
                joints: joints.as_ptr().cast(),
                weights: weights.as_ptr().cast(),
                ..zeroed()
            };
            assert_eq!(sdef_character_add_mesh(character, &mesh, null_mut(), null_mut()), SDEF_STATUS_OK);
            let known = Known { vertices: body.positions.len(), normals: false, tangents: false, targets: 0 };
            self.meshes.entry(character.id).or_default().push(known);
        }
    }

    fn call(&mut self) {
        let mut memory = Memory::default();
        let memory = &mut memory;
        let (what, status): (&str, SdefStatus) = match self.bytes.byte() % 40 {
            0 | 1 => {
                self.person();
                return;
            }
            2 => {
                let up: Vec<[f32; 3]> = vec![[(); 3].map(|()| self.bytes.number() as f32)];
                let up = if self.bytes.chance(200) { null() } else { memory.input(&mut self.bytes, &up, 0) };
                let forward: Vec<[f32; 3]> = vec![[(); 3].map(|()| self.bytes.number() as f32)];
                let forward =
                    if self.bytes.chance(200) { null() } else { memory.input(&mut self.bytes, &forward, 0) };
                let mut handle = SdefCharacter::default();
                let to = if self.bytes.chance(4) { null_mut() } else { &raw mut handle };
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_character_create(up.cast(), forward.cast(), to, error)
                });
                if status == SDEF_STATUS_OK {
                    self.given(0, handle.id);
                }
                assert_eq!(status == SDEF_STATUS_OK, handle.id != 0);
                ("create", status)
            }
            3 | 4 => {
                let id = self.handle(0);
                if self.is_lasting(id) {
                    return;
                }
                let (skeleton, count) = self.skeleton(memory);
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_character_set_skeleton(SdefCharacter { id }, skeleton, error)
                });
                if status == SDEF_STATUS_OK {
                    self.joints.insert(id, count);
                }
                ("set_skeleton", status)
            }
            5..10 => {
                let id = self.handle(0);
                if self.is_lasting(id) {
                    return;
                }
                let joint_count = self.joints.get(&id).copied().unwrap_or(0);
                let (mesh, known) = self.mesh(memory, joint_count);
                // What says how an array is to be read cannot be left out where the array is there.
                let least = match (mesh.row_starts.is_null(), mesh.index_type) {
                    (false, _) => size_of::<SdefMesh>(),
                    (true, SDEF_TYPE_U8 | SDEF_TYPE_U16) => offset_of!(SdefMesh, weight_type),
                    (true, _) => 0,
                };
                let mesh = memory.sized_from(&mut self.bytes, &mesh, true, least);
                let mut index = u32::MAX;
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_character_add_mesh(SdefCharacter { id }, mesh, &mut index, error)
                });
                if status == SDEF_STATUS_OK {
                    // A shorter struct of the caller's leaves things out: ask what there is.
                    let mut info =
                        SdefCharacterInfo { struct_size: size_of::<SdefCharacterInfo>() as u32, ..zeroed() };
                    let all = self.meshes.entry(id).or_default();
                    let before: u64 = all.iter().map(|mesh| mesh.vertices as u64).sum();
                    unsafe { sdef_character_get_info(SdefCharacter { id }, &mut info, null_mut()) };
                    assert_eq!(index + 1, info.mesh_count);
                    // Callbacks add meshes too, without a vertex.
                    assert!(all.len() <= index as usize);
                    all.resize(
                        index as usize,
                        Known { vertices: 0, normals: false, tangents: false, targets: 0 },
                    );
                    all.push(Known { vertices: (info.vertex_count - before) as usize, ..known });
                }
                ("add_mesh", status)
            }
            10 | 11 => {
                let id = self.handle(0);
                if self.is_lasting(id) {
                    return;
                }
                let all = self.meshes.get(&id).cloned().unwrap_or_default();
                let mesh = match self.bytes.byte() {
                    0..240 => self.bytes.below(all.len()) as u32,
                    _ => self.bytes.u32(),
                };
                let count = all.get(mesh as usize).map_or(5, |mesh| mesh.vertices);
                let bytes = &mut self.bytes;
                let strides = [(); 3].map(|()| stride(bytes, 12));
                let mut deltas = |stride: usize, wanted: u8| {
                    if !bytes.chance(wanted) {
                        return null();
                    }
                    let zero = bytes.chance(100);
                    let deltas: Vec<[f32; 3]> =
                        (0..count).map(|_| if zero { [0.0; 3] } else { bytes.point().to_array() }).collect();
                    memory.input(bytes, &deltas, held(stride, 12)).cast::<f32>()
                };
                let target = SdefMorphTarget {
                    struct_size: 0,
                    reserved: 0,
                    positions: deltas(strides[0], 250),
                    position_stride: strides[0],
                    normals: deltas(strides[1], 60),
                    normal_stride: strides[1],
                    tangents: deltas(strides[2], 60),
                    tangent_stride: strides[2],
                    name: null(),
                };
                let target = SdefMorphTarget { name: memory.text(bytes), ..target };
                let target = memory.sized(bytes, &target, true);
                let status = ask(bytes, |error| unsafe {
                    sdef_character_add_morph_target(SdefCharacter { id }, mesh, target, error)
                });
                if status == SDEF_STATUS_OK {
                    // One that a callback has added is not known.
                    if let Some(known) = self.meshes.get_mut(&id).and_then(|all| all.get_mut(mesh as usize)) {
                        known.targets += 1;
                    }
                }
                ("add_morph_target", status)
            }
            12 if self.bytes.chance(60) => {
                let id = self.handle(0);
                if self.is_lasting(id) {
                    return;
                }
                let bytes = &mut self.bytes;
                let (width, height) = (1 + bytes.below(9), 1 + bytes.below(9));
                let row_stride = stride(bytes, width);
                let size = (height - 1) * held(row_stride, width) + width;
                let pixels: Vec<u8> = (0..size).map(|_| bytes.byte()).collect();
                let image = SdefImage {
                    width: if bytes.chance(10) { 0 } else { width as u32 },
                    height: height as u32,
                    pixels: memory.input_or_null(bytes, &pixels, 0),
                    row_stride,
                    ..zeroed()
                };
                let image = memory.sized(bytes, &image, true);
                let mut number = 0;
                let status = ask(bytes, |error| unsafe {
                    sdef_character_add_image(SdefCharacter { id }, image, &mut number, error)
                });
                assert_eq!(status == SDEF_STATUS_OK, number != 0);
                ("add_image", status)
            }
            12 if self.bytes.chance(60) => {
                let id = self.handle(0);
                if self.is_lasting(id) {
                    return;
                }
                let bytes = &mut self.bytes;
                let eyes = [(); 2].map(|()| vec![[(); 3].map(|()| bytes.number())]);
                let hints = SdefFaceHints {
                    eye: memory.input_or_null(bytes, &eyes[0], 0).cast(),
                    other_eye: memory.input_or_null(bytes, &eyes[1], 0).cast(),
                    half_width: if bytes.chance(128) { 0.0 } else { bytes.number() },
                    half_height: if bytes.chance(128) { 0.0 } else { bytes.number() },
                    ..zeroed()
                };
                let hints = memory.sized(bytes, &hints, true);
                let status = ask(bytes, |error| unsafe {
                    sdef_character_set_face_hints(SdefCharacter { id }, hints, error)
                });
                ("set_face_hints", status)
            }
            12 => {
                let id = self.handle(0);
                let info: SdefCharacterInfo = zeroed();
                let info = memory.sized(&mut self.bytes, &info, false);
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_character_get_info(SdefCharacter { id }, info, error)
                });
                ("get_info", status)
            }
            13 => {
                let id = self.handle(0);
                let bytes = &mut self.bytes;
                let capacity = if bytes.chance(60) { bytes.below(12) } else { 80 };
                let mut count = usize::MAX;
                let status = {
                    let parents = memory.output(bytes, capacity, 0);
                    let roles = memory.output(bytes, capacity, 0);
                    let rests = memory.output::<[f64; 16]>(bytes, capacity, 0).cast();
                    let confidence = memory.output(bytes, capacity, 0);
                    ask(bytes, |error| unsafe {
                        sdef_character_get_joints(
                            SdefCharacter { id },
                            parents,
                            roles,
                            rests,
                            confidence,
                            capacity,
                            &mut count,
                            error,
                        )
                    })
                };
                assert!(status != SDEF_STATUS_BUFFER_TOO_SMALL || count > capacity);
                ("character_get_joints", status)
            }
            14 => {
                let id = self.handle(0);
                let all = self.meshes.get(&id).cloned().unwrap_or_default();
                let bytes = &mut self.bytes;
                let mesh = if bytes.chance(240) { bytes.below(all.len()) as u32 } else { bytes.u32() };
                let most =
                    if bytes.chance(240) { bytes.below(9) as u32 } else { bytes.of(&[255, 256, u32::MAX]) };
                let capacity = if bytes.chance(30) {
                    bytes.below(12)
                } else {
                    all.get(mesh as usize).map_or(4, |m| m.vertices)
                };
                let numbers = capacity * most.min(300) as usize;
                let joints = memory.output(bytes, numbers, 0);
                let weights = memory.output(bytes, numbers, 0);
                let status = ask(bytes, |error| unsafe {
                    sdef_character_get_weights(
                        SdefCharacter { id },
                        mesh,
                        most,
                        joints,
                        weights,
                        capacity,
                        error,
                    )
                });
                ("get_weights", status)
            }
            15 => {
                let id = self.handle(0);
                if id != 0 && (self.is_lasting(id) || !self.may_work(RIG)) {
                    return;
                }
                let options = self.options(memory);
                let options = if options.is_null() { &DEFAULTS.with(|defaults| *defaults) } else { options };
                let (progress, watcher) = self.progress();
                let user = (&raw const watcher).cast_mut().cast();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_character_rig(SdefCharacter { id }, options, progress, user, error)
                });
                ("rig", status)
            }
            16 => {
                let kind = self.bytes.of(&[0, 2]);
                let id = self.handle(kind);
                let capacity = if self.bytes.chance(100) { self.bytes.below(200) } else { 4000 };
                let text = memory.output(&mut self.bytes, capacity, 0);
                let mut size = 0;
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_get_warnings(id, text, capacity, &mut size, error)
                });
                ("get_warnings", status)
            }
            17 | 18 => {
                let heads = if self.bytes.chance(200) {
                    2.0 + self.bytes.tame().abs() / 4.0
                } else {
                    self.bytes.number()
                };
                let id = self.handle(1);
                let mut style = SdefStyle::default();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_style_from_heads(heads, SdefStyle { id }, &mut style, error)
                });
                if status == SDEF_STATUS_OK {
                    self.given(1, style.id);
                }
                ("style_from_heads", status)
            }
            19 | 20 => {
                let bytes = &mut self.bytes;
                let text = match bytes.byte() {
                    0..160 => bytes.of(&["sd2", "sd2.5", "sd3", " sd4\n"]).as_bytes().to_vec(),
                    160..220 => {
                        let mut text = STYLE.with(Vec::clone);
                        for _ in 0..1 + bytes.below(4) {
                            if text.len() < 2 {
                                break;
                            }
                            let at =
                                usize::from(u16::from_le_bytes([bytes.byte(), bytes.byte()])) % text.len();
                            match bytes.below(4) {
                                0 => text[at] = bytes.byte(),
                                1 => drop(text.remove(at)),
                                2 => text.insert(at, bytes.of(b"0123456789-.e{}[]\",:n")),
                                _ => text.truncate(at.max(1)),
                            }
                        }
                        text
                    }
                    _ => {
                        let length = bytes.below(60);
                        (0..length).map(|_| bytes.byte()).collect()
                    }
                };
                let start = memory.input_or_null(bytes, &text, 0);
                let size = if start.is_null() && bytes.chance(128) { too_many(bytes) } else { text.len() };
                let mut style = SdefStyle::default();
                let status = ask(bytes, |error| unsafe {
                    sdef_style_from_text(start.cast(), size, &mut style, error)
                });
                if status == SDEF_STATUS_OK {
                    self.given(1, style.id);
                }
                ("style_from_text", status)
            }
            21 => {
                let id = self.handle(0);
                if id != 0 && !self.may_work(MEASURE) {
                    return;
                }
                let options = self.options(memory);
                let name = memory.text(&mut self.bytes);
                let mut style = SdefStyle::default();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_style_measure(SdefCharacter { id }, name, options, &mut style, error)
                });
                if status == SDEF_STATUS_OK {
                    self.given(1, style.id);
                }
                ("measure", status)
            }
            22 => {
                let bytes = &mut self.bytes;
                let mut numbers = [0.0f64; 21];
                let wild = bytes.chance(60);
                for number in &mut numbers {
                    *number = if wild { bytes.number() } else { bytes.tame().abs() };
                }
                let mut all: SdefStyleNumbers = zeroed();
                unsafe { (&raw mut all).cast::<f64>().add(1).copy_from_nonoverlapping(numbers.as_ptr(), 21) };
                let count = bytes.below(6);
                let bones: Vec<SdefBone> = (0..count)
                    .map(|_| SdefBone {
                        struct_size: sizes(bytes, size_of::<SdefBone>()),
                        end: u32::from(bytes.byte() % 58),
                        length: bytes.number(),
                        radius: bytes.number(),
                    })
                    .collect();
                let bones = memory.input_or_null(bytes, &bones, 0);
                let name = memory.text(bytes);
                let numbers = memory.sized(bytes, &all, false);
                let mut style = SdefStyle::default();
                let status = ask(bytes, |error| unsafe {
                    sdef_style_from_numbers(name, numbers, bones, count, &mut style, error)
                });
                if status == SDEF_STATUS_OK {
                    self.given(1, style.id);
                }
                ("style_from_numbers", status)
            }
            23 => {
                let (first, second) = (self.handle(1), self.handle(1));
                let amount = self.bytes.number();
                let mut style = SdefStyle::default();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_style_blend(
                        SdefStyle { id: first },
                        SdefStyle { id: second },
                        amount,
                        &mut style,
                        error,
                    )
                });
                if status == SDEF_STATUS_OK {
                    self.given(1, style.id);
                }
                ("blend", status)
            }
            24 => {
                let id = self.handle(1);
                let bytes = &mut self.bytes;
                let capacity = if bytes.chance(60) { bytes.below(12) } else { 56 };
                let numbers: SdefStyleNumbers = zeroed();
                let numbers = memory.sized(bytes, &numbers, false);
                let bones = memory.struct_outputs(bytes, capacity);
                let mut count = 0;
                let status = ask(bytes, |error| unsafe {
                    sdef_style_get_numbers(SdefStyle { id }, numbers, bones, capacity, &mut count, error)
                });
                ("style_get_numbers", status)
            }
            25 => {
                let id = self.handle(1);
                let bytes = &mut self.bytes;
                let capacity = if bytes.chance(100) { bytes.below(200) } else { 8000 };
                let text: *mut c_char = memory.output(bytes, capacity, 0);
                let mut size = 0;
                let status = ask(bytes, |error| unsafe {
                    sdef_style_to_json(SdefStyle { id }, text, capacity, &mut size, error)
                });
                if status == SDEF_STATUS_OK && !text.is_null() {
                    // What is saved can be loaded.
                    let mut style = SdefStyle::default();
                    let again = unsafe { sdef_style_from_text(text, size - 1, &mut style, null_mut()) };
                    assert_eq!(again, SDEF_STATUS_OK);
                    unsafe { sdef_destroy(style.id, null_mut()) };
                }
                ("to_json", status)
            }
            26 | 27 => {
                let (character, style) = (self.handle(0), self.handle(1));
                if character != 0 && style != 0 && !self.may_work(DEFORM) {
                    return;
                }
                let options = self.options(memory);
                let (progress, watcher) = self.progress();
                let user = (&raw const watcher).cast_mut().cast();
                let mut deformer = SdefDeformer::default();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_deformer_create(
                        SdefCharacter { id: character },
                        SdefStyle { id: style },
                        options,
                        progress,
                        user,
                        &mut deformer,
                        error,
                    )
                });
                if status == SDEF_STATUS_OK {
                    self.given(2, deformer.id);
                    let meshes = self.meshes.get(&character).cloned().unwrap_or_default();
                    self.meshes.insert(deformer.id, meshes);
                }
                ("deformer_create", status)
            }
            28 => {
                let (id, style) = (self.handle(2), self.handle(1));
                if id != 0 && (self.is_lasting(id) || !self.may_work(DEFORM)) {
                    return;
                }
                let (progress, watcher) = self.progress();
                let user = (&raw const watcher).cast_mut().cast();
                let status = ask(&mut self.bytes, |error| unsafe {
                    let style = SdefStyle { id: style };
                    sdef_deformer_set_style(SdefDeformer { id }, style, progress, user, error)
                });
                ("set_style", status)
            }
            29 => {
                let id = self.handle(2);
                if id != 0 && (self.is_lasting(id) || !self.may_work(DEFORM)) {
                    return;
                }
                let options = self.options(memory);
                let (progress, watcher) = self.progress();
                let user = (&raw const watcher).cast_mut().cast();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_deformer_set_options(SdefDeformer { id }, options, progress, user, error)
                });
                ("set_options", status)
            }
            30 | 31 => {
                let id = self.handle(2);
                let known = self.meshes.get(&id).cloned().unwrap_or_default();
                let (results, count) = self.results(memory, &known);
                let (progress, watcher) = self.progress();
                let user = (&raw const watcher).cast_mut().cast();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_deformer_apply(SdefDeformer { id }, results, count, progress, user, error)
                });
                ("apply", status)
            }
            32 => {
                let id = self.handle(2);
                let bytes = &mut self.bytes;
                let capacity = if bytes.chance(60) { bytes.below(12) } else { 80 };
                let positions = memory.output::<[f64; 3]>(bytes, capacity, 0).cast();
                let binds = memory.output::<[f64; 16]>(bytes, capacity, 0).cast();
                let mut count = 0;
                let status = ask(bytes, |error| unsafe {
                    sdef_deformer_get_joints(
                        SdefDeformer { id },
                        positions,
                        binds,
                        capacity,
                        &mut count,
                        error,
                    )
                });
                ("deformer_get_joints", status)
            }
            33 => {
                let id = self.handle(2);
                let bytes = &mut self.bytes;
                let count = bytes.below(6);
                let joints: Vec<u32> = (0..count).map(|_| u32::from(bytes.byte() % 14)).collect();
                let points: Vec<[f64; 3]> = (0..count).map(|_| [(); 3].map(|()| bytes.number())).collect();
                let mut joints = memory.input_or_null(bytes, &joints, 0);
                let points = memory.input_or_null(bytes, &points, 0).cast();
                let mut positions = memory.output::<[f64; 3]>(bytes, count, 0).cast();
                let mut scales = memory.output(bytes, count, 0);
                let mut jacobians = memory.output::<[f64; 9]>(bytes, count, 0).cast();
                let count = match bytes.chance(5) {
                    true => {
                        joints = null();
                        (positions, scales, jacobians) = (null_mut(), null_mut(), null_mut());
                        too_many(bytes)
                    }
                    false => count,
                };
                let status = ask(bytes, |error| unsafe {
                    sdef_deformer_map_points(
                        SdefDeformer { id },
                        joints,
                        points,
                        count,
                        positions,
                        scales,
                        jacobians,
                        error,
                    )
                });
                ("map_points", status)
            }
            34 => {
                let id = self.handle(2);
                let bytes = &mut self.bytes;
                let capacity = if bytes.chance(60) { bytes.below(12) } else { 30 };
                let groups = memory.struct_outputs(bytes, capacity);
                let mut count = 0;
                let status = ask(bytes, |error| unsafe {
                    sdef_deformer_get_groups(SdefDeformer { id }, groups, capacity, &mut count, error)
                });
                ("get_groups", status)
            }
            35 => {
                let id = self.handle(2);
                // The report of a lasting deformer is made once.
                if id != 0 && !self.is_lasting(id) && !self.may_work(MEASURE) {
                    return;
                }
                let bytes = &mut self.bytes;
                let capacity = if bytes.chance(60) { bytes.below(255) } else { 20000 };
                let report: SdefReport = zeroed();
                let report = memory.sized(bytes, &report, false);
                let json = memory.output(bytes, capacity, 0);
                let mut size = 0;
                let status = ask(bytes, |error| unsafe {
                    sdef_deformer_get_report(SdefDeformer { id }, report, json, capacity, &mut size, error)
                });
                ("get_report", status)
            }
            36 => {
                let kind = self.bytes.below(3);
                let id = self.handle(kind);
                if self.is_lasting(id) {
                    return;
                }
                let status = ask(&mut self.bytes, |error| unsafe { sdef_destroy(id, error) });
                ("destroy", status)
            }
            38 => {
                let id = self.handle(2);
                if id != 0 && !self.is_lasting(id) && !self.may_work(MEASURE) {
                    return;
                }
                let bytes = &mut self.bytes;
                let which = bytes.below(4) as u32;
                let figure: SdefFigure = zeroed();
                let figure = memory.sized(bytes, &figure, false);
                let status = ask(bytes, |error| unsafe {
                    sdef_deformer_get_figure(SdefDeformer { id }, which, figure, error)
                });
                ("get_figure", status)
            }
            37 => {
                let bytes = &mut self.bytes;
                let own = size_of::<SdefOptions>();
                let size = match bytes.byte() {
                    0..200 => 4 * bytes.below(own / 4 + 20),
                    _ => bytes.of(&[0, 3, 9, 1 << 17, u32::MAX as usize]),
                };
                let held = if size > 1 << 16 { 0 } else { size };
                let options = memory.output::<u8>(bytes, held, 0).cast();
                let status = ask(bytes, |error| unsafe { sdef_options_init(options, size as u32, error) });
                ("options_init", status)
            }
            _ => {
                let style = self.handle(1);
                if style != 0 && !self.may_work(RIG) {
                    return;
                }
                let with_skeleton = self.bytes.chance(160);
                let (skeleton, joint_count) = if with_skeleton { self.skeleton(memory) } else { (null(), 0) };
                let count = self.bytes.below(3);
                let mut meshes = Vec::new();
                let mut all = Vec::new();
                for _ in 0..count {
                    let (mesh, known) = self.mesh(memory, joint_count);
                    meshes.push(SdefMesh { struct_size: size_of::<SdefMesh>() as u32, ..mesh });
                    all.push(known);
                }
                let meshes = memory.input_or_null(&mut self.bytes, &meshes, 0);
                let (results, results_count) = self.results(memory, &all);
                if results_count != count {
                    return;
                }
                let options = self.options(memory);
                let options = if options.is_null() { &DEFAULTS.with(|defaults| *defaults) } else { options };
                let (progress, watcher) = self.progress();
                let user = (&raw const watcher).cast_mut().cast();
                let status = ask(&mut self.bytes, |error| unsafe {
                    sdef_super_deform(
                        null(),
                        null(),
                        skeleton,
                        meshes,
                        count,
                        SdefStyle { id: style },
                        options,
                        results,
                        progress,
                        user,
                        error,
                    )
                });
                ("super_deform", status)
            }
        };
        if status != SDEF_STATUS_OK {
            memory.nothing_was_written(what);
        }
    }
}

thread_local! {
    /// A saved style, to be damaged.
    static STYLE: Vec<u8> = superdeform::BodyShape::built_in("sd3").unwrap().to_json().into_bytes();
    /// Options that cost little.
    static DEFAULTS: SdefOptions = {
        let mut options: SdefOptions = zeroed();
        unsafe { sdef_options_init(&mut options, size_of::<SdefOptions>() as u32, null_mut()) };
        SdefOptions { thread_count: 1, rays: 3, rig_voxel_resolution: 16, ..options }
    };
}

/// A character with joints, one with a made rig, a style, and deformers of both: what is read need not be made anew.
struct Lasting {
    handles: Vec<(usize, u64)>,
    meshes: BTreeMap<u64, Vec<Known>>,
    joints: BTreeMap<u64, usize>,
}

static LASTING: OnceLock<Lasting> = OnceLock::new();

/// Before the first run.
pub fn start() {
    static NONE: Lasting = Lasting { handles: Vec::new(), meshes: BTreeMap::new(), joints: BTreeMap::new() };
    let options = DEFAULTS.with(|defaults| *defaults);
    // Bytes that choose a figure without joints, and one with them.
    let mut host = Host::new(&[0, 255, 0, 0], &NONE, true);
    let mut style = SdefStyle::default();
    unsafe {
        host.person();
        let bare = SdefCharacter { id: host.handles[0].1 };
        assert_eq!(sdef_character_rig(bare, &options, None, null_mut(), null_mut()), SDEF_STATUS_OK);
        host.person();
        assert_eq!(sdef_style_from_text(c"sd3".as_ptr(), 3, &mut style, null_mut()), SDEF_STATUS_OK);
        host.given(1, style.id);
        for index in 0..2 {
            let character = SdefCharacter { id: host.handles[index].1 };
            let mut made = SdefDeformer::default();
            let status =
                sdef_deformer_create(character, style, &options, None, null_mut(), &mut made, null_mut());
            assert_eq!(status, SDEF_STATUS_OK);
            host.given(2, made.id);
            let meshes = host.meshes[&character.id].clone();
            host.meshes.insert(made.id, meshes);
        }
    }
    // The first call has set the library's own hook, which would keep panics quiet.
    panics_abort();
    let Host { handles, meshes, joints, .. } = host;
    assert!(LASTING.set(Lasting { handles, meshes, joints }).is_ok());
}

impl<'a> Host<'a> {
    fn new(data: &'a [u8], lasting: &'static Lasting, deep: bool) -> Self {
        Self {
            bytes: Bytes(data),
            lasting,
            deep,
            handles: lasting.handles.clone(),
            meshes: lasting.meshes.clone(),
            joints: lasting.joints.clone(),
            budget: BUDGET,
        }
    }
}

/// Whether a run makes calls that take long: one in 128, by its bytes, or each where SUPERDEFORM_FUZZ_DEEP is set.
fn is_deep(data: &[u8]) -> bool {
    static ALWAYS: OnceLock<bool> = OnceLock::new();
    let hash = data.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
    });
    *ALWAYS.get_or_init(|| std::env::var_os("SUPERDEFORM_FUZZ_DEEP").is_some()) || (hash >> 32) % 128 == 0
}

pub fn run(data: &[u8]) {
    let lasting = LASTING.get().expect("it was made at the start");
    let mut host = Host::new(data, lasting, is_deep(data));
    for _ in 0..24 {
        if host.bytes.is_empty() {
            break;
        }
        host.call();
    }
    for (_, id) in host.handles.drain(lasting.handles.len()..) {
        let status = unsafe { sdef_destroy(id, null_mut()) };
        assert!(matches!(status, SDEF_STATUS_OK | SDEF_STATUS_BAD_HANDLE));
    }
    assert_eq!(sdef_live_handles() as usize, lasting.handles.len());
}
