//! What a slider of youth waits for on real characters, on one thread: `cargo bench --bench youth`.
//!
//! Names of models may follow; without them all that the tests use. Each figure is the best of twenty, in milliseconds.

use std::sync::Arc;
use std::time::Instant;
use superdeform::{Deformer, MeshOutputs, Options, Progress, Role, Style, find_roles};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, load};
use superdeform_host::samples;

const RUNS: usize = 20;

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|name| !name.starts_with("--")).collect();
    let folder = samples::folder();
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: there is no folder {}", folder.display());
        return;
    };
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    println!("{:34} {:>8} {:>8} {:>7} {:>7}", "", "vertices", "of head", "set", "apply");
    for path in paths.iter().filter(|path| path.extension().is_some_and(|end| end == "glb" || end == "vrm")) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_string();
        if !asked.is_empty() && !asked.iter().any(|asked| name.contains(asked.as_str())) {
            continue;
        }
        let options = LoadOptions { find_roles: Some(&find_roles), ..LoadOptions::default() };
        let Ok(loaded) = GltfFile::read(path).and_then(|file| load(file, &options)) else { continue };
        let mut options = Options { thread_count: 1, ..Options::default() };
        let mesh_count = loaded.character.meshes.len();
        let count = loaded.character.vertex_count();
        let made = Deformer::new(Arc::new(loaded.character), &Style::Heads(2.5), &options);
        let Ok(mut deformer) = made else { continue };
        let figure = &deformer.target().figure;
        let is_head = |&vertex: &usize| figure.weight_of(vertex, Role::is_head) > 0.5;
        let of_head = (0..count).filter(is_head).count();
        let positions = vec![MeshOutputs::default(); mesh_count];
        let mut best = [f64::INFINITY; 2];
        for run in 0..RUNS + 2 {
            options.youth = 0.3 + 0.03 * run as f64;
            let clock = Instant::now();
            deformer.set_options(&options, &mut Progress::none()).expect("the options are in range");
            let set = clock.elapsed();
            let deformed = deformer.apply_to(&positions, &mut Progress::none());
            let all = clock.elapsed();
            std::hint::black_box(&deformed);
            // The first ones make what is kept.
            if run >= 2 {
                best[0] = best[0].min(set.as_secs_f64() * 1e3);
                best[1] = best[1].min((all - set).as_secs_f64() * 1e3);
            }
        }
        println!("{name:34} {count:8} {of_head:8} {:7.2} {:7.2}", best[0], best[1]);
    }
}
