//! What meshes are: by the patterns of the command line, else by names.

use regex::Regex;
use superdeform::{Humanoid, Mesh, MeshKind, Role, Skeleton, Warning};

/// Kinds by pattern, else by name; only what hangs from the head is hair or part of a face.
pub(super) fn set_kinds(
    meshes: &mut [Mesh],
    labels: &[String],
    patterns: &[(MeshKind, Regex)],
    skeleton: &Skeleton,
    humanoid: &Humanoid,
    warnings: &mut Vec<Warning>,
) {
    let head = humanoid.joint(Role::Head);
    let mut of_head = vec![false; skeleton.joints.len()];
    for joint in skeleton.parents_first() {
        let parent = skeleton.joints[joint].parent;
        of_head[joint] = Some(joint) == head || parent.is_some_and(|parent| of_head[parent]);
    }
    let mut guessed = Vec::new();
    for (mesh, label) in meshes.iter_mut().zip(labels) {
        if let Some((kind, _)) = patterns.iter().find(|(_, pattern)| pattern.is_match(label)) {
            mesh.kind = Some(*kind);
            continue;
        }
        // The material says most about a single primitive, then the mesh, then the node.
        let Some(kind) = label.rsplit('|').find_map(MeshKind::guess) else {
            continue;
        };
        let share_of_head = head.map(|_| {
            let rows = mesh.weights.rows();
            let held: f64 = rows
                .flat_map(|row| row.iter().filter(|&&(joint, _)| of_head[joint as usize]))
                .map(|&(_, weight)| f64::from(weight))
                .sum();
            held / mesh.weights.row_count().max(1) as f64
        });
        let needed = match kind {
            MeshKind::Hair => 0.5,
            MeshKind::FacePart => 0.9,
            _ => 0.0,
        };
        if share_of_head.is_none_or(|share| share >= needed) {
            mesh.kind = Some(kind);
            if kind != MeshKind::Body {
                guessed.push(format!("{} ({kind:?})", mesh.name));
            }
        }
    }
    if !guessed.is_empty() {
        warnings.push(Warning::new(
            "kind_guessed",
            format!(
                "kinds were guessed from names, so check them and correct them with --body, --garment, --hair, --face-part or --accessory: {}",
                guessed.join(", ")
            ),
        ));
    }
}
