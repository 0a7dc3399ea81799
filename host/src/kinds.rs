//! What meshes are: by the patterns of the command line, else by names.

use regex_lite::Regex;
use superdeform::internals::character::kinds::{MeshNames, kinds_from_names};
use superdeform::{Character, MeshKind, Warning};

/// Gives meshes the kind of the first pattern that matches `node|mesh|material`, else that which their names tell.
pub(super) fn set_kinds(
    character: &mut Character,
    names: &[MeshNames],
    patterns: &[(MeshKind, Regex)],
    warnings: &mut Vec<Warning>,
) {
    let told = kinds_from_names(character, names);
    let mut guessed = Vec::new();
    for ((mesh, names), told) in character.meshes.iter_mut().zip(names).zip(told) {
        let label = format!("{}|{}|{}", names.node, names.mesh, names.material);
        let given = patterns.iter().find(|(_, pattern)| pattern.is_match(&label)).map(|&(kind, _)| kind);
        mesh.kind = given.or(told);
        if let (None, Some(kind)) = (given, told)
            && kind != MeshKind::Body
        {
            guessed.push(format!("{} ({kind})", mesh.name));
        }
    }
    if !guessed.is_empty() {
        let message = format!("kinds were guessed from names, so check them: {}", guessed.join(", "));
        warnings.push(Warning::new("kind_guessed", message).about("kinds"));
    }
}
