//! Our heat weights of a body as JSON, for comparison with other programs': `heat_weights VERTEX_COUNT C...`.
//!
//! {"positions": [[x, y, z]...], "triangles": [[a, b, c]...], "bones": [[[x, y, z], [x, y, z]]...],
//!  "weights": {"1": [[[bone, weight]...]...]}}, one row a vertex for each c.

use serde_json::{Map, Value, json};
use std::time::Instant;
use superdeform::Progress;
use superdeform::internals::rig::WeightBone;
use superdeform::internals::rig::heat::HeatSystem;
use superdeform_benches::models;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let vertex_count = arguments.next().and_then(|count| count.parse().ok()).unwrap_or(0);
    let body = models::bodies().pop().expect("there is a body");
    let (positions, triangles) = superdeform_benches::refined(&body.positions, &body.triangles, vertex_count);
    // One bone a segment, as other programs have them.
    let bones: Vec<WeightBone> = body
        .bones
        .iter()
        .flat_map(|bone| &bone.segments)
        .zip(0..)
        .map(|(&ends, joint)| WeightBone { joint, segments: vec![ends] })
        .collect();
    let start = Instant::now();
    let system = HeatSystem::new(&positions, &triangles, &bones, 2, &mut Progress::none()).unwrap();
    let mut weights = Map::new();
    for c in arguments {
        let weighted = system.weights(c.parse().expect("c is a number"), &mut Progress::none()).unwrap();
        eprintln!("c = {c}: {:?} after {:.3} s", weighted.fallback, start.elapsed().as_secs_f64());
        weights.insert(c, weighted.weights.rows().map(|row| json!(row)).collect::<Vec<Value>>().into());
    }
    let ends = |bone: &WeightBone| bone.segments[0].map(|p| p.to_array());
    let all = json!({
        "body": body.name,
        "positions": positions.iter().map(|p| p.to_array()).collect::<Vec<_>>(),
        "triangles": triangles,
        "bones": bones.iter().map(ends).collect::<Vec<_>>(),
        "weights": weights,
    });
    println!("{all}");
}
