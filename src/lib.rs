//! Turns a normal 3D character into its super-deformed (SD, chibi) version: stubby limbs, a large head, a young face.
//!
//! The method is that of Wang, Kanamori, Endo and Mitani, *Body-shape Transfer for Super Deformation of 3D Character
//! Models*: the proportions of an SD reference are measured and given to a target.
//!
//! ```
//! use glam::{DMat4, DVec3, Vec3};
//! use superdeform::{Character, Deformer, Joint, Mesh, Options, Role, Style, Weights};
//!
//! // A figure of six boxes (middle, half size), one for each joint that is needed.
//! let mut character = Character::default();
//! for (index, (role, joint, middle, half)) in [
//!     (Role::Hips, [0.0, 1.0, 0.0], [0.0, 1.2, 0.0], [0.15, 0.3, 0.1]),
//!     (Role::Head, [0.0, 1.55, 0.0], [0.0, 1.67, 0.0], [0.1, 0.12, 0.1]),
//!     (Role::LeftUpperArm, [0.2, 1.4, 0.0], [0.4, 1.4, 0.0], [0.25, 0.05, 0.05]),
//!     (Role::RightUpperArm, [-0.2, 1.4, 0.0], [-0.4, 1.4, 0.0], [0.25, 0.05, 0.05]),
//!     (Role::LeftUpperLeg, [0.1, 0.8, 0.0], [0.1, 0.4, 0.0], [0.06, 0.4, 0.06]),
//!     (Role::RightUpperLeg, [-0.1, 0.8, 0.0], [-0.1, 0.4, 0.0], [0.06, 0.4, 0.06]),
//! ]
//! .into_iter()
//! .enumerate()
//! {
//!     let rest = DMat4::from_translation(DVec3::from_array(joint));
//!     let parent = (index > 0).then_some(0);
//!     character.skeleton.joints.push(Joint { name: role.to_string(), parent, rest });
//!     character.humanoid.set(role, index);
//!     let corner = |bits: usize| Vec3::from_array([0, 1, 2].map(|axis| (bits >> axis & 1) as f32 * 2.0 - 1.0));
//!     let positions = (0..8).map(|bits| Vec3::from_array(middle) + corner(bits) * Vec3::from_array(half)).collect();
//!     let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
//!     let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
//!     let weights = Weights::rigid(index as u32, 8);
//!     character.meshes.push(Mesh { name: role.to_string(), positions, triangles, weights, ..Mesh::default() });
//! }
//!
//! let deformer = Deformer::new(character.into(), &Style::heads(3.0)?, &Options::default())?;
//! let report = deformer.report(&deformer.apply())?;
//! assert!(report.result.heads < report.target.heads);
//! # Ok::<(), superdeform::Error>(())
//! ```
//!
//! # From files to a result
//!
//! The library knows arrays, not files. Hosts read a file into a [`Character`], measure a reference ([`Style::of`]) or ask
//! for a number of heads ([`Style::heads`]), make a [`Rig`] where there is none, make a [`Deformer`] and apply it;
//! `examples/minimal.rs` does so in forty lines, `examples/superdeform` is the command line for GLB and VRM files. Hosts in
//! C, C++ and C# do the same through `include/superdeform.h`.
//!
//! # The paper on one page
//!
//! | Section | What | Where |
//! | --- | --- | --- |
//! | III, IV-A | meshes, joints, weights, humanoid roles | `src/character` |
//! | IV-B, Fig. 4 | a rig for what has none: joints, weights, clothes | `src/rig` |
//! | V-A, Fig. 5 | bone lengths and surrounding-mesh radii | `src/shape/measure.rs` |
//! | V-B3, Eqs. 9-11 | how much each bone group shrinks | `src/shape/paper/alpha_beta.rs` |
//! | V-B1, Eqs. 1-4 | the shortened skeleton | `src/shape/paper/shorten.rs` |
//! | V-B2, Eqs. 5-8 | the mesh follows, then its thickness is adjusted | `src/shape/paper/bone_field.rs` |
//! | VI, Eqs. 12-13 | a younger face | `src/face.rs` |
//! | VII | shorter hair, which the paper does by hand | `src/shape/product/hanging.rs` |
//!
//! # Two modes
//!
//! [`Mode::Paper`] is the paper's chain of bones, literally. Real characters put the neck and the head joint where each
//! artist likes, and the chain adds these habits up: heads end in chests, arms above eyes. So [`Mode::Product`], the
//! default, keeps the idea (measure, transfer, blend by weights) and reads five landmarks from the geometry instead
//! (`src/shape/product/landmarks.rs`); fifteen parts of the body and its hair move by one map each and agree where they
//! meet (`src/shape/product/parts_field.rs`). `src/pipeline` puts the stages of both in order.
//!
//! Either way the deformation is a field, from a point and its weights to a place and a Jacobian (`src/shape/field.rs`), and
//! everything goes through it: vertices, morph targets, joints, and any point that hangs from a joint.
//!
//! Where the paper's text can be read in two ways, or is silent, a decision has a number (D1 to D33) that the source cites;
//! `docs/method.md` of the repository says what was decided and what was seen, `docs/constants.md` what each number does.
//!
//! # Units, axes, determinism
//!
//! Any unit; any up; the way a character looks is given or found from its limbs. Winding, vertex order and weights are
//! never changed. Joints move; they neither turn nor scale. Results are the same bits for any number of threads and on
//! every run.

// What only the C ABI calls stands beside the rest.
#![cfg_attr(all(target_arch = "wasm32", not(feature = "exports")), allow(dead_code))]

mod character;
mod clock;
mod error;
mod face;
// Its comments are the header's too, where brackets are indices of arrays. A library of WebAssembly exports it all, so
// there it is left out of what does not ask for it.
#[cfg(any(not(target_arch = "wasm32"), feature = "exports"))]
#[allow(rustdoc::broken_intra_doc_links)]
mod ffi;
mod geometry;
pub mod options;
mod parallel;
mod pipeline;
mod progress;
pub mod report;
mod rig;
mod room;
mod shape;

pub use character::roles::find_roles;
pub use character::{
    Axes, Character, EyeHint, FaceHints, GreyImage, Humanoid, Joint, Mesh, MeshKind, MorphTarget, Role,
    Shade, Skeleton, Weights,
};
pub use error::{Element, Error, ErrorKind, Result, Warning};
pub use geometry::Mapped;
pub use options::{
    FaceCurve, GarmentWeights, GroupSettings, Height, Mode, Options, Repair, RigOptions, Stage, WeightMethod,
};
pub use pipeline::{Deformed, DeformedMesh, Deformer, MeshOutputs, Rig};
pub use progress::Progress;
pub use report::Report;
pub use shape::product::anatomy::Proportions;
pub use shape::product::profile::{ArmProfile, LegProfile, Profile, SkirtProfile, TorsoProfile};
pub use shape::{BodyShape, BoneShape, Coefficient, GroupShape, Heights, Style};

/// What the project's own tests, benchmarks and hosts look into; it may change with any version.
#[doc(hidden)]
#[allow(missing_docs)]
pub mod internals {
    macro_rules! modules {
        ($($name:ident)+) => {
            $(pub mod $name {
                pub use crate::$name::*;
            })+
        };
    }
    modules! { character face geometry parallel pipeline rig shape }
    #[cfg(any(not(target_arch = "wasm32"), feature = "exports"))]
    modules! { ffi }
}
