//! Batches over the sample pair.

use super::*;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use superdeform_host::samples;

/// A folder with two characters and one broken file in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("superdeform-batch-{name}-{}", std::process::id()));
        let input = folder.join("in/deep");
        fs::create_dir_all(&input).unwrap();
        fs::copy(samples::data().join("kaykit_rogue.glb"), folder.join("in/rogue.glb")).unwrap();
        fs::copy(samples::data().join("quaternius_female_dress.glb"), input.join("dress.glb")).unwrap();
        fs::write(input.join("broken.vrm"), "no character").unwrap();
        Self(folder)
    }

    fn batch(&self, more: &[&str]) -> Batch {
        let text = |name: &str| self.0.join(name).to_str().unwrap().to_string();
        let words = ["superdeform", "batch", &text("in"), "-q", "-o", &text("out")];
        let words = words.iter().chain(more).map(Into::into);
        Batch::parse_from_words(words).expect("a batch")
    }

    /// What lies in the folder of results, by name, without what differs from run to run.
    fn results(&self) -> BTreeMap<String, Vec<u8>> {
        let mut found = BTreeMap::new();
        let mut folders = vec![self.0.join("out")];
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let name = path.strip_prefix(self.0.join("out")).unwrap().to_str().unwrap().to_string();
                    found.insert(name, fs::read(&path).unwrap());
                }
            }
        }
        found
    }

    fn summary(&self) -> Value {
        serde_json::from_slice(&fs::read(self.0.join("out/summary.json")).unwrap()).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn one_failure_does_not_stop_the_rest_and_what_is_done_is_skipped() {
    let folder = Folder::new("skip");
    let batch = folder.batch(&["--style", "sd2", "--jobs", "2"]);
    let outcome = run(&batch).unwrap();
    assert_eq!((outcome.count, outcome.failures.len()), (3, 1));
    assert!(outcome.failures[0].contains("broken.vrm"), "{:?}", outcome.failures);
    let first = folder.results();
    let names: Vec<&str> = first.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        ["deep/dress_sd.glb", "deep/dress_sd.glb.json", "rogue_sd.glb", "rogue_sd.glb.json", "summary.json"]
    );
    let summary = folder.summary();
    assert_eq!((&summary["done"], &summary["failed"]), (&2.into(), &1.into()));
    // Each result is that of a run of its own.
    let single = folder.0.join("single.glb");
    let words = [
        "superdeform",
        folder.0.join("in/rogue.glb").to_str().unwrap(),
        "sd2",
        "-q",
        "-o",
        single.to_str().unwrap(),
    ]
    .map(str::to_string);
    run::run(&crate::cli::parse(words).ok().unwrap()).unwrap();
    assert!(fs::read(&single).unwrap() == first["rogue_sd.glb"]);
    // A result that is gone and one that was cut short are made again, and nothing else is touched.
    fs::remove_file(folder.0.join("out/deep/dress_sd.glb")).unwrap();
    fs::write(folder.0.join("out/deep/.dress_sd.glb.123.part"), "half").unwrap();
    let report = fs::metadata(folder.0.join("out/rogue_sd.glb.json")).unwrap().modified().unwrap();
    run(&batch).unwrap();
    let summary = folder.summary();
    assert_eq!((&summary["done"], &summary["skipped"]), (&1.into(), &1.into()));
    let second = folder.results();
    assert!(second.keys().eq(first.keys()), "{:?}", second.keys());
    assert!(second["deep/dress_sd.glb"] == first["deep/dress_sd.glb"]);
    assert_eq!(fs::metadata(folder.0.join("out/rogue_sd.glb.json")).unwrap().modified().unwrap(), report);
}

#[test]
fn another_style_another_input_or_force_makes_a_result_anew() {
    let folder = Folder::new("anew");
    fs::remove_file(folder.0.join("in/deep/broken.vrm")).unwrap();
    fs::remove_file(folder.0.join("in/deep/dress.glb")).unwrap();
    let done = |more: &[&str]| {
        run(&folder.batch(more)).unwrap();
        folder.summary()["done"] == 1
    };
    assert!(done(&["--style", "sd2"]));
    assert!(!done(&["--style", "sd2"]));
    assert!(
        !done(&["--style", "sd2", "--threads", "1", "--jobs", "1", "-v"]),
        "how it is done changes nothing"
    );
    assert!(done(&["--style", "sd2", "--force"]));
    assert!(done(&["--heads", "2.2"]));
    assert!(done(&["--heads", "2.2", "--amount", "0.5"]));
    // What stands behind a GLB's end means nothing, and yet it is another file.
    let input = folder.0.join("in/rogue.glb");
    let longer = [fs::read(&input).unwrap(), vec![0; 4]].concat();
    fs::write(&input, longer).unwrap();
    assert!(done(&["--heads", "2.2", "--amount", "0.5"]));
}

#[test]
fn a_model_as_style_is_measured_once_and_gives_what_single_runs_give() {
    let folder = Folder::new("model");
    let reference = samples::data().join("kaykit_rogue.glb");
    let reference = reference.to_str().unwrap();
    let inputs = folder.0.join("in/deep/dress.glb");
    fs::remove_file(folder.0.join("in/rogue.glb")).unwrap();
    fs::remove_file(folder.0.join("in/deep/broken.vrm")).unwrap();
    run(&folder.batch(&["--style", reference, "--pictures"])).unwrap();
    let single = folder.0.join("single.glb");
    let words = ["superdeform", inputs.to_str().unwrap(), reference, "-q", "-o", single.to_str().unwrap()]
        .map(str::to_string);
    run::run(&crate::cli::parse(words).ok().unwrap()).unwrap();
    let results = folder.results();
    assert!(fs::read(&single).unwrap() == results["deep/dress_sd.glb"]);
    assert!(results["deep/dress_sd.glb.png"].starts_with(b"\x89PNG"));
}
