//! superdeform: turns a normal 3D character into its super-deformed (SD, chibi) version.
//!
//! A character (meshes, joints, weights) and a style go in; new positions, normals, tangents, morph deltas and joints
//! come out. Vertex order, triangles and weights are never changed. The order of calls is the order of this header:
//!
//! ```text
//!     sdef_character_create, _set_skeleton, _add_mesh ...   the character, as arrays
//!     sdef_character_rig                                    only where it has no skeleton
//!     sdef_style_from_heads, _from_text, _measure ...       what it should become
//!     sdef_deformer_create, _apply, _map_points ...         made once, applied as often as something changes
//!     sdef_get_warnings, sdef_deformer_get_report           what was found on the way, and in the result
//!     sdef_destroy                                          each handle, once
//! ```
//!
//! Conventions, for all functions:
//!
//! ```text
//! Units      Any. Results are in the units of the input; angles do not occur.
//! Space      One space for everything ("model space"), in rest pose. Right-handed or left-handed, any direction up, any
//!            winding: a mirrored character gives the mirrored result. Vertices are floats, joints and points doubles.
//! Matrices   16 doubles, column by column, for column vectors: the translation is numbers 12, 13 and 14, and numbers
//!            3, 7, 11 and 15 are 0, 0, 0 and 1.
//! Results    The feet stay on the ground. The height does not: a figure of fewer heads is shorter, one that has as few
//!            already keeps its size (SdefOptions.height and head_scale ask for another). sdef_deformer_get_figure says
//!            how tall it was and is; scale what belongs to it (capsules, cameras, steps) by that.
//! Handles    A handle is a number, not an address. 0 is none. One that is destroyed, made up or of another kind gives
//!            SDEF_STATUS_BAD_HANDLE and nothing worse. In C each kind is a struct of that number, so that a compiler
//!            tells them apart; what takes any kind takes the number, its id. Where a language cannot pass structs,
//!            uint64_t is passed the same way on x86-64 and AArch64. Styles and deformers keep what they need:
//!            character and style may be changed or destroyed before them.
//! Threads    Any thread may call anything at any time. Calls that read may run beside each other on one handle; where a
//!            call that changes a handle meets another use of it, the later of the two gets SDEF_STATUS_BUSY (so does
//!            a progress callback that changes what it is called from). No thread outlives a call. Where the system
//!            starts no more threads, a call uses fewer; a host's own may do the work (sdef_set_jobs). Results are the
//!            same bits for any number of threads and on every run.
//! Arrays in  A pointer, a count, and for vertices a stride: the bytes from one element to the next, 0 for packed. They
//!            need no alignment, are read during the call and never kept, texts in structs too. NULL is allowed where
//!            the count is 0, and for arrays that may be left out, which say so.
//! Arrays out The caller's, with the number of elements that they can hold (capacity). NULL: left out. One that is too
//!            small gives SDEF_STATUS_BUFFER_TOO_SMALL, and what is needed is written where the call has a place for it,
//!            else told in the sentence. On an error nothing is written but the error, counts and sizes. They may be
//!            arrays that were given in before.
//! Text       UTF-8, NUL-terminated. A name may be NULL, for none, unless the call needs it. Sentences show 64 bytes of
//!            a name, control characters escaped.
//! Structs    Zero a struct, set struct_size = sizeof(it), fill in what there is. SdefOptions is filled by
//!            sdef_options_init, SdefGroupSettings begins as SDEF_GROUP_SETTINGS_INIT. A struct may be newer or older
//!            than the library: what an older one lacks has its default; in a newer one, what the library does not know
//!            must be 0 or NAN. One that is smaller than it was in version 1 of the ABI is refused, and so is a field
//!            called reserved that is not 0. In arrays all have the size of the first. Numbers that choose (kinds,
//!            modes) must be one of the constants; 0 and 1 stand for no and yes.
//! Changes    Within a version of the ABI what there is stays; functions, constants and fields are only added, so a host
//!            that was built runs with every later library of that version. Results are no part of it: a minor release
//!            may give better ones. Who needs the same vertices for good ships the library with the host, or keeps the
//!            vertices. A saved style keeps its numbers. On trial, which means that a minor release may change what
//!            they do, or have them do nothing: the fields of SdefOptions from youth on, and
//!            sdef_deformer_map_colliders.
//! Errors     Every call that can fail returns a SdefStatus; its last argument, which may be NULL, receives a sentence
//!            that names the array, the element, the value and the remedy.
//! Progress   A callback (NULL: none) that is called on the caller's thread alone, with a fraction that rises to 1: some
//!            twenty times by rig and deformer_create, a few times by other calls. What it returns, if not 0, ends the
//!            call with SDEF_STATUS_CANCELLED and leaves everything as it was. It may call the library, and must return:
//!            neither a C++ exception nor longjmp may leave it.
//! Memory     Every call asks for what it needs at most before it begins or, of large stages, before these; where it is
//!            not there, SDEF_STATUS_OUT_OF_MEMORY, and all is as it was. Where there is too little for more threads it
//!            works on one. The process can still end where less than 1 MiB is left, or where other threads take what
//!            was there in the meantime.
//! Cost       Cheap, microseconds: create, destroy, get_info, get_joints, map_points, styles but _measure. A pass over
//!            the vertices, some 0.1 microseconds each: add_mesh, apply, and set_options where only amount, face_squash,
//!            face_curve or thread_count change. Ten times that: set_options otherwise, and set_style. Slow, seconds at
//!            100,000 vertices: rig, deformer_create, style_measure, deformer_measure, or in its place the first
//!            get_report or get_figure after a change.
//! ```

// The C ABI, and the only unsafe code. Each module is a section of the header `include/superdeform.h`, which is generated
// from them and from the comment above: its structs, its exported functions and what they do. `tests/headers` generates
// the header, the C# imports and the layout that hosts check, and compares them with the committed files.
#![allow(unsafe_code)]
// safer-ffi exports nothing on wasm32, so there functions are exported without it; elsewhere it writes the C# imports.
#![cfg_attr(target_arch = "wasm32", allow(unused_imports))]
// The contract of every pointer stands in the header's conventions, once for all functions.
#![allow(clippy::missing_safety_doc, clippy::not_unsafe_ptr_arg_deref)]

pub mod all_at_once;
mod arrays;
pub mod basics;
pub mod character;
pub mod deformer;
// These two are public for the library of the Python wheel, whose calls are guarded the same way.
pub mod guard;
pub mod handles;
pub mod jobs;
pub mod lifetime;
pub mod memory;
pub mod options;
pub mod rig;
pub mod style_handle;
