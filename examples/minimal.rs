//! A GLB or VRM in, its super-deformed version out:
//! `cargo run --release --example minimal -- tests/data/quaternius_female_dress.glb 2.5 chibi.glb`

use std::sync::Arc;
use superdeform::{Deformer, Options, Style, find_roles};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, load};
use superdeform_host::write::write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, heads, output] = &arguments[..] else {
        return Err("usage: minimal INPUT.glb HEADS OUTPUT.glb".into());
    };
    let options = LoadOptions { find_roles: Some(&find_roles), ..LoadOptions::default() };
    let loaded = load(GltfFile::read(input.as_ref())?, &options)?;
    let style = Style::heads(heads.parse()?)?;
    let deformer = Deformer::new(Arc::new(loaded.character.clone()), &style, &Options::default())?;
    let result = deformer.apply();
    let bytes = write(&loaded, &result, &|joint, point| deformer.map(joint, point))?;
    std::fs::write(output, bytes)?;
    let report = deformer.report(&result)?;
    println!("{:.1} heads became {:.1}", report.target.heads, report.result.heads);
    for warning in &report.warnings {
        println!("{}", warning.message);
    }
    Ok(())
}
