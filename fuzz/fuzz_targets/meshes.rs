#![no_main]

use libfuzzer_sys::fuzz_target;
use superdeform_fuzz::{in_time, meshes, panics_abort};

fuzz_target!(init: panics_abort(), |data: &[u8]| in_time(|| meshes::run(data)));
