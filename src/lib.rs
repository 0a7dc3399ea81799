//! Turns a normal 3D character into its super-deformed (SD, chibi) version.

pub mod character;
pub mod error;
pub mod face;
pub mod geometry;
pub mod hair;
pub mod options;
pub mod parallel;
pub mod pipeline;
pub mod report;
pub mod shape;

pub use character::{Axes, Character, Humanoid, Joint, Mesh, MeshKind, MorphTarget, Role, Skeleton, Weights};
pub use error::{Error, ErrorKind, Result, Warning};
