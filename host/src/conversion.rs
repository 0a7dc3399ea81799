//! From bytes to bytes: what the command line, a batch, a page in a browser and a wheel all do.
//!
//! [`Conversion::open`] reads a character, and makes a rig for it where there is none; [`Conversion::set`] gives it a style,
//! as often as a slider moves; [`Conversion::write`] gives the file, its numbers and what a person should know. Nothing here
//! touches a file system, a terminal, a clock or the environment, and no thread is started but by the library, which starts
//! none where a system has none.

use crate::appearance::Appearance;
use crate::bad_input;
use crate::beside::Beside;
use crate::file::GltfFile;
use crate::leg_colliders::guard_legs;
use crate::load::{LoadOptions, Loaded, is_vrm, load};
use crate::materials::Material;
use crate::paint::{EvenEyes, even_eyes};
use crate::rig::{INFLUENCES, add_rig, rerigged};
use crate::shades::shade;
use crate::write;
use glam::DVec3;
use regex_lite::Regex;
use serde::Serialize;
use serde_json::Value;
use std::sync::Arc;
use superdeform::internals::parallel;
use superdeform::internals::shape::measured::Measured;
use superdeform::report::FigureReport;
use superdeform::{
    Axes, BodyShape, Character, Deformed, Deformer, Error, ErrorKind, FaceHints, MeshKind, MeshOutputs,
    Options, Progress, Report, Result, Rig, RigOptions, Style, Warning, Weights, find_roles,
};

/// Milliseconds since some moment, for the times of a report.
pub type Clock = fn() -> f64;

/// A clock that stands still: all times are 0.
pub fn no_clock() -> f64 {
    0.0
}

/// A file that is given, with what lies beside it.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// Its name, for sentences.
    pub name: &'a str,
    /// GLB, VRM 0.x or 1.0, or the JSON of a `.gltf`.
    pub bytes: &'a [u8],
    /// The files that a `.gltf` names.
    pub beside: &'a Beside<'a>,
}

impl Source<'_> {
    fn read(&self) -> Result<GltfFile> {
        GltfFile::parse_with(self.name, self.bytes, self.beside)
    }
}

/// What to do with a target's rig.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RigChoice {
    /// Keep one that has the roles that are needed, else make one.
    #[default]
    Found,
    /// Keep it; one without these roles is an error.
    Keep,
    /// Make one, whatever there is.
    New,
}

/// How a target is read.
#[derive(Clone, Debug)]
pub struct OpenOptions {
    /// Which way the character stands and looks.
    pub axes: Axes,
    /// Role to node name, a JSON object, where the file does not say.
    pub humanoid_map: Option<Value>,
    /// Kinds by pattern, matched against `node|mesh|material`; the first that matches counts.
    pub kinds: Vec<(MeshKind, Regex)>,
    /// Where the eyes are, as far as it is said.
    pub face_hints: FaceHints,
    /// What to do with its rig.
    pub rig: RigChoice,
    /// How a new rig is made; joints that are given are for a new one alone.
    pub rig_options: RigOptions,
    /// Takes what its licence forbids to change: the user is its author or may change it.
    pub allow_prohibited: bool,
    /// Adds colliders around the legs where a VRM's skirt hangs from springs that none keeps out of them.
    pub leg_colliders: bool,
    /// Times the stages.
    pub clock: Clock,
}

impl Default for OpenOptions {
    fn default() -> Self {
        Self {
            axes: Axes::default(),
            humanoid_map: None,
            kinds: Vec::new(),
            face_hints: FaceHints::default(),
            rig: RigChoice::default(),
            rig_options: RigOptions::default(),
            allow_prohibited: false,
            leg_colliders: false,
            clock: no_clock,
        }
    }
}

/// A reference model, measured.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The model.
    pub loaded: Loaded,
    /// Its measures.
    pub measured: Measured,
}

impl Reference {
    /// Reads and measures a model; one without a rig gets one.
    ///
    /// - `humanoid_map`: as in [`OpenOptions`].
    /// - `options`: those of the conversion, since rays and bone groups are of both.
    ///
    /// # Errors
    /// One sentence that begins with the file's name.
    pub fn open(
        source: Source,
        humanoid_map: Option<&Value>,
        options: &Options,
        rig_options: &RigOptions,
    ) -> Result<Self> {
        let reading = LoadOptions { humanoid_map, find_roles: Some(&find_roles), ..LoadOptions::default() };
        let loaded = load(source.read()?, &reading)?;
        let name = &loaded.file.name;
        let about = |error: Error| Error { message: format!("{name}: {}", error.message), ..error };
        let rigged = if loaded.rigged {
            None
        } else {
            Some(Rig::of(&loaded.character, rig_options).map_err(about)?.applied_to(&loaded.character))
        };
        let character = rigged.as_ref().unwrap_or(&loaded.character);
        let mut measured = Measured::of(character, options).map_err(about)?;
        measured.shape.name = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem).to_string();
        Ok(Self { loaded, measured })
    }

    /// Its proportions, as a style.
    pub fn shape(&self) -> &BodyShape {
        &self.measured.shape
    }

    /// What was found while it was read. To take a model's proportions is no change of it, so its licence is not told.
    fn warnings(&self) -> impl Iterator<Item = Warning> {
        let about_licence =
            |code: &str| matches!(code, "modification_prohibited" | "redistribution_prohibited");
        self.loaded
            .warnings
            .iter()
            .filter(move |warning| !about_licence(warning.code))
            .map(|warning| Warning::new(warning.code, format!("in the reference, {}", warning.message)))
    }
}

/// A character that is open, and what has become of it so far.
#[derive(Clone, Debug)]
pub struct Conversion {
    target: Loaded,
    appearance: Appearance,
    rig: Option<Rig>,
    /// The target's character, with the new rig where there is one.
    character: Arc<Character>,
    deformer: Option<Deformer>,
    clock: Clock,
    load_ms: f64,
}

impl Conversion {
    /// Reads a character and makes the rig that it lacks, or that is wanted.
    ///
    /// # Errors
    /// One sentence: a file that cannot be read; a licence that forbids changes (`Error::option` is `allow_prohibited`); no
    /// rig can be made; `Cancelled`.
    pub fn open(source: Source, options: &OpenOptions, progress: &mut Progress) -> Result<Self> {
        let start = (options.clock)();
        let (mut target, appearance) = read_target(source, options)?;
        let load_ms = (options.clock)() - start;
        progress.at(0.2)?;
        let rig = rig(&mut target, options, &mut progress.part(0.2, 1.0))?;
        let character = match &rig {
            Some(rig) => rig.applied_to(&target.character),
            None => target.character.clone(),
        };
        progress.at(1.0)?;
        let character = Arc::new(character);
        Ok(Self { target, appearance, rig, character, deformer: None, clock: options.clock, load_ms })
    }

    /// The target as it was read.
    pub fn target(&self) -> &Loaded {
        &self.target
    }

    /// Its materials, texture coordinates and colours.
    pub fn appearance(&self) -> &Appearance {
        &self.appearance
    }

    /// The rig that was made for it; none where its own is kept.
    pub fn rig(&self) -> Option<&Rig> {
        self.rig.as_ref()
    }

    /// What deforms it; none before the first [`Conversion::set`].
    pub fn deformer(&self) -> Option<&Deformer> {
        self.deformer.as_ref()
    }

    fn styled(&self) -> Result<&Deformer> {
        self.deformer.as_ref().ok_or_else(|| bad_input("no style is set yet: set one first"))
    }

    /// Gives the character a style; only what depends on the change is made again, and the target is measured once.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`]; what was set before stays then.
    pub fn set(&mut self, style: &Style, options: &Options, progress: &mut Progress) -> Result<()> {
        if let Some(deformer) = &mut self.deformer {
            return deformer.set(style, options, progress);
        }
        let character = Arc::clone(&self.character);
        self.deformer = Some(match &self.rig {
            Some(rig) => {
                Deformer::with_rigged(character, &self.target.character, rig, style, options, progress)?
            }
            None => Deformer::with_progress(character, style, options, progress)?,
        });
        Ok(())
    }

    /// The file with its new shape, and the numbers.
    ///
    /// - `reference`: the model that the style was measured on, where it was one, for the report.
    ///
    /// # Errors
    /// Before the first [`Conversion::set`]; a result that is no number, or of 2 GB or more.
    pub fn write(&self, reference: Option<&Reference>, options: &WriteOptions) -> Result<Converted<'_>> {
        let deformer = self.styled()?;
        let deformed = deformer.apply();
        let map_point = |joint: usize, point: DVec3| deformer.map(joint, point);
        let model = || {
            let start = (self.clock)();
            let mut file = self.reshaped(deformer, &deformed)?;
            if options.leaf_joints {
                write::colliders::add_leaf_joints(&mut file, &self.target, &deformed, &map_point);
            }
            let (images, told) =
                even_eyes(&self.target, &self.appearance, &deformer.painted(), options.even_eyes);
            for (&image, evened) in &images {
                write::set_image(&mut file, image, &evened.to_png().map_err(bad_input)?);
            }
            Ok((file, (self.appearance.materials_with(images), told), (self.clock)() - start))
        };
        let threads = deformer.options().thread_count;
        let (made, report) = parallel::both(threads, model, || deformer.report(&deformed));
        let mut report = report?;
        let (file, (materials, even_eyes), write_ms) = made?;
        if let Some(reference) = reference {
            // Measured over the roles of both, so that the two figures can be compared group by group.
            let (of_target, of_reference) = (&deformer.target().joints, &reference.measured.joints);
            let roles = of_reference.keys().copied().filter(|role| of_target.contains_key(role)).collect();
            report.reference = Some(FigureReport::of(&reference.measured, &roles, deformer.options()));
            tell_swapped(&mut report);
        }
        let of_files = self.target.warnings.iter().cloned();
        let of_files = of_files.chain(reference.into_iter().flat_map(Reference::warnings));
        report.warnings.splice(0..0, of_files);
        report.warnings.extend(write::colliders::findings(
            &self.target,
            &deformed,
            &map_point,
            options.leaf_joints,
        ));
        report.timing_ms.load = self.load_ms;
        report.timing_ms.write = write_ms;
        let aim_degrees = write::colliders::aim_turn(&self.target, &deformed).map(|(degrees, _)| degrees);
        Ok(Converted { target: &self.target, file, deformed, report, materials, even_eyes, aim_degrees })
    }

    /// What changes at once, for while a slider moves: vertices, nodes and skins where [`Conversion::write`] puts them, under the
    /// same numbers, in a file of nothing else ([`write::at_rest`]); nothing is measured.
    ///
    /// # Errors
    /// As [`Conversion::write`].
    pub fn glimpse(&self) -> Result<GltfFile> {
        let deformer = self.styled()?;
        let asked = MeshOutputs { morph_targets: false, ..MeshOutputs::ALL };
        let asked = vec![asked; self.character.meshes.len()];
        let deformed = deformer.apply_to(&asked, &mut Progress::none())?;
        let mut file = write::at_rest(&self.target, &deformed)?;
        self.add_joints(&mut file, &deformed)?;
        Ok(file)
    }

    /// The deformed target as a file; what came without joints goes out with those of its new rig.
    fn reshaped(&self, deformer: &Deformer, deformed: &Deformed) -> Result<GltfFile> {
        let target = &self.target;
        let mut file = write::rewrite(target, deformed, &|joint, point: DVec3| deformer.map(joint, point))?;
        self.add_joints(&mut file, deformed)?;
        Ok(file)
    }

    /// Gives a file that came without joints those of its new rig.
    fn add_joints(&self, file: &mut GltfFile, deformed: &Deformed) -> Result<()> {
        let target = &self.target;
        let Some(rig) = self.rig.as_ref().filter(|_| !target.rigged) else { return Ok(()) };
        let mut skeleton = rig.skeleton.clone();
        for (joint, &at) in skeleton.joints.iter_mut().zip(&deformed.joints) {
            joint.rest.w_axis = at.extend(1.0);
        }
        add_rig(file, target, &skeleton, &limited(rig))
    }

    /// The target with the rig that it is deformed by, not deformed.
    ///
    /// # Errors
    /// As [`rerigged`].
    pub fn rigged(&self) -> Result<GltfFile> {
        match &self.rig {
            Some(rig) => rerigged(&self.target, &rig.skeleton, &limited(rig)),
            None => Ok(self.target.file.clone()),
        }
    }
}

/// How a result is written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WriteOptions {
    /// How much of the shade that is painted around eyes is evened, 0 to 1; where it is not said, as [`EvenEyes`] tells.
    pub even_eyes: Option<f64>,
    /// Gives each spring chain of a VRM 0.x one joint more, so that its last bone keeps its proportion.
    pub leaf_joints: bool,
}

/// A result.
#[derive(Clone, Debug)]
pub struct Converted<'a> {
    target: &'a Loaded,
    /// The file.
    pub file: GltfFile,
    /// Its shape.
    pub deformed: Deformed,
    /// The numbers, and in `warnings` what a person should know.
    pub report: Report,
    /// Its materials.
    pub materials: Vec<Material>,
    /// What was done about shade that is painted around its eyes.
    pub even_eyes: EvenEyes,
    /// By how many degrees the aim constraint that turns most does at rest.
    pub aim_degrees: Option<f64>,
}

/// The report as text: the library's, and what is known of the target's file.
#[derive(Serialize)]
struct FileReport<'a> {
    #[serde(flatten)]
    report: &'a Report,
    licence: Value,
    even_eyes: &'a EvenEyes,
    #[serde(skip_serializing_if = "Option::is_none")]
    aim_degrees: Option<f64>,
    /// What a batch knows a finished run by.
    #[serde(skip_serializing_if = "Option::is_none")]
    batch: Option<Value>,
}

impl Converted<'_> {
    /// Puts a PNG in the place of a VRM's thumbnail; what is no VRM has none.
    pub fn set_thumbnail(&mut self, png: &[u8]) {
        write::set_thumbnail(&mut self.file, png);
    }

    /// The files of the result, the first of them called `name`: a `.gltf` with its buffer and images, each with its path
    /// beside it; for any other ending one GLB.
    ///
    /// # Errors
    /// 2 GB or more; a name that ends in `.vrm` for what is no VRM, since no viewer would open it.
    pub fn files(&self, name: &str) -> Result<Vec<(String, Vec<u8>)>> {
        let from = &self.target.file.name;
        if ends_in(name, "vrm") && !ends_in(from, "vrm") && !is_vrm(&self.target.file) {
            return Err(bad_input(format!(
                "{from} is no VRM, so {name} would be none: give the result a name that ends in .glb or .gltf, or make {from} a VRM first (Blender with the VRM add-on, UniVRM)"
            )));
        }
        if is_gltf(name) {
            self.file.to_parts(name)
        } else {
            Ok(vec![(name.to_string(), self.file.to_bytes()?)])
        }
    }

    /// The report as indented JSON, with the licence of the target, its aim that turns most, and what a batch knows the run
    /// by.
    ///
    /// # Errors
    /// What JSON cannot hold.
    pub fn report_text(&self, batch: Option<Value>) -> Result<String> {
        let licence = self.target.licence.to_json();
        let Self { report, even_eyes, aim_degrees, .. } = self;
        let report = FileReport { report, licence, even_eyes, aim_degrees: *aim_degrees, batch };
        let text = serde_json::to_string_pretty(&report).map_err(|error| bad_input(error.to_string()))?;
        Ok(text + "\n")
    }
}

/// A reference of this many times the target's heads is taken to have been meant as the target: grown-ups have 5 to 8 heads,
/// super-deformed figures 1.8 to 3.5.
const SWAPPED: f64 = 1.5;

/// Asks whether target and reference are swapped, in the place of the warning that little is left to deform.
fn tell_swapped(report: &mut Report) {
    let (Some(reference), target) = (&report.reference, report.target.heads) else { return };
    if reference.heads > SWAPPED * target {
        let heads = reference.heads;
        let message =
            format!("the reference has {heads:.1} heads and the target {target:.1}: are they swapped?");
        report.warnings.retain(|warning| warning.code != "already_super_deformed");
        report.warnings.insert(0, Warning::new("already_super_deformed", message));
    }
}

/// True for the name of a glTF file whose buffer and images lie beside it.
pub fn is_gltf(name: &str) -> bool {
    ends_in(name, "gltf")
}

fn ends_in(name: &str, wanted: &str) -> bool {
    name.rsplit_once('.').is_some_and(|(_, ending)| ending.eq_ignore_ascii_case(wanted))
}

/// The target, its paint and what is said of its face.
fn read_target(source: Source, options: &OpenOptions) -> Result<(Loaded, Appearance)> {
    let reading = LoadOptions {
        axes: options.axes,
        humanoid_map: options.humanoid_map.as_ref(),
        kinds: &options.kinds,
        find_roles: Some(&find_roles),
        without_rig: false,
        incomplete_rig: options.rig != RigChoice::Keep,
    };
    let mut target = load(source.read()?, &reading)?;
    let licence = &target.licence;
    if licence.is_prohibited() && !options.allow_prohibited {
        let message = format!(
            "{}'s licence does not allow changes ({}): ask its author, or say that you are the author or may change it",
            target.file.name, licence.because
        );
        return Err(Error::new(ErrorKind::BadInput, message).about("allow_prohibited"));
    }
    guard_legs(&mut target, options.leg_colliders);
    let appearance = Appearance::of(&target, options.rig_options.thread_count);
    shade(&mut target.character, &appearance);
    target.character.face_hints = options.face_hints;
    Ok((target, appearance))
}

/// The rig to deform by where the target's own is not kept: it has none, it is not wanted, or it does not say which joint is
/// which.
fn rig(target: &mut Loaded, options: &OpenOptions, progress: &mut Progress) -> Result<Option<Rig>> {
    let missing = target.character.humanoid.missing();
    let keep = target.rigged && options.rig != RigChoice::New;
    if keep && missing.is_empty() {
        if !options.rig_options.given.is_empty() {
            let message =
                "joints are given for a new rig, and the target has one: ask for a new one, or give none";
            return Err(Error::new(ErrorKind::BadOption, message).about("rig"));
        }
        return Ok(None);
    }
    if keep {
        let message = format!(
            "{} shows no joint for the role {}, so a new rig was found for the deformation and the file's own joints ride along: name roles to use the file's rig",
            target.file.name, missing[0]
        );
        target.warnings.push(Warning::new("rig_fallback_auto", message).about("humanoid"));
    }
    let rig = Rig::with_progress(&target.character, &options.rig_options, progress)?;
    target.character.axes.forward = Some(rig.forward.as_vec3());
    Ok(Some(rig))
}

/// The weights that a file holds.
fn limited(rig: &Rig) -> Vec<Weights> {
    rig.skin_weights.iter().map(|weights| weights.limited(INFLUENCES)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accessor::Reader;
    use crate::{array_at, index_at, samples};
    use serde_json::json;
    use std::collections::BTreeMap;

    fn rogue() -> Vec<u8> {
        std::fs::read(samples::data().join("kaykit_rogue.glb")).unwrap()
    }

    fn open(bytes: &[u8], options: &OpenOptions) -> Result<Conversion> {
        let source = Source { name: "rogue.glb", bytes, beside: &|_| None };
        Conversion::open(source, options, &mut Progress::none())
    }

    #[test]
    fn what_is_set_again_and_again_is_as_if_it_were_set_once() {
        let bytes = rogue();
        let mut slid = open(&bytes, &OpenOptions::default()).unwrap();
        assert!(slid.write(None, &WriteOptions::default()).is_err(), "nothing is set");
        let half = Options { amount: 0.5, ..Options::default() };
        let heads = |heads| Style::heads(heads).unwrap();
        for (style, options) in [(heads(2.0), &Options::default()), (heads(1.9), &half)] {
            slid.set(&style, options, &mut Progress::none()).unwrap();
        }
        slid.set(&heads(1.9), &Options::default(), &mut Progress::none()).unwrap();
        let wrong = Options { amount: 2.0, ..Options::default() };
        assert!(slid.set(&heads(1.9), &wrong, &mut Progress::none()).is_err());
        let mut once = open(&bytes, &OpenOptions::default()).unwrap();
        once.set(&heads(1.9), &Options::default(), &mut Progress::none()).unwrap();
        let written = |conversion: &Conversion| {
            let converted = conversion.write(None, &WriteOptions::default()).unwrap();
            (converted.files("a.glb").unwrap(), converted.report)
        };
        let ((slid, of_slid), (once, of_once)) = (written(&slid), written(&once));
        assert!(slid == once);
        let untimed = |report: Report| Report { timing_ms: Default::default(), ..report };
        assert_eq!(untimed(of_slid), untimed(of_once));
    }

    #[test]
    fn a_host_sees_that_a_licence_forbids_and_may_ask() {
        let mut file = GltfFile::parse("a.glb", &rogue()).unwrap();
        file.json["asset"]["extras"] =
            json!({"license": "CC-BY-ND-4.0 (http://creativecommons.org/licenses/by-nd/4.0/)"});
        let bytes = file.to_bytes().unwrap();
        assert_eq!(open(&bytes, &OpenOptions::default()).unwrap_err().option, Some("allow_prohibited"));
        let allowed = OpenOptions { allow_prohibited: true, ..OpenOptions::default() };
        assert!(open(&bytes, &allowed).unwrap().target().licence.is_prohibited());
    }

    /// Every number of a glimpse, beside that of the whole file.
    fn compare(glimpse: &GltfFile, whole: &GltfFile) {
        let (seen, real) = (Reader::new(glimpse), Reader::new(whole));
        let mut count = 0;
        let mut same = |one: &Value, two: &Value, key: &str, components: usize| {
            let Some(accessor) = index_at(one, key) else { return };
            // A viewer reads it without asking how numbers lie.
            let layout = seen.layout(accessor).unwrap();
            assert_eq!((layout.component_type, layout.stride), (5126, 4 * components), "{key}");
            assert!(!layout.sparse && layout.start.unwrap().is_multiple_of(4), "{key}");
            let floats = |reader: &Reader, accessor| reader.floats(accessor, components, None).unwrap();
            let (one, two) = (floats(&seen, accessor), floats(&real, index_at(two, key).unwrap()));
            assert!(one == two, "{key}");
            count += 1;
        };
        for (one, two) in glimpse.list("meshes").iter().zip(whole.list("meshes")) {
            for (one, two) in array_at(one, "primitives").iter().zip(array_at(two, "primitives")) {
                for (key, components) in [("POSITION", 3), ("NORMAL", 3), ("TANGENT", 4)] {
                    same(&one["attributes"], &two["attributes"], key, components);
                }
            }
        }
        for (one, two) in glimpse.list("skins").iter().zip(whole.list("skins")) {
            same(one, two, "inverseBindMatrices", 16);
        }
        assert!(count > 2, "a glimpse of {count} lists");
        assert_eq!(glimpse.json["nodes"], whole.json["nodes"]);
        for list in ["meshes", "skins"] {
            assert_eq!(glimpse.list(list).len(), whole.list(list).len(), "{list}");
        }
    }

    #[test]
    fn a_glimpse_is_what_the_whole_file_is_but_for_what_stays() {
        let data = ["kaykit_rogue.glb", "quaternius_female_dress_unrigged.glb"];
        let more = ["godette.vrm", "makehuman_female_rigged.glb", "cesiumman.glb"];
        for path in data.iter().chain(&more).filter_map(|name| samples::path(name)) {
            let mut conversion = open(
                &std::fs::read(path).unwrap(),
                &OpenOptions { allow_prohibited: true, ..OpenOptions::default() },
            )
            .unwrap();
            for amount in [1.0, 0.0] {
                let options = Options { amount, ..Options::default() };
                conversion.set(&Style::heads(2.0).unwrap(), &options, &mut Progress::none()).unwrap();
                let converted = conversion.write(None, &WriteOptions::default()).unwrap();
                compare(&conversion.glimpse().unwrap(), &converted.file);
            }
        }
    }

    /// A `.gltf` with everything beside it, one image of a kind that nobody here reads.
    fn in_parts() -> (Vec<u8>, BTreeMap<String, Vec<u8>>) {
        let mut file = GltfFile::parse("a.glb", &rogue()).unwrap();
        let image = file.list("images").len();
        file.json["images"].as_array_mut().unwrap().push(json!({"uri": "maps/my%20skin.ktx2"}));
        file.json["textures"][0]["extensions"] = json!({"KHR_texture_basisu": {"source": image}});
        for list in ["extensionsUsed", "extensionsRequired"] {
            file.json[list] = json!(["KHR_texture_basisu"]);
        }
        let ktx2 = b"\xABKTX 20\xBB\r\n\x1A\n and more".to_vec();
        file.images.insert("maps/my%20skin.ktx2".into(), Arc::new(ktx2));
        let mut parts: BTreeMap<String, Vec<u8>> = file.to_parts("a.gltf").unwrap().into_iter().collect();
        (parts.remove("a.gltf").unwrap(), parts)
    }

    #[test]
    fn what_lies_beside_a_file_goes_within_the_result_or_beside_it() {
        let (text, parts) = in_parts();
        assert!(parts.keys().eq(["a.bin", "maps/my skin.ktx2"]), "{:?}", parts.keys());
        let whole = Source { name: "a.gltf", bytes: &text, beside: &|path| parts.get(path).cloned() };
        let mut conversion = Conversion::open(whole, &OpenOptions::default(), &mut Progress::none()).unwrap();
        conversion.set(&Style::heads(2.0).unwrap(), &Options::default(), &mut Progress::none()).unwrap();
        let converted = conversion.write(None, &WriteOptions::default()).unwrap();
        let image = &parts["maps/my skin.ktx2"];
        // Within: a GLB that needs nothing else.
        let glb = GltfFile::parse("b.glb", &converted.files("b.glb").unwrap()[0].1).unwrap();
        let last = glb.list("images").len() - 1;
        assert!(glb.image(last).unwrap() == image.as_slice() && glb.images.is_empty());
        assert_eq!(glb.list("images")[last]["mimeType"], "image/ktx2");
        // Beside: the same shape, the image as it was.
        let files: BTreeMap<String, Vec<u8>> = converted.files("b.gltf").unwrap().into_iter().collect();
        assert!(files.keys().eq(["b.bin", "b.gltf", "maps/my skin.ktx2"]), "{:?}", files.keys());
        assert!(&files["maps/my skin.ktx2"] == image);
        let beside = |path: &str| files.get(path).cloned();
        let gltf = GltfFile::parse_with("b.gltf", &files["b.gltf"], &beside).unwrap();
        assert_eq!(gltf.json["extensionsRequired"], json!(["KHR_texture_basisu"]));
        let skinned = |file: &GltfFile| crate::verify::skinned(file).unwrap();
        assert!(skinned(&gltf) == skinned(&glb));
        let alone = Source { name: "a.gltf", bytes: &text, beside: &|_| None };
        let refusal = Conversion::open(alone, &OpenOptions::default(), &mut Progress::none()).unwrap_err();
        assert!(refusal.message.contains("a.bin"), "{refusal}");
    }

    #[test]
    fn a_reference_of_many_more_heads_than_the_target_is_asked_about() {
        let figure = |heads| FigureReport { heads, ..FigureReport::default() };
        let said = |target, reference| {
            let little = Warning::new("already_super_deformed", "little is left");
            let report =
                Report { target: figure(target), reference: Some(figure(reference)), ..Report::default() };
            let mut report = Report { warnings: vec![little], ..report };
            tell_swapped(&mut report);
            assert_eq!(report.warnings.len(), 1);
            report.warnings[0].message.clone()
        };
        assert_eq!(said(2.3, 8.0), "the reference has 8.0 heads and the target 2.3: are they swapped?");
        assert_eq!(said(1.9, 2.3), "little is left");
        assert_eq!(said(8.0, 2.3), "little is left");
    }

    #[test]
    fn what_is_no_vrm_is_not_called_one() {
        let mut conversion = open(&rogue(), &OpenOptions::default()).unwrap();
        conversion.set(&Style::heads(2.0).unwrap(), &Options::default(), &mut Progress::none()).unwrap();
        let converted = conversion.write(None, &WriteOptions::default()).unwrap();
        let refusal = converted.files("b.VRM").unwrap_err();
        assert!(refusal.message.contains("b.VRM") && refusal.message.contains("rogue.glb"), "{refusal}");
        assert!(converted.files("b").is_ok());
    }

    #[test]
    fn joints_are_for_a_new_rig_alone() {
        let rig_options = RigOptions {
            given: [(superdeform::Role::LeftHand, DVec3::ONE)].into_iter().collect(),
            ..RigOptions::default()
        };
        let options = OpenOptions { rig_options, ..OpenOptions::default() };
        assert_eq!(open(&rogue(), &options).unwrap_err().option, Some("rig"));
    }
}
