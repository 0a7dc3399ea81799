//! Threads save time and change nothing.

use std::sync::Arc;
use superdeform::{Deformer, Options, Style};

#[path = "common/people.rs"]
mod people;

#[test]
fn any_number_of_threads_gives_the_same_result() {
    let character = Arc::new(people::Person::default().build());
    // Enough that there is something to share out.
    assert!(character.vertex_count() > 8000);
    let result = |thread_count: usize| {
        let options = Options { thread_count, ..Options::default() };
        let deformer = Deformer::new(character.clone(), &Style::heads(2.5).unwrap(), &options).unwrap();
        let deformed = deformer.apply();
        let meshes: Vec<_> =
            deformed.meshes.into_iter().map(|mesh| (mesh.positions, mesh.normals, mesh.tangents)).collect();
        (meshes, deformed.joints)
    };
    let alone = result(1);
    for thread_count in [0, 2, 3, 8] {
        assert!(result(thread_count) == alone, "{thread_count} threads");
    }
}
