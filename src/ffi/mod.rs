//! The C ABI: handles, plain arrays, and one status for every call. The only unsafe code.
//!
//! What is exported stands in [`exports`], one file for each section of the header `include/superdeform.h`, which is
//! generated from them: each function there is one line into a body in this folder. `tests/headers` generates the
//! header and the C# imports and compares them with the committed ones.
#![allow(unsafe_code)]
// The contract of every pointer stands in the header's conventions, once for all functions.
#![allow(clippy::missing_safety_doc)]

mod arrays;
mod bodies;
mod character;
mod deformer;
pub mod exports;
mod guard;
mod options;
mod style;
mod table;
