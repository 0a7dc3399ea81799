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
    /// There is not as much memory as is needed.
    OutOfMemory,
}

/// What an error is about within a mesh or a skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Element {
    /// A vertex, by its index.
    Vertex(usize),
    /// A triangle, by its index.
    Triangle(usize),
    /// A joint, by its index.
    Joint(usize),
}

/// An error: its kind, the mesh and element it concerns where there are such, and one sentence for a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// What sort of thing was wrong.
    pub kind: ErrorKind,
    /// Index of the mesh concerned.
    pub mesh: Option<usize>,
    /// The vertex, triangle or joint concerned.
    pub element: Option<Element>,
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

    /// The same error, about `element`.
    pub fn at(mut self, element: Element) -> Self {
        self.element = Some(element);
        self
    }

    /// The same error, about the option `option` of the table.
    pub fn about(mut self, option: &'static str) -> Self {
        self.option = Some(option);
        self
    }
}

/// A name from a file, as sentences show it: control characters are escaped, so that it can neither begin a line nor
/// move a terminal's cursor, and it is cut, so that value and remedy still fit behind it.
pub(crate) struct Named<'a>(pub &'a str);

impl Named<'_> {
    /// Bytes of a name that are shown.
    const MOST: usize = 64;
}

impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut left = Self::MOST;
        for letter in self.0.chars() {
            let shown =
                if letter.is_control() { letter.escape_debug().to_string() } else { letter.to_string() };
            if shown.len() > left {
                return f.write_str("...");
            }
            left -= shown.len();
            f.write_str(&shown)?;
        }
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_shown_in_one_line_and_cut_between_letters() {
        assert_eq!(Named("Body (1)").to_string(), "Body (1)");
        assert_eq!(Named("a\nb\u{1b}[2Jc").to_string(), "a\\nb\\u{1b}[2Jc");
        assert_eq!(Named(&"髪".repeat(40)).to_string(), "髪".repeat(21) + "...");
        assert_eq!(Named(&"x".repeat(64)).to_string(), "x".repeat(64));
        assert_eq!(Named(&"x".repeat(65)).to_string(), "x".repeat(64) + "...");
    }
}
