//! Turns a normal 3D character into its super-deformed (SD, chibi) version: stubby limbs, a large head, a young face.
//!
//! The method is that of Wang, Kanamori, Endo and Mitani, *Body-shape Transfer for Super Deformation of 3D Character
//! Models*: the proportions of an SD reference are measured and given to a target.
//!
//! # The paper on one page
//!
//! | Section | What | Where |
//! | --- | --- | --- |
//! | III, IV-A | meshes, joints, weights, humanoid roles | [`character`] |
//! | IV-B, Fig. 4 | a rig for what has none: joints, weights, clothes | [`rig`], [`pipeline::Rig`] |
//! | V-A, Fig. 5 | bone lengths and surrounding-mesh radii | [`shape::measure()`] |
//! | V-B3, Eqs. 9-11 | how much each bone group shrinks | [`shape::coefficients()`] |
//! | V-B1, Eqs. 1-4 | the shortened skeleton | [`shape::shorten()`] |
//! | V-B2, Eqs. 5-8 | the mesh follows, then its thickness is adjusted | [`shape::BoneField`] |
//! | VI, Eqs. 12-13 | a younger face | [`face`] |
//! | VII | shorter hair, which the paper does by hand | [`hair`] |
//!
//! # Two modes
//!
//! [`Mode::Paper`](pipeline::Mode::Paper) is the paper's chain of bones, literally. Real characters put the neck and the
//! head joint where each artist likes, and the chain adds these habits up: heads end in chests, arms above eyes. So
//! [`Mode::Product`](pipeline::Mode::Product), the default, keeps the idea (measure, transfer, blend by weights) and
//! reads five landmarks from the geometry instead ([`shape::product::landmarks`]); fifteen parts move by one map each and agree
//! where they meet ([`shape::product::field`]).
//!
//! Either way the deformation is a field, from a point and its weights to a place and a Jacobian ([`shape::field`]), and
//! everything goes through it: vertices, morph targets, joints, and any point that hangs from a joint.
//!
//! # From files to a result
//!
//! The library knows arrays, not files. Hosts read a file into a [`Character`], measure a reference
//! ([`Measured`](shape::Measured)), make a [`Deformer`](pipeline::Deformer) and apply it; `examples/superdeform.rs` does so
//! with GLB and VRM files. Hosts in C, C++ and C# do the same through [`ffi`] and `include/superdeform.h`.
//!
//! ```
//! use superdeform::pipeline::{Deformer, Options, Style};
//! use superdeform::{Character, Joint, Mesh, Role, Weights};
//! use glam::{DMat4, DVec3, Vec3};
//! use std::sync::Arc;
//!
//! // A figure of eight boxes, one for each joint.
//! let mut character = Character::default();
//! let boxes = [
//!     (Role::Hips, [0.0, 1.0, 0.0], [0.15, 0.25, 0.1]),
//!     (Role::Head, [0.0, 1.55, 0.0], [0.1, 0.12, 0.1]),
//!     (Role::LeftUpperArm, [0.2, 1.4, 0.0], [0.25, 0.05, 0.05]),
//!     (Role::RightUpperArm, [-0.2, 1.4, 0.0], [0.25, 0.05, 0.05]),
//!     (Role::LeftUpperLeg, [0.1, 0.8, 0.0], [0.06, 0.4, 0.06]),
//!     (Role::RightUpperLeg, [-0.1, 0.8, 0.0], [0.06, 0.4, 0.06]),
//! ];
//! for (index, (role, joint, half)) in boxes.into_iter().enumerate() {
//!     let at = DVec3::from_array(joint);
//!     let parent = (index > 0).then_some(0);
//!     character.skeleton.joints.push(Joint { name: role.to_string(), parent, rest: DMat4::from_translation(at) });
//!     character.humanoid.set(role, index);
//!     let out = if joint[0] == 0.0 { Vec3::Y } else if joint[1] > 1.0 { Vec3::X * joint[0].signum() as f32 } else { Vec3::NEG_Y };
//!     let half = Vec3::from_array(half);
//!     let centre = at.as_vec3() + out * half;
//!     let positions: Vec<Vec3> = (0..8)
//!         .map(|corner| {
//!             let sign = |bit: i32| if corner & bit == 0 { -1.0 } else { 1.0 };
//!             centre + half * Vec3::new(sign(1), sign(2), sign(4))
//!         })
//!         .collect();
//!     let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
//!     let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
//!     let weights = Weights::rigid(index as u32, positions.len());
//!     character.meshes.push(Mesh { name: role.to_string(), positions, triangles, weights, ..Mesh::default() });
//! }
//!
//! let deformer = Deformer::new(Arc::new(character), &Style::heads(3.0)?, &Options::default())?;
//! let result = deformer.apply();
//! let report = deformer.report(&result)?;
//! assert!(report.result.heads < report.target.heads);
//! # Ok::<(), superdeform::Error>(())
//! ```
//!
//! # Units, axes, determinism
//!
//! Any unit; any up; the way a character looks is given or found from its limbs. Winding, vertex order and weights are
//! never changed. Joints move; they neither turn nor scale. Results are the same bits for any number of threads and on
//! every run.

pub mod character;
pub mod error;
pub mod face;
pub mod ffi;
pub mod geometry;

pub mod options;
pub mod parallel;
pub mod pipeline;
pub mod progress;
pub mod report;
pub mod rig;
pub mod shape;

pub use character::{Axes, Character, Humanoid, Joint, Mesh, MeshKind, MorphTarget, Role, Skeleton, Weights};
pub use error::{Error, ErrorKind, Result, Warning};
