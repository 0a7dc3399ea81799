#![no_main]

use libfuzzer_sys::fuzz_target;
use superdeform_fuzz::{abi, in_time};

fuzz_target!(init: abi::start(), |data: &[u8]| in_time(|| abi::run(data)));
