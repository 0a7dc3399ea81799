//! Makes a character's super-deformed version: files in, files out.

mod host;

use host::file::{GltfFile, write_atomically};
use host::load::{LoadOptions, load};
use std::path::Path;
use std::process::ExitCode;
use superdeform::pipeline::{Deformed, DeformedMesh, Mapped};

fn convert(target: &Path, output: &Path) -> superdeform::Result<()> {
    let loaded = load(GltfFile::read(target)?, &LoadOptions::default())?;
    for warning in &loaded.warnings {
        eprintln!("warning ({}): {}", warning.code, warning.message);
    }
    let meshes = loaded.character.meshes.iter().map(|mesh| DeformedMesh {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        tangents: mesh.tangents.clone(),
        morph_targets: mesh.morph_targets.clone(),
    });
    let deformed = Deformed {
        meshes: meshes.collect(),
        joints: loaded
            .character
            .skeleton
            .joints
            .iter()
            .map(|joint| joint.position())
            .collect(),
    };
    let stays = |_: usize, position: glam::DVec3| Mapped {
        position,
        jacobian: glam::DMat3::IDENTITY,
    };
    write_atomically(output, &host::write::write(&loaded, &deformed, &stays)?)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [target, flag, output] = arguments.as_slice() else {
        eprintln!("usage: superdeform TARGET -o OUT");
        return ExitCode::from(2);
    };
    if flag != "-o" {
        eprintln!("usage: superdeform TARGET -o OUT");
        return ExitCode::from(2);
    }
    match convert(Path::new(target), Path::new(output)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(1)
        }
    }
}
