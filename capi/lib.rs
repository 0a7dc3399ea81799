//! Links what `superdeform` exports to C; the functions themselves, and what they promise, are in its `src/ffi`.

extern crate exports as _;
