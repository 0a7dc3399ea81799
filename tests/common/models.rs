//! The real models to test with, and what comes out of them.
//!
//! `superdeform_host::samples` says where they lie; what a test lacks of them is reported as skipped.
#![allow(dead_code)]

use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use superdeform::internals::shape::Measured;
use superdeform::internals::shape::figure::Figure;
use superdeform::{Character, Deformed, Deformer, Options, Style, find_roles};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, Loaded, load};
use superdeform_host::samples;
use superdeform_host::verify::{Closure, closure};
use superdeform_host::write::{rewrite, write};

/// Models that the others are made like: 2.3, 3.4 and 4.6 heads.
pub const REFERENCES: [&str; 3] = ["kaykit_rogue.glb", "godette.vrm", "makehuman_baby_reference.glb"];

/// All models that come with a rig, by file name. The sample pair is always among them; a test that finds no others is
/// reported as skipped.
pub fn models() -> &'static BTreeMap<String, Loaded> {
    static MODELS: OnceLock<BTreeMap<String, Loaded>> = OnceLock::new();
    let more = samples::folder();
    if !more.is_dir() {
        samples::skipped("models");
    }
    MODELS.get_or_init(|| {
        let mut models = BTreeMap::new();
        for folder in [samples::data(), more].into_iter().filter(|folder| folder.is_dir()) {
            for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
                if !path.extension().is_some_and(|end| end == "glb" || end == "vrm") {
                    continue;
                }
                let name = path.file_name().unwrap().to_string_lossy().to_string();
                let loaded = loaded(GltfFile::read(&path).unwrap());
                if loaded.rigged {
                    models.insert(name, loaded);
                }
            }
        }
        models
    })
}

/// The model called `name`; where it is not there, `None`, and the calling test is reported as skipped.
pub fn model(name: &str) -> Option<&'static Loaded> {
    let model = models().get(name);
    if model.is_none() {
        samples::skipped(name);
    }
    model
}

/// Those of `names` that are there; the others are reported as skipped.
pub fn present<'a>(names: &[&'a str]) -> Vec<&'a str> {
    names.iter().copied().filter(|&name| model(name).is_some()).collect()
}

/// Reads a character as the command line does.
pub fn loaded(file: GltfFile) -> Loaded {
    let name = file.name.clone();
    let options = LoadOptions { find_roles: Some(&find_roles), ..LoadOptions::default() };
    load(file, &options).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The style of the model called `name`.
pub fn style_of(name: &str, options: &Options) -> Style {
    style(&models()[name].character, options)
}

/// The style of `character`.
pub fn style(character: &Character, options: &Options) -> Style {
    Style::Shape(Box::new(Measured::of(character, options).unwrap().shape))
}

/// A model and what came out of it.
pub struct Run {
    /// Target and style, for messages.
    pub name: String,
    pub target: &'static str,
    pub style: &'static str,
    pub loaded: &'static Loaded,
    pub deformer: Deformer,
    pub deformed: Deformed,
}

impl Run {
    pub fn new(target: &'static str, style_name: &'static str, style: &Style, options: &Options) -> Self {
        Self::of(models()[target].character.clone(), target, style_name, style, options)
    }

    /// As [`Run::new`], of `character`, which is that model's with more known of it.
    pub fn of(
        character: Character,
        target: &'static str,
        style_name: &'static str,
        style: &Style,
        options: &Options,
    ) -> Self {
        let name = format!("{target} like {style_name}");
        let loaded = &models()[target];
        let deformer = Deformer::new(Arc::new(character), style, options)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let deformed = deformer.apply();
        Self { name, target, style: style_name, loaded, deformer, deformed }
    }

    /// H: the target's height.
    pub fn height(&self) -> f64 {
        self.deformer.target().figure.height()
    }

    /// The target, laid out.
    pub fn before(&self) -> &Figure {
        &self.deformer.target().figure
    }

    /// The result, laid out.
    pub fn after(&self) -> Figure {
        Figure::of(&self.loaded.character.with(&self.deformed)).unwrap()
    }

    pub fn has_warning(&self, code: &str) -> bool {
        self.deformer.warnings().iter().any(|warning| warning.code == code)
    }

    /// The result written to a file, and that read again.
    pub fn written(&self) -> Loaded {
        let map = |joint: usize, point: DVec3| self.deformer.map(joint, point);
        let bytes = write(self.loaded, &self.deformed, &map).unwrap();
        loaded(GltfFile::parse(&self.loaded.file.name, &bytes).unwrap())
    }

    /// How far the written file puts its vertices from where they should be.
    pub fn closure(&self) -> Closure {
        let map = |joint: usize, point: DVec3| self.deformer.map(joint, point);
        let bytes = rewrite(self.loaded, &self.deformed, &map).unwrap().to_bytes().unwrap();
        let written = GltfFile::parse(&self.loaded.file.name, &bytes).unwrap();
        closure(&written, self.loaded, &self.deformed).unwrap()
    }
}

/// Every model made like every reference, as the options are by default.
pub fn runs() -> &'static [Run] {
    static RUNS: OnceLock<Vec<Run>> = OnceLock::new();
    // Each test that looks at them says what it lacks, not the first alone.
    let _ = (models(), present(&REFERENCES));
    RUNS.get_or_init(|| pairs(&Options::default()))
}

/// Every model made like every reference.
pub fn pairs(options: &Options) -> Vec<Run> {
    let styles: Vec<(&'static str, Style)> =
        present(&REFERENCES).into_iter().map(|name| (name, style_of(name, options))).collect();
    let work: Vec<(&'static str, &(&'static str, Style))> =
        models().keys().flat_map(|target| styles.iter().map(move |style| (target.as_str(), style))).collect();
    in_parallel(&work, |(target, (name, style))| Run::new(target, name, style, options))
}

/// `work` on each of `items`, on all cores; results in order.
pub fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, R)>> = Mutex::new(Vec::new());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    // What fails or is skipped in a thread bears the test's name.
    let test = std::thread::current().name().unwrap_or("main").to_string();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let thread = std::thread::Builder::new().name(test.clone());
            let run = || {
                while let Some((index, item)) = Some(next.fetch_add(1, Ordering::Relaxed))
                    .and_then(|index| items.get(index).map(|item| (index, item)))
                {
                    let result = work(item);
                    done.lock().unwrap().push((index, result));
                }
            };
            thread.spawn_scoped(scope, run).unwrap();
        }
    });
    let mut done = done.into_inner().unwrap();
    done.sort_by_key(|&(index, _)| index);
    done.into_iter().map(|(_, result)| result).collect()
}

/// Checks each of `runs`, and tells of all that fail, not of the first alone.
pub fn check_all<T: Sync>(items: &[T], check: impl Fn(&T) -> Vec<String> + Sync) {
    assert!(!items.is_empty(), "nothing to check");
    let failures: Vec<String> = in_parallel(items, check).into_iter().flatten().collect();
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

/// The greatest distance between two lists of points.
pub fn furthest(one: &[DVec3], other: &[DVec3]) -> f64 {
    assert_eq!(one.len(), other.len());
    // A distance that is no number counts as infinite.
    one.iter()
        .zip(other)
        .map(|(p, q)| p.distance(*q))
        .map(|d| if d.is_nan() { f64::INFINITY } else { d })
        .fold(0.0, f64::max)
}

/// All positions of a result, one mesh after the other, model space.
pub fn positions(deformed: &Deformed) -> Vec<DVec3> {
    deformed.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(|p| p.as_dvec3())).collect()
}

/// All positions of a character, one mesh after the other.
pub fn rest_positions(character: &Character) -> Vec<DVec3> {
    character.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(|p| p.as_dvec3())).collect()
}

/// The same character in units `1 / factor` as long.
pub fn scaled(character: &Character, factor: f64) -> Character {
    let mut character = character.clone();
    let scale = |p: &mut glam::Vec3| *p = (p.as_dvec3() * factor).as_vec3();
    for mesh in &mut character.meshes {
        mesh.positions.iter_mut().for_each(scale);
        for target in &mut mesh.morph_targets {
            target.positions.iter_mut().for_each(scale);
        }
    }
    for joint in &mut character.skeleton.joints {
        let at = joint.position() * factor;
        joint.rest.w_axis = at.extend(1.0);
    }
    character
}
