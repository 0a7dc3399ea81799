//! Maps from the cells of a grid: whole numbers need no guarded hash.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// A map whose keys are cells of a grid.
pub type CellMap<K, V> = HashMap<K, V, BuildHasherDefault<CellHasher>>;

/// Multiplies and folds: one step for each number of a key, the same on every run.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellHasher {
    state: u64,
}

impl Hasher for CellHasher {
    fn finish(&self) -> u64 {
        self.state
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            // The high half of a product depends on all bits below it; keys may be floats whose low bits are all 0.
            let product = u128::from(self.state.rotate_left(23) ^ u64::from_le_bytes(word))
                .wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835);
            self.state = (product >> 64) as u64 ^ product as u64;
        }
    }
}
