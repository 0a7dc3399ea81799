//! What can go wrong: one sentence that names the place, the value and the way out.

use std::fmt;

/// What sort of thing was wrong, for hosts that branch on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// An array's length, index or number is wrong.
    BadInput,
    /// The humanoid roles that the method needs were not found.
    NoHumanoid,
    /// There is nothing to measure or deform: no triangles, or a body without extent.
    NoGeometry,
    /// A saved style cannot be read.
    BadStyle,
    /// An option is out of its range.
    BadOption,
    /// The host's progress callback asked to stop.
    Cancelled,
}

/// An error: its kind, the mesh and element it concerns where there are such, and one sentence for a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// What sort of thing was wrong.
    pub kind: ErrorKind,
    /// Index of the mesh concerned.
    pub mesh: Option<usize>,
    /// Index of the vertex, triangle or joint concerned.
    pub element: Option<usize>,
    /// The option concerned, as [`TABLE`](crate::options::TABLE) names it. The sentence does not: each host spells it its
    /// own way.
    pub option: Option<&'static str>,
    /// One sentence that names the place, the value and the remedy.
    pub message: String,
}

/// The crate's result.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An error of `kind` about the whole input.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self { kind, mesh: None, element: None, option: None, message: message.into() }
    }

    /// The same error, about mesh `mesh`.
    pub fn in_mesh(mut self, mesh: usize) -> Self {
        self.mesh = Some(mesh);
        self
    }

    /// The same error, about element `element` (a vertex, triangle or joint).
    pub fn at(mut self, element: usize) -> Self {
        self.element = Some(element);
        self
    }

    /// The same error, about the option `option` of the table.
    pub fn about(mut self, option: &'static str) -> Self {
        self.option = Some(option);
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// Something a person should know about a result that was given all the same.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Warning {
    /// A fixed word that tools can look for, such as `heads_limited`.
    pub code: &'static str,
    /// The option that changes it, as [`TABLE`](crate::options::TABLE) names it; hosts spell it.
    #[serde(skip)]
    pub option: Option<&'static str>,
    /// One sentence for a person.
    pub message: String,
}

impl Warning {
    /// A warning with the fixed word `code`.
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, option: None, message: message.into() }
    }

    /// The same warning, about the option `option` of the table.
    pub fn about(mut self, option: &'static str) -> Self {
        self.option = Some(option);
        self
    }
}
