//! Options and styles as JSON names them: by the names of the library's table.

use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use superdeform::options::table::Default as Unset;
use superdeform::options::{Scope, TABLE, Values};
use superdeform::{BodyShape, Error, ErrorKind, GroupSettings, Options, Result, Style};
use superdeform_host::conversion::Reference;

fn refused(message: String) -> Error {
    Error::new(ErrorKind::BadOption, message)
}

macro_rules! places {
    ($($_block:ident { $(
        $(#[doc = $_text:literal])+
        $name:ident: $_low:literal..=$_high:literal = $_default:expr, $_modes:ident, $_heading:ident;
    )+ })+) => {
        /// The place of an option that is a number.
        fn place<'a>(options: &'a mut Options, name: &str) -> Option<&'a mut f64> {
            Some(match name {
                $($(stringify!($name) => &mut options.$name,)+)+
                "face_squash" => options.face_squash.get_or_insert_default(),
                _ => return None,
            })
        }
    };
}
superdeform::number_options!(places);

/// Options that are words.
const WORDS: [&str; 5] = ["mode", "stage", "face_curve", "height", "repair"];

/// The library's options as `asked` has them: `{"amount": 0.5, "repair": "off", "groups": {"hand": {"length_scale": 0.6}}}`.
///
/// # Errors
/// One sentence: a name that is none, a word or a number that it cannot be. Ranges, and which groups there are, are checked
/// where options are set.
pub fn options(asked: &Value) -> Result<Options> {
    let mut options = Options::default();
    let none = Map::new();
    for (name, value) in asked.as_object().unwrap_or(&none) {
        let text = value.as_str().unwrap_or_default();
        match name.as_str() {
            "mode" => options.mode = text.parse()?,
            "stage" => options.stage = text.parse()?,
            "face_curve" => options.face_curve = text.parse()?,
            "repair" => options.repair = text.parse()?,
            "groups" => options.groups = groups(value)?,
            "height" => {
                options.height = value.as_f64().map_or(text.to_string(), |x| x.to_string()).parse()?
            }
            _ => {
                let known = || TABLE.iter().map(|row| row.name).filter(|row| is_known(row));
                let place = place(&mut options, name).ok_or_else(|| {
                    let names: Vec<_> = known().collect();
                    refused(format!("there is no option {name}: name one of {}", names.join(", ")))
                })?;
                *place =
                    value.as_f64().ok_or_else(|| refused(format!("{name} is {value}: give a number")))?;
            }
        }
    }
    Ok(options)
}

fn groups(asked: &Value) -> Result<BTreeMap<String, GroupSettings>> {
    let expected = || refused(format!("groups is {asked}: give groups by name, and numbers in each"));
    let settings = |(group, asked): (&String, &Value)| {
        let mut settings = GroupSettings::default();
        for (name, value) in asked.as_object().ok_or_else(expected)? {
            let place = match name.as_str() {
                "length_scale" => &mut settings.length_scale,
                "thickness_scale" => &mut settings.thickness_scale,
                "length_transfer" => &mut settings.length_transfer,
                "thickness_transfer" => &mut settings.thickness_transfer,
                _ => {
                    let names = settings.numbers().map(|(name, _)| name).join(", ");
                    return Err(refused(format!("group {group} has no {name}: name one of {names}")));
                }
            };
            let number = || refused(format!("group {group}: {name} is {value}: give a number"));
            *place = Some(value.as_f64().ok_or_else(number)?);
        }
        Ok((group.clone(), settings))
    };
    asked.as_object().ok_or_else(expected)?.iter().map(settings).collect()
}

fn is_known(name: &str) -> bool {
    WORDS.contains(&name) || place(&mut Options::default(), name).is_some()
}

/// The style that `asked` names: `{"heads": 2.5}`, `{"built_in": "sd2.5"}`, `{"json": "..."}`, or, `{"reference": true}`, that of
/// the reference.
///
/// # Errors
/// One sentence.
pub fn style(asked: &Value, reference: Option<&Reference>) -> Result<Style> {
    if let Some(heads) = asked["heads"].as_f64() {
        return Style::heads(heads);
    }
    let shape = if let Some(text) = asked["json"].as_str() {
        BodyShape::from_json(text)?
    } else if asked["reference"] == true {
        let none = || refused("there is no reference: open one first".to_string());
        reference.ok_or_else(none)?.shape().clone()
    } else {
        let name = asked["built_in"].as_str().unwrap_or("sd2.5");
        let none = || {
            let names = superdeform::internals::shape::style::BUILT_IN.join(", ");
            refused(format!("there is no style {name}: name one of {names}"))
        };
        BodyShape::built_in(name).ok_or_else(none)?
    };
    Ok(Style::Shape(Box::new(shape)))
}

/// What can be set, as the library's table has it.
pub fn table() -> Value {
    let rows = TABLE.iter().filter(|row| is_known(row.name) || row.scope == Scope::Style);
    let described = rows.map(|row| {
        let mut entry = json!({"name": row.name, "text": row.text});
        match row.values {
            Values::Number { low, high } => (entry["low"], entry["high"]) = (json!(low), json!(high)),
            Values::Choice(names) => entry["choices"] = json!(names),
            _ => {}
        }
        entry["default"] = match row.default {
            Unset::Number(number) | Unset::ByMode { product: number, .. } => json!(number),
            Unset::Switch(on) => json!(on),
            Unset::Choice(name) => json!(name),
            Unset::Found => Value::Null,
        };
        entry
    });
    described.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use superdeform::options::Repair;

    const NO_GROUPS: [fn() -> Value; 4] = [
        || json!("hand"),
        || json!({"hand": 2}),
        || json!({"hand": {"length_scale": "long"}}),
        || json!({"hand": {"beauty": 1}}),
    ];

    #[test]
    fn every_plain_number_of_the_table_can_be_set_and_others_are_refused() {
        for (name, _) in Options::default().numbers() {
            // Rays and threads are no matter of a slider; a page's WebAssembly has one thread.
            if !["rays", "thread_count"].contains(&name) {
                let set = options(&json!({name: 0.25})).unwrap();
                let there = set.numbers().into_iter().find(|(other, _)| *other == name).unwrap();
                assert_eq!(there.1, Some(0.25), "{name}");
            }
        }
        assert_eq!(options(&json!({"repair": "kept"})).unwrap().repair, Repair::Kept);
        let wrong = [json!({"amount": "much"}), json!({"beauty": 1}), json!({"repair": "perhaps"})];
        for wrong in wrong.into_iter().chain(NO_GROUPS.map(|groups| json!({"groups": groups()}))) {
            assert!(options(&wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_number_of_a_group_can_be_set() {
        for (name, _) in GroupSettings::default().numbers() {
            let set = options(&json!({"groups": {"hand": {name: 0.25}}})).unwrap();
            let there: Vec<_> =
                set.groups["hand"].numbers().into_iter().filter(|(_, set)| set.is_some()).collect();
            assert_eq!(there, [(name, Some(0.25))]);
        }
    }

    #[test]
    fn a_style_is_a_number_a_name_or_a_model() {
        assert_eq!(style(&json!({"heads": 2}), None).unwrap(), Style::Heads(2.0));
        assert_eq!(style(&json!({}), None).unwrap(), style(&json!({"built_in": "sd2.5"}), None).unwrap());
        for wrong in [json!({"heads": 9}), json!({"built_in": "sd9"}), json!({"reference": true})] {
            assert!(style(&wrong, None).is_err(), "{wrong}");
        }
    }
}
