//! Memory is asked for before it is taken: where an allocation fails, Rust ends the process.

use crate::error::{Error, ErrorKind, Result};

/// Less than this is not asked for: so much is always assumed to be there.
const NOT_ASKED: usize = 1 << 18;

/// What stages take by: bytes each, a third more than was measured of people and of models.
#[derive(Clone, Copy, Debug)]
pub enum Of {
    /// Filling a cell of a solid.
    Cell = 11,
    /// A wave through a filled cell.
    Wave = 52,
    /// A vertex of the body whose weights are heat's.
    Heat = 1400,
    /// A vertex of the body whose weights are carried over.
    Skin = 1300,
    /// A vertex of the head that goes through the young face.
    Young = 260,
    /// A triangle that clothes or hair are kept outside of.
    Outside = 245,
}

/// Aligned as nothing else is, so that an allocator can tell what is only asked for.
#[repr(align(256))]
struct Block {
    _bytes: [u8; 256],
}

/// Memory that is there, until this is dropped.
pub struct Room {
    _blocks: Vec<Block>,
}

impl Room {
    /// Takes `bytes`; nothing where they are few.
    ///
    /// # Errors
    /// `ErrorKind::OutOfMemory` where they are not there.
    pub fn of(bytes: usize) -> Result<Self> {
        let mut blocks = Vec::new();
        if bytes < NOT_ASKED || blocks.try_reserve_exact(bytes.div_ceil(size_of::<Block>())).is_ok() {
            return Ok(Self { _blocks: blocks });
        }
        let message = format!(
            "there are no {} MiB of memory for this call: give less, or free some",
            bytes.div_ceil(1 << 20)
        );
        Err(Error::new(ErrorKind::OutOfMemory, message))
    }
}

/// Checks that there is memory for a stage that takes it by `count` of these. Another thread of the host may still take it
/// between asking and using.
///
/// # Errors
/// As [`Room::of`].
pub fn ask(of: Of, count: usize) -> Result<()> {
    Room::of(count.saturating_mul(of as usize)).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_there_is_is_an_error() {
        assert_eq!(ask(Of::Cell, usize::MAX / 4).unwrap_err().kind, ErrorKind::OutOfMemory);
        assert!(ask(Of::Cell, 1 << 20).is_ok());
        assert!(Room::of(1 << 20).unwrap()._blocks.capacity() >= 1 << 12);
    }
}
