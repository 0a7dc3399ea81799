//! The sample pair, which the program brings along: it runs where no source is.

/// A character within the program.
#[derive(Debug, PartialEq, Eq)]
pub struct Sample {
    /// Its file's name.
    pub name: &'static str,
    /// A GLB.
    pub bytes: &'static [u8],
}

/// A grown-up without a rig: the target where none is given.
pub static TARGET: Sample = Sample {
    name: "quaternius_female_dress_unrigged.glb",
    bytes: include_bytes!("../../tests/data/quaternius_female_dress_unrigged.glb"),
};

/// A figure of few heads: the reference where none is given.
pub static REFERENCE: Sample =
    Sample { name: "kaykit_rogue.glb", bytes: include_bytes!("../../tests/data/kaykit_rogue.glb") };
