//! Which files a batch reads, and where their results go.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// One character of a batch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// The file.
    pub input: PathBuf,
    /// Its result.
    pub output: PathBuf,
    /// The numbers of its run, written last.
    pub report: PathBuf,
}

/// A file that was found, and its path below what it was found in.
struct Found {
    input: PathBuf,
    below: PathBuf,
}

/// What a batch is to do.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The characters.
    pub items: Vec<Item>,
    /// What was found and is none of them, a sentence each.
    pub left_out: Vec<String>,
}

/// What inputs hold.
#[derive(Default)]
struct Search {
    found: Vec<Found>,
    /// Links that lead nowhere.
    dangling: Vec<PathBuf>,
    /// Results of an earlier batch, which went to another folder.
    results: Vec<PathBuf>,
}

/// Finds the files that `inputs` name and gives each its result in `output`.
///
/// A file found in a folder keeps its path below that folder; one that was named keeps its name alone. Where two results
/// would be one file, both keep their path below the folder that holds all inputs. With `root`, each keeps its path
/// below it, whatever else is named: so several workers agree who were given different files.
///
/// # Errors
/// One sentence: a folder that cannot be read, a pattern or a folder with no character, an input in the place of `output`, a
/// file outside `root`, or two files with one result.
pub fn plan(inputs: &[PathBuf], root: Option<&Path>, output: &Path) -> Result<Plan, String> {
    let mut search = Search::default();
    for input in inputs {
        search.input(input)?;
    }
    let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let results = whole(output);
    search.results.retain(|path| !whole(path).starts_with(&results));
    let left_out = search.left_out();
    let mut found = search.found;
    let mut known = BTreeSet::new();
    // Results of an earlier run are no inputs; a file that is named twice is one.
    found.retain(|found| {
        let path = whole(&found.input);
        !(output.exists() && path.starts_with(&results)) && known.insert(path)
    });
    if let Some(same) = inputs.iter().find(|input| input.exists() && whole(input) == results) {
        return Err(format!(
            "{} is an input, and results cannot be put among inputs: give -o another folder",
            same.display()
        ));
    }
    if found.is_empty() {
        return Err("there is no .vrm, .glb or .gltf among the inputs: name files or folders that hold some"
            .to_string());
    }
    if let Some(root) = root {
        for found in &mut found {
            let path = whole(&found.input);
            let below = path.strip_prefix(whole(root)).map_err(|_| {
                format!("{} is not below the --root {}", found.input.display(), root.display())
            })?;
            found.below = below.to_path_buf();
        }
    } else {
        let mut owners: BTreeMap<String, usize> = BTreeMap::new();
        for found in &found {
            *owners.entry(folded(&result_name(&found.below))).or_default() += 1;
        }
        let shared = common_folder(&known);
        for found in &mut found {
            if owners[&folded(&result_name(&found.below))] > 1
                && let Ok(below) = whole(&found.input).strip_prefix(&shared)
            {
                found.below = below.to_path_buf();
            }
        }
    }
    let mut owners: BTreeMap<String, PathBuf> = BTreeMap::new();
    let mut items = Vec::new();
    for Found { input, below } in found {
        let name = result_name(&below);
        if let Some(other) = owners.insert(folded(&name), input.clone()) {
            return Err(format!(
                "{} and {} would both become {}: rename one of them",
                other.display(),
                input.display(),
                output.join(&name).display()
            ));
        }
        let result = output.join(&name);
        items.push(Item { input, report: with_ending(&result, ".json"), output: result });
    }
    Ok(Plan { items, left_out })
}

impl Search {
    /// Adds what `input` names: a file, a folder's characters, or what a pattern matches.
    fn input(&mut self, input: &Path) -> Result<(), String> {
        if input.is_dir() {
            return self.folder(input, input);
        }
        let pattern = input.to_str().filter(|text| !input.exists() && text.contains(['*', '?', '[']));
        let Some(pattern) = pattern else {
            // What is not there is told when it is read, so that the rest is done.
            let below = input.file_name().map_or_else(|| input.to_path_buf(), PathBuf::from);
            self.found.push(Found { input: input.to_path_buf(), below });
            return Ok(());
        };
        let matches = glob::glob(pattern).map_err(|error| format!("{pattern}: is no pattern ({error})"))?;
        let before = self.found.len();
        for path in matches {
            let path = path.map_err(|error| error.to_string())?;
            if path.is_dir() || is_character(&path) {
                self.input(&path)?;
            }
        }
        if self.found.len() == before {
            return Err(format!("{pattern}: matches no .vrm, .glb or .gltf"));
        }
        Ok(())
    }

    fn folder(&mut self, folder: &Path, top: &Path) -> Result<(), String> {
        let failed = |error: std::io::Error| format!("{}: cannot be read ({error})", folder.display());
        let mut paths = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(failed)? {
            paths.push(entry.map_err(failed)?.path());
        }
        paths.sort();
        for path in paths {
            let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
            // A link to a folder above would never end.
            let linked = path.is_symlink();
            if hidden {
                continue;
            }
            if path.is_dir() && !linked {
                self.folder(&path, top)?;
            } else if linked && !path.exists() && is_character(&path) {
                self.dangling.push(path);
            } else if is_character(&path) && is_result(&path) {
                self.results.push(path);
            } else if is_character(&path) && path.is_file() {
                let below = path.strip_prefix(top).unwrap_or(&path).to_path_buf();
                self.found.push(Found { input: path, below });
            }
        }
        Ok(())
    }

    fn left_out(&self) -> Vec<String> {
        let said = |paths: &[PathBuf], what: &str| {
            let first = paths.first()?.display();
            Some(match paths.len() {
                1 => format!("{first} is left out: {what}"),
                count => format!("{first} and {} more are left out: {what}", count - 1),
            })
        };
        let dangling = said(&self.dangling, "a link that leads nowhere");
        let results =
            said(&self.results, "a result of an earlier batch; name it as an input to convert it again");
        dangling.into_iter().chain(results).collect()
    }
}

/// True for what a batch has written: the report beside it says so.
fn is_result(path: &Path) -> bool {
    let report = std::fs::read(with_ending(path, ".json")).ok();
    let report = report.and_then(|text| serde_json::from_slice::<serde_json::Value>(&text).ok());
    report.is_some_and(|report| report["batch"]["key"].is_string())
}

fn is_character(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    extension.is_some_and(|extension| matches!(extension.as_str(), "vrm" | "glb" | "gltf"))
}

/// `a/b.vrm` becomes `a/b_sd.vrm`; what is no VRM becomes a GLB.
fn result_name(below: &Path) -> PathBuf {
    let is_vrm = below.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vrm"));
    let mut name = below.file_stem().unwrap_or_default().to_os_string();
    name.push(if is_vrm { "_sd.vrm" } else { "_sd.glb" });
    below.with_file_name(name)
}

/// `path` with `ending` after the whole of its name.
pub fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(ending);
    path.with_file_name(name)
}

/// As file systems see a name that do not tell small letters from large ones.
fn folded(path: &Path) -> String {
    path.to_string_lossy().to_lowercase()
}

/// The folder that holds all of `paths`.
fn common_folder(paths: &BTreeSet<PathBuf>) -> PathBuf {
    let mut paths = paths.iter().filter_map(|path| path.parent());
    let first = paths.next().unwrap_or(Path::new("")).to_path_buf();
    paths.fold(first, |common, folder| {
        common
            .ancestors()
            .find(|ancestor| folder.starts_with(ancestor))
            .unwrap_or(Path::new(""))
            .to_path_buf()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// A folder of empty files that is gone afterwards.
    struct Folder(PathBuf);

    impl Folder {
        fn of(name: &str, files: &[&str]) -> Self {
            let folder = std::env::temp_dir().join(format!("superdeform-plan-{name}-{}", std::process::id()));
            for file in files {
                let path = folder.join(file);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, "").unwrap();
            }
            Self(folder)
        }

        fn results(&self, inputs: &[&str], root: Option<&str>) -> Result<Vec<String>, String> {
            let inputs: Vec<PathBuf> = inputs.iter().map(|input| self.0.join(input)).collect();
            let root = root.map(|root| self.0.join(root));
            let Plan { items, left_out } = plan(&inputs, root.as_deref(), &self.0.join("out"))?;
            assert_eq!(left_out, [""; 0]);
            let name =
                |path: &Path| path.strip_prefix(self.0.join("out")).unwrap().to_str().unwrap().to_string();
            for item in &items {
                assert_eq!(name(&item.report), format!("{}.json", name(&item.output)));
            }
            Ok(items.iter().map(|item| name(&item.output)).collect())
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_folder_is_searched_to_the_bottom_and_keeps_its_structure() {
        let folder = Folder::of(
            "search",
            &["in/b.vrm", "in/a.glb", "in/deep/er/c.VRM", "in/notes.txt", "in/.b.vrm.7.part", "in/.d.vrm"],
        );
        assert_eq!(folder.results(&["in"], None).unwrap(), ["a_sd.glb", "b_sd.vrm", "deep/er/c_sd.vrm"]);
    }

    #[test]
    fn results_are_no_inputs_of_the_next_run_and_nothing_is_done_twice() {
        let folder = Folder::of("again", &["a.vrm", "out/a_sd.vrm", "b/c.glb"]);
        assert_eq!(folder.results(&["", "a.vrm", "b"], None).unwrap(), ["a_sd.vrm", "b/c_sd.glb"]);
    }

    #[test]
    fn results_do_not_go_among_the_inputs() {
        let folder = Folder::of("same", &["in/a.vrm", "b.vrm"]);
        let path = |name: &str| folder.0.join(name);
        for (inputs, output) in
            [(vec![path("in")], path("in")), (vec![path("in"), path("b.vrm")], path("b.vrm"))]
        {
            let error = plan(&inputs, None, &output).unwrap_err();
            assert!(error.starts_with(output.to_str().unwrap()) && error.contains("-o"), "{error}");
        }
        // A folder for results within the inputs is none of them.
        assert_eq!(plan(&[path("in")], None, &path("in/out")).unwrap().items.len(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_to_nothing_and_results_of_an_earlier_batch_are_left_out_and_told() {
        let folder = Folder::of("told", &["in/a.vrm", "in/old/a_sd.vrm", "in/old/b_sd.vrm", "in/b.glb"]);
        let path = |name: &str| folder.0.join(name);
        std::os::unix::fs::symlink("nowhere", path("in/gone.vrm")).unwrap();
        fs::write(path("in/old/a_sd.vrm.json"), r#"{"batch": {"key": "12"}}"#).unwrap();
        fs::write(path("in/old/b_sd.vrm.json"), r#"{"batch": {"key": "34"}}"#).unwrap();
        // The report of a run of its own.
        fs::write(path("in/b.glb.json"), "{}").unwrap();
        let Plan { items, left_out } = plan(&[path("in")], None, &path("out")).unwrap();
        assert_eq!(items.len(), 2);
        assert!(left_out[0].contains("gone.vrm") && left_out[0].contains("nowhere"), "{left_out:?}");
        assert!(left_out[1].contains("a_sd.vrm and 1 more"), "{left_out:?}");
        // What is named is meant.
        assert_eq!(plan(&[path("in/old/a_sd.vrm")], None, &path("out")).unwrap().items.len(), 1);
    }

    #[test]
    fn names_that_collide_keep_their_folders() {
        let folder = Folder::of("collide", &["x/hero.vrm", "y/hero.vrm", "y/other.vrm"]);
        let inputs = ["x/hero.vrm", "y/hero.vrm", "y/other.vrm"];
        assert_eq!(
            folder.results(&inputs, None).unwrap(),
            ["x/hero_sd.vrm", "y/hero_sd.vrm", "other_sd.vrm"]
        );
        assert_eq!(folder.results(&["y/hero.vrm"], Some("")).unwrap(), ["y/hero_sd.vrm"]);
        let error = folder.results(&["x/hero.vrm"], Some("y")).unwrap_err();
        assert!(error.contains("hero.vrm") && error.contains("--root"), "{error}");
    }

    #[test]
    fn two_files_with_one_result_are_refused() {
        let folder = Folder::of("twice", &["a.glb", "a.gltf"]);
        let error = folder.results(&[""], None).unwrap_err();
        assert!(error.contains("a.glb") && error.contains("a.gltf") && error.contains("rename"), "{error}");
    }

    #[test]
    fn a_pattern_names_files_and_one_that_matches_nothing_is_refused() {
        let folder = Folder::of("pattern", &["in/a.vrm", "in/b.vrm", "in/c.txt"]);
        assert_eq!(folder.results(&["in/*"], None).unwrap(), ["a_sd.vrm", "b_sd.vrm"]);
        assert!(folder.results(&["in/*.glb"], None).unwrap_err().contains("matches no"));
        assert!(folder.results(&["in/c*"], None).is_err());
        // What is not there is told when its turn comes.
        assert_eq!(folder.results(&["in/none.vrm"], None).unwrap(), ["none_sd.vrm"]);
    }
}
