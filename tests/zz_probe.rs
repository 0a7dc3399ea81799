#[path = "common/models.rs"]
mod models;
#[path = "common/truth.rs"]
mod truth;
use models::host::file::GltfFile;
use models::host::load::{LoadOptions, load};
use models::*;
use std::sync::Arc;
use superdeform::Character;
use superdeform::pipeline::{Deformer, Options, Rig};
use superdeform::rig::RigOptions;
#[test]
fn probe() {
    let options = Options::default();
    let style = style_of("kaykit_rogue.glb", &options);
    for (name, twin) in [("seedsan_unrigged.glb", "seedsan_vrm1.vrm")] {
        let o = LoadOptions { without_rig: true, ..LoadOptions::default() };
        let target = load(GltfFile::read(&truth::path_of(name).unwrap()).unwrap(), &o).unwrap();
        let twin = model(twin).unwrap();
        let clock = std::time::Instant::now();
        let rig = Rig::of(&target.character, &RigOptions::default()).unwrap();
        println!("rig {:?} {:?} method {:?}", clock.elapsed(), rig.timing_ms, rig.method);
        for w in &rig.warnings {
            println!("{} {}", w.code, w.message);
        }
        println!("{:?}", rig.fallback);
        let auto = Deformer::with_rig(&target.character, &rig, &style, &options).unwrap();
        let artist = Deformer::new(Arc::new(twin.character.clone()), &style, &options).unwrap();
        println!("auto {:?}\nart {:?}", auto.target().anatomy.landmarks, artist.target().anatomy.landmarks);
        let (a, b) = (auto.apply(), artist.apply());
        let ra = auto.report(&a).unwrap();
        let rb = artist.report(&b).unwrap();
        println!("heads {} {} -> {} {}", ra.target.heads, rb.target.heads, ra.result.heads, rb.result.heads);
        for (k, v) in &ra.coefficients {
            println!("{k} {v:?} {:?}", rb.coefficients.get(k));
        }
        for w in auto.warnings() {
            println!("A {} {}", w.code, w.message);
        }
        for w in artist.warnings() {
            println!("B {} {}", w.code, w.message);
        }
        let place = |c: &Character| -> Vec<glam::DVec3> { rest_positions(c) };
        let other = place(&twin.character);
        let tree = superdeform::geometry::PointTree::new(&other);
        let posb = positions(&b);
        let mut start = 0;
        let h = 1.6;
        for (i, m) in target.character.meshes.iter().enumerate() {
            let mut sum = 0.0;
            let mut found = vec![];
            let mut dy = 0.0;
            for (v, p) in m.positions.iter().enumerate() {
                tree.nearest(p.as_dvec3(), 1, f64::INFINITY, &mut found);
                let d = a.meshes[i].positions[v].as_dvec3() - posb[found[0].index() as usize];
                sum += d.length() / h;
                dy += d.y / h;
            }
            println!(
                "{:30} {:6} kinds {:?} {:?}: {:.4} dy {:.4}",
                m.name,
                m.positions.len(),
                rig.kinds[i],
                m.kind,
                sum / m.positions.len() as f64,
                dy / m.positions.len() as f64
            );
            start += m.positions.len();
        }
    }
}
