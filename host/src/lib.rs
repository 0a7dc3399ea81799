//! Characters as files: GLB, VRM (0.x and 1.0) and `.gltf` in, the same file with a new shape out. [`conversion`] is the whole
//! way, for any host.
//!
//! A file is kept as raw JSON beside its binary chunk, so that all that is not reshaped comes out as it went in:
//! materials, textures, texture coordinates, names, extensions, extras, animations, accessor sharing.

pub mod accessor;
pub mod appearance;
pub mod beside;
pub mod bind;
pub mod conversion;
pub mod file;
mod frame;
pub mod image;
mod kinds;
pub mod leg_colliders;
pub mod licence;
pub mod load;
pub mod materials;
#[cfg(feature = "meshopt")]
mod meshopt;
pub mod paint;
mod primitive;
pub mod rig;
pub mod roles;
pub mod samples;
pub mod shades;
pub mod verify;
pub mod write;

/// A pattern of [`load::LoadOptions::kinds`].
pub use regex_lite::Regex;

use serde_json::Value;
use superdeform::{Error, ErrorKind};

/// An error about the input, in one sentence.
pub fn bad_input(message: impl Into<String>) -> Error {
    // Text from a file may hold line breaks; a message is one line all the same.
    let message: String = message.into();
    let one_line: Vec<&str> = message.split_whitespace().collect();
    Error::new(ErrorKind::BadInput, one_line.join(" "))
}

/// The number at `key`, where it is a whole number of 0 or more.
pub fn index_at(value: &Value, key: &str) -> Option<usize> {
    value.get(key).and_then(Value::as_u64).and_then(|index| usize::try_from(index).ok())
}

/// The array at `key`; empty where there is none.
pub fn array_at<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// The numbers of the array at `key`, where they are whole ones of 0 or more.
pub fn indices_at<'a>(value: &'a Value, key: &str) -> impl Iterator<Item = usize> + use<'a> {
    array_at(value, key).iter().filter_map(|index| usize::try_from(index.as_u64()?).ok())
}

/// The text at `key`; empty where there is none.
pub fn text_at<'a>(value: &'a Value, key: &str) -> &'a str {
    value.get(key).and_then(Value::as_str).unwrap_or("")
}
