//! One character, open: what a message may ask, and what is kept between messages.
//!
//! | `"do"` | what it needs | what it gives |
//! | --- | --- | --- |
//! | `"options"` | | `options`: what can be set, with ranges and defaults |
//! | `"open"` | `files`: the character first, then what a `.gltf` names; `allow_prohibited` | what is known of it |
//! | `"rigged"` | | one file: the character with the rig that it moves by |
//! | `"reference"` | `files`, or none: there is no reference any more | `heads`, `name` |
//! | `"set"` | `style`, `options` | `warnings` |
//! | `"glimpse"` | | one file, for while a slider moves |
//! | `"write"` | `name`, `even_eyes`, `leaf_joints`, `by_reference` | its files, `report`: the text of the report |
//! | `"fault"` | | nothing: it panics, for hosts to see what becomes of them then |
//!
//! An answer with `error` says in one sentence why there is no other; `option` is what it is about.

use crate::asked::{options, style, table};
use crate::message::{File, files_of, json_of, message};
use serde_json::{Map, Value, json};
use superdeform::{Error, ErrorKind, Options, Progress, Result, RigOptions, Role, Warning};
use superdeform_host::conversion::{Conversion, OpenOptions, Reference, Source, WriteOptions};

/// What is open.
#[derive(Default)]
pub struct Session {
    conversion: Option<Conversion>,
    reference: Option<Reference>,
}

/// An answer before it is put together.
type Answer = (Value, Vec<(String, Vec<u8>)>);

#[cfg(target_arch = "wasm32")]
mod outside {
    #[link(wasm_import_module = "superdeform")]
    unsafe extern "C" {
        /// Tells how far the work is: from 0 to 1.
        pub safe fn progress(share: f32);
    }
}

fn tell(share: f32) -> bool {
    #[cfg(target_arch = "wasm32")]
    outside::progress(share);
    let _ = share;
    true
}

impl Session {
    /// Does what a message says.
    pub fn answer(&mut self, given: &[u8]) -> Vec<u8> {
        let answered = match json_of(given) {
            Some((json, bytes)) => match files_of(&json, bytes) {
                Some(files) => self.done(&json, &files),
                None => Err(wrong("a message holds fewer bytes than it says")),
            },
            None => Err(wrong("a message is a size, its JSON and files")),
        };
        match answered {
            Ok((json, files)) => message(json, &files),
            Err(error) => message(json!({"error": error.to_string(), "option": error.option}), &[]),
        }
    }

    fn done(&mut self, json: &Value, files: &[File]) -> Result<Answer> {
        match json["do"].as_str().unwrap_or_default() {
            "options" => Ok((json!({"options": table()}), Vec::new())),
            "open" => self.open(json, files),
            "rigged" => {
                Ok((json!({}), vec![("rigged.glb".to_string(), self.opened()?.rigged()?.to_bytes()?)]))
            }
            "reference" => self.refer(files),
            "set" => self.set(json),
            "glimpse" => {
                Ok((json!({}), vec![("glimpse.glb".to_string(), self.opened()?.glimpse()?.to_bytes()?)]))
            }
            "write" => self.write(json),
            "fault" => panic!("a fault was asked for"),
            other => Err(wrong(&format!("nothing is known to do for {other:?}"))),
        }
    }

    fn opened(&self) -> Result<&Conversion> {
        self.conversion.as_ref().ok_or_else(|| wrong("no character is open: open one first"))
    }

    fn open(&mut self, json: &Value, files: &[File]) -> Result<Answer> {
        self.conversion = None;
        let options = OpenOptions {
            allow_prohibited: json["allow_prohibited"] == true,
            leg_colliders: json["leg_colliders"] == true,
            humanoid_map: json.get("humanoid").filter(|map| map.is_object()).cloned(),
            ..OpenOptions::default()
        };
        let conversion =
            with_source(files, |source| Conversion::open(source, &options, &mut Progress::new(&mut tell)))?;
        let about = about(&conversion);
        self.conversion = Some(conversion);
        Ok((about, Vec::new()))
    }

    fn refer(&mut self, files: &[File]) -> Result<Answer> {
        self.reference = None;
        if files.is_empty() {
            return Ok((json!({}), Vec::new()));
        }
        let options = Options::default();
        let reference =
            with_source(files, |source| Reference::open(source, None, &options, &RigOptions::default()))?;
        let shape = reference.shape();
        let answer = json!({"name": shape.name, "heads": shape.heads()});
        self.reference = Some(reference);
        Ok((answer, Vec::new()))
    }

    fn set(&mut self, json: &Value) -> Result<Answer> {
        let style = style(&json["style"], self.reference.as_ref())?;
        let options = options(&json["options"])?;
        let conversion =
            self.conversion.as_mut().ok_or_else(|| wrong("no character is open: open one first"))?;
        conversion.set(&style, &options, &mut Progress::new(&mut tell))?;
        let found = conversion.deformer().map_or(&[][..], |deformer| deformer.warnings());
        Ok((json!({"warnings": found.iter().map(told).collect::<Value>()}), Vec::new()))
    }

    fn write(&mut self, json: &Value) -> Result<Answer> {
        let name = json["name"].as_str().unwrap_or("character_sd.glb");
        let options = WriteOptions {
            even_eyes: json["even_eyes"].as_f64().map(|share| share.clamp(0.0, 1.0)),
            leaf_joints: json["leaf_joints"] == true,
        };
        let by_reference = self.reference.as_ref().filter(|_| json["by_reference"] == true);
        let converted = self.opened()?.write(by_reference, &options)?;
        let report = converted.report_text(None)?;
        Ok((json!({"report": report}), converted.files(name)?))
    }
}

fn wrong(message: &str) -> Error {
    Error::new(ErrorKind::BadInput, message)
}

/// Gives the first of `files` to `work`, with the others beside it.
fn with_source<T>(files: &[File], work: impl FnOnce(Source) -> Result<T>) -> Result<T> {
    let (first, others) = files.split_first().ok_or_else(|| wrong("there is no file: give one"))?;
    let beside = |path: &str| {
        let ends_so = |file: &&File| file.name == path || file.name.ends_with(&format!("/{path}"));
        // A page that is given single files knows no folders.
        let last = |file: &&File| path.rsplit('/').next() == Some(file.name);
        let found = others.iter().find(ends_so).or_else(|| others.iter().find(last));
        found.map(|file| file.bytes.to_vec())
    };
    work(Source { name: first.name, bytes: first.bytes, beside: &beside })
}

fn told(warning: &Warning) -> Value {
    json!({"code": warning.code, "message": warning.message})
}

/// What a page shows of a character that was opened.
fn about(conversion: &Conversion) -> Value {
    let target = conversion.target();
    let meshes = &target.character.meshes;
    let rig = conversion.rig();
    let (humanoid, skeleton) = match rig {
        Some(rig) => (&rig.humanoid, &rig.skeleton),
        None => (&target.character.humanoid, &target.character.skeleton),
    };
    let joint = |(role, joint): (Role, usize)| {
        let known = &skeleton.joints[joint];
        let entry = json!({
            "name": known.name,
            "node": if rig.is_none() { target.node_of_joint.get(joint).copied() } else { None },
            "position": known.position().to_array(),
            "confidence": rig.map_or(1.0, |rig| rig.confidence[joint]),
        });
        (role.name().to_string(), entry)
    };
    let joints: Map<String, Value> = humanoid.iter().map(joint).collect();
    let found = rig.map_or(&[][..], |rig| &rig.warnings);
    json!({
        "vertices": meshes.iter().map(|mesh| mesh.positions.len()).sum::<usize>(),
        "meshes": meshes.len(),
        "morph_targets": meshes.iter().map(|mesh| mesh.morph_targets.len()).sum::<usize>(),
        "joints": joints,
        "new_rig": rig.is_some(),
        "licence": target.licence.to_json(),
        "prohibited": target.licence.is_prohibited(),
        "warnings": target.warnings.iter().chain(found).map(told).collect::<Value>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use superdeform_host::samples;

    fn asked(session: &mut Session, json: Value, files: &[(String, Vec<u8>)]) -> (Value, Vec<Vec<u8>>) {
        let answer = session.answer(&message(json, files));
        let (json, rest) = json_of(&answer).unwrap();
        let files = files_of(&json, rest).unwrap().iter().map(|file| file.bytes.to_vec()).collect();
        (json, files)
    }

    #[test]
    fn a_session_goes_from_bytes_to_bytes_and_survives_nonsense() {
        let mut session = Session::default();
        let rogue = std::fs::read(samples::data().join("kaykit_rogue.glb")).unwrap();
        let file = [("rogue.glb".to_string(), rogue)];
        for first in ["set", "write", "rigged", "glimpse", "dance", "open"] {
            assert!(asked(&mut session, json!({"do": first}), &[]).0["error"].is_string(), "{first}");
        }
        let (about, _) = asked(&mut session, json!({"do": "open"}), &file);
        assert!(about["vertices"].as_u64().unwrap() > 1000 && about["new_rig"] == false, "{about}");
        let set = json!({"do": "set", "style": {"heads": 1.9}, "options": {"youth": 0.5}});
        assert!(asked(&mut session, set.clone(), &[]).0["error"].is_null());
        let (written, files) = asked(&mut session, json!({"do": "write", "name": "a.glb"}), &[]);
        let report: Value = serde_json::from_str(written["report"].as_str().unwrap()).unwrap();
        assert!(report["result"]["heads"].is_f64());
        assert!(files[0].starts_with(b"glTF"));
        assert!(session.answer(b"x").len() > 4);
        let cut = [("cut.glb".to_string(), file[0].1[..500].to_vec())];
        let (refused, _) = asked(&mut session, json!({"do": "reference"}), &cut);
        assert!(refused["error"].as_str().unwrap().starts_with("cut.glb"), "{refused}");
        // What was open stays open.
        assert_eq!(asked(&mut session, json!({"do": "write", "name": "a.glb"}), &[]).1, files);
    }
}
