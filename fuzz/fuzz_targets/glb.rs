#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use superdeform_fuzz::{glb, in_time, panics_abort};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    glb::mutate(data, size, max_size, seed, &mut fuzzer_mutate)
});
fuzz_target!(init: panics_abort(), |data: &[u8]| in_time(|| glb::run(data)));
