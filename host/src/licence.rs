//! What a file's licence says about changing it.
//!
//! VRM 1.0 has a field for it, VRM 0.x names one of a few licences, and both may name a page: VRoid Hub's say in their
//! address what is allowed, Creative Commons' which licence it is.

use crate::file::GltfFile;
use crate::{array_at, text_at};
use serde_json::{Value, json};
use superdeform::Warning;

/// Whether the result of a change may be made, and given to others; from free to strict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Changes {
    /// The file does not say.
    #[default]
    NotStated,
    /// Changed versions may be made and passed on, as far as the file says.
    Allowed,
    /// Changed versions may be made, but not passed on.
    NotToShare,
    /// No changed versions.
    Prohibited,
}

impl Changes {
    /// As reports spell it.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotStated => "not stated",
            Self::Allowed => "allowed",
            Self::NotToShare => "not to share",
            Self::Prohibited => "prohibited",
        }
    }
}

/// What a file says of its licence.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Licence {
    /// The licence's name, the address of its text, or the note of a copyright; empty where the file has none.
    pub name: String,
    /// Who made the character.
    pub authors: Vec<String>,
    /// Whether it may be changed.
    pub changes: Changes,
    /// Which words of the file say so, as in `licenseName CC_BY_ND`.
    pub because: String,
}

impl Licence {
    /// Reads the header of VRM 1.0 or 0.x; of other files what `asset` says.
    ///
    /// Of several statements the strictest counts. VRM 1.0's `modification` is `prohibited` where it is not given, as
    /// its schema says.
    pub fn of(file: &GltfFile) -> Self {
        let extensions = &file.json["extensions"];
        if extensions["VRMC_vrm"].is_object() {
            vrm1(&extensions["VRMC_vrm"]["meta"])
        } else if extensions["VRM"].is_object() {
            vrm0(&extensions["VRM"]["meta"])
        } else {
            plain(&file.json["asset"])
        }
    }

    /// True where no changed version may be made.
    pub fn is_prohibited(&self) -> bool {
        self.changes == Changes::Prohibited
    }

    /// What a person should know before the result goes further; `name` is the file's.
    pub fn warning(&self, name: &str) -> Option<Warning> {
        match self.changes {
            Changes::Prohibited => Some(Warning::new(
                "modification_prohibited",
                format!(
                    "{name}'s licence does not allow changes ({}): ask its author before sharing the result",
                    self.because
                ),
            )),
            Changes::NotToShare => Some(Warning::new(
                "redistribution_prohibited",
                format!(
                    "{name}'s licence does not allow to pass a changed version on ({}): keep the result to yourself, or ask its author",
                    self.because
                ),
            )),
            Changes::NotStated | Changes::Allowed => None,
        }
    }

    /// As a report has it; `null` where the file says nothing.
    pub fn to_json(&self) -> Value {
        if *self == Self::default() {
            return Value::Null;
        }
        json!({
            "name": self.name,
            "authors": self.authors,
            "changes": self.changes.name(),
            "because": self.because,
        })
    }

    /// Takes a statement into account where it is stricter than what is known.
    fn hear(&mut self, changes: Changes, because: impl FnOnce() -> String) {
        if changes > self.changes {
            self.changes = changes;
            self.because = because();
        }
    }

    /// What the address at `key` says.
    fn hear_address(&mut self, meta: &Value, key: &str) {
        let address = text_at(meta, key);
        self.hear(of_address(address), || format!("{key} {address}"));
    }
}

fn vrm1(meta: &Value) -> Licence {
    let texts = array_at(meta, "authors").iter().filter_map(Value::as_str);
    let other = text_at(meta, "otherLicenseUrl");
    let mut licence = Licence {
        name: if other.is_empty() { text_at(meta, "licenseUrl") } else { other }.to_string(),
        authors: texts.map(str::to_string).collect(),
        ..Licence::default()
    };
    match text_at(meta, "modification") {
        "allowModificationRedistribution" => {
            licence.hear(Changes::Allowed, || {
                "meta.modification is allowModificationRedistribution".to_string()
            });
        }
        "allowModification" => {
            licence.hear(Changes::NotToShare, || "meta.modification is allowModification".to_string());
        }
        "" => licence.hear(Changes::Prohibited, || {
            "meta.modification is not given, which means prohibited".to_string()
        }),
        other => licence.hear(Changes::Prohibited, || format!("meta.modification is {other}")),
    }
    licence.hear_address(meta, "licenseUrl");
    licence.hear_address(meta, "otherLicenseUrl");
    licence
}

fn vrm0(meta: &Value) -> Licence {
    let name = text_at(meta, "licenseName");
    let address = text_at(meta, "otherLicenseUrl");
    let author = text_at(meta, "author");
    let mut licence = Licence {
        name: if matches!(name, "" | "Other") && !address.is_empty() { address } else { name }.to_string(),
        authors: Some(author).filter(|author| !author.is_empty()).map(str::to_string).into_iter().collect(),
        ..Licence::default()
    };
    let changes = match name {
        "CC0" | "CC_BY" | "CC_BY_NC" | "CC_BY_SA" | "CC_BY_NC_SA" => Changes::Allowed,
        "CC_BY_ND" | "CC_BY_NC_ND" => Changes::Prohibited,
        "Redistribution_Prohibited" => Changes::NotToShare,
        _ => Changes::NotStated,
    };
    licence.hear(changes, || format!("licenseName {name}"));
    licence.hear_address(meta, "otherPermissionUrl");
    licence.hear_address(meta, "otherLicenseUrl");
    licence
}

/// `asset.copyright`, and the licence where models from Sketchfab have it.
fn plain(asset: &Value) -> Licence {
    let text = text_at(&asset["extras"], "license");
    let name = if text.is_empty() { text_at(asset, "copyright") } else { text };
    let mut licence = Licence { name: name.to_string(), ..Licence::default() };
    let author = text_at(&asset["extras"], "author");
    licence.authors.extend(Some(author).filter(|author| !author.is_empty()).map(str::to_string));
    for key in ["license", "copyright"] {
        let holder = if key == "license" { &asset["extras"] } else { asset };
        let text = text_at(holder, key);
        let words = text.split(|letter: char| letter.is_whitespace() || matches!(letter, '(' | ')' | ','));
        for address in words.filter(|word| word.starts_with("http")) {
            licence.hear(of_address(address), || format!("asset {key}: {text}"));
        }
    }
    licence
}

/// What the address of a licence says by itself.
///
/// VRoid Hub: `https://hub.vroid.com/license?...&modification=disallow&redistribution=allow...`. Creative Commons:
/// `https://creativecommons.org/licenses/by-nc-nd/4.0/`.
fn of_address(address: &str) -> Changes {
    let address = address.trim().to_ascii_lowercase();
    let Some((_, rest)) = address.split_once("://") else {
        return Changes::NotStated;
    };
    let (host, rest) = rest.split_once('/').unwrap_or((rest, ""));
    let (path, query) = rest.split_once('?').unwrap_or((rest, ""));
    let query = query.split('#').next().unwrap_or("");
    match host.trim_start_matches("www.") {
        "hub.vroid.com" if path.trim_end_matches('/').ends_with("license") => {
            let says = |key: &str| {
                query.split('&').filter_map(|pair| pair.split_once('=')).find(|pair| pair.0 == key)
            };
            let disallows = |key: &str| says(key).is_some_and(|(_, value)| value == "disallow");
            if disallows("modification") {
                Changes::Prohibited
            } else if disallows("redistribution") {
                Changes::NotToShare
            } else if says("modification").is_some() {
                Changes::Allowed
            } else {
                Changes::NotStated
            }
        }
        "creativecommons.org" => {
            let mut parts = path.split('/').filter(|part| !part.is_empty());
            match (parts.next(), parts.next()) {
                (Some("licenses"), Some(kind)) if kind.split('-').any(|part| part == "nd") => {
                    Changes::Prohibited
                }
                (Some("licenses" | "publicdomain"), Some(_)) => Changes::Allowed,
                _ => Changes::NotStated,
            }
        }
        _ => Changes::NotStated,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn licence(header: &Value) -> Licence {
        let file = GltfFile { name: "a.vrm".to_string(), json: header.clone(), ..GltfFile::default() };
        Licence::of(&file)
    }

    fn vrm0_with(meta: Value) -> Changes {
        licence(&json!({"extensions": {"VRM": {"meta": meta}}})).changes
    }

    fn vrm1_with(meta: Value) -> Changes {
        licence(&json!({"extensions": {"VRMC_vrm": {"meta": meta}}})).changes
    }

    #[test]
    fn vrm_1_prohibits_unless_it_allows() {
        assert_eq!(vrm1_with(json!({})), Changes::Prohibited);
        assert_eq!(vrm1_with(json!({"modification": "prohibited"})), Changes::Prohibited);
        assert_eq!(vrm1_with(json!({"modification": "allowModification"})), Changes::NotToShare);
        assert_eq!(vrm1_with(json!({"modification": "allowModificationRedistribution"})), Changes::Allowed);
        let both = json!({
            "modification": "allowModificationRedistribution",
            "otherLicenseUrl": "https://creativecommons.org/licenses/by-nd/4.0/",
        });
        assert_eq!(vrm1_with(both), Changes::Prohibited, "the strictest counts");
    }

    #[test]
    fn each_licence_name_of_vrm_0_is_known() {
        for (name, changes) in [
            ("CC0", Changes::Allowed),
            ("CC_BY", Changes::Allowed),
            ("CC_BY_NC", Changes::Allowed),
            ("CC_BY_SA", Changes::Allowed),
            ("CC_BY_NC_SA", Changes::Allowed),
            ("CC_BY_ND", Changes::Prohibited),
            ("CC_BY_NC_ND", Changes::Prohibited),
            ("Redistribution_Prohibited", Changes::NotToShare),
            ("Other", Changes::NotStated),
        ] {
            assert_eq!(vrm0_with(json!({"licenseName": name})), changes, "{name}");
        }
    }

    #[test]
    fn an_address_of_vroid_hub_says_what_is_allowed() {
        let address =
            |words: &str| format!("https://hub.vroid.com/en/license?credit=necessary&{words}&version=1");
        let with =
            |words: &str| vrm0_with(json!({"licenseName": "Other", "otherPermissionUrl": address(words)}));
        assert_eq!(with("modification=disallow"), Changes::Prohibited);
        assert_eq!(with("modification=allow&redistribution=disallow"), Changes::NotToShare);
        assert_eq!(with("modification=allow&redistribution=allow"), Changes::Allowed);
        let elsewhere = json!({"otherPermissionUrl": "https://example.org/license?modification=disallow"});
        assert_eq!(vrm0_with(elsewhere), Changes::NotStated);
    }

    #[test]
    fn a_plain_file_may_name_a_licence_too() {
        let text = "CC-BY-ND-4.0 (http://creativecommons.org/licenses/by-nd/4.0/)";
        let found = licence(&json!({"asset": {"extras": {"license": text, "author": "A. Nyone"}}}));
        assert_eq!(found.changes, Changes::Prohibited);
        assert_eq!(found.authors, ["A. Nyone"]);
        assert_eq!(licence(&json!({"asset": {"version": "2.0"}})), Licence::default());
        assert_eq!(Licence::default().to_json(), Value::Null);
    }
}
