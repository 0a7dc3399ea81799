//! The values of arguments, each from its text; what is refused is refused in one sentence that names the value.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use glam::{DVec3, Vec3};
use regex_lite::Regex;
use std::path::PathBuf;
use std::str::FromStr;
use superdeform::options::{OptionInfo, TABLE, Values, find};
use superdeform::{Error, EyeHint, FaceHints, GroupSettings, Height, Repair};

/// Settings of one bone group.
#[derive(Clone, Debug)]
pub struct Group {
    pub name: String,
    pub settings: GroupSettings,
}

/// The option of the library that is called `name`.
fn info(name: &str) -> &'static OptionInfo {
    find(name).unwrap_or_else(|| {
        let names: Vec<&str> = TABLE.iter().map(|info| info.name).collect();
        panic!("the library has no option {name}, only {}", names.join(", "))
    })
}

/// The help of the option `name`: what it does, its range, its default.
pub fn help(name: &str) -> String {
    let info = info(name);
    let mut letters = info.text.chars();
    let mut help: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    // The choices are listed by clap.
    let range = match info.values {
        Values::Number { .. } | Values::Count { .. } => info.values.to_string(),
        Values::Switch | Values::Choice(_) | Values::Other => String::new(),
    };
    let default = info.default.to_string();
    let notes = match (range.is_empty(), default.is_empty()) {
        (true, true) => return help,
        (true, false) => format!(" [default: {default}]"),
        (false, true) => format!(" [{range}]"),
        (false, false) => format!(" [{range}; default: {default}]"),
    };
    help.push_str(&notes);
    help
}

/// A number in the range of the option `name`.
pub fn number(name: &'static str) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| number_of(name, text)
}

fn number_of(name: &str, text: &str) -> Result<f64, String> {
    let range = info(name).values;
    let value: f64 =
        text.trim().parse().map_err(|_| format!("`{text}` is not a number: give one from {range}"))?;
    match range {
        Values::Number { low, high } if !(low..=high).contains(&value) => {
            Err(format!("{value} is out of range: give a number from {range}"))
        }
        _ => Ok(value),
    }
}

/// `style`, `keep`, or a number of units.
pub fn height(text: &str) -> Result<Height, String> {
    text.trim().parse().map_err(|error: Error| error.message)
}

/// 1 or 0.
pub fn repair(text: &str) -> Result<Repair, String> {
    match text.trim() {
        "0" => Ok(Repair::Off),
        "1" => Ok(Repair::On),
        _ => Err(format!(
            "`{text}` is neither 0 nor 1: give 1 to push clothes out of the body, 0 to leave them"
        )),
    }
}

/// A number from 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err(format!("`{text}` is no share: give a number from 0 to 1")),
    }
}

/// A whole number in the range of the option `name`.
pub fn count(name: &'static str) -> impl Fn(&str) -> Result<usize, String> + Clone {
    move |text| {
        let range = info(name).values;
        let refused = || format!("{text} is out of range: give a whole number from {range}");
        let value: u32 = text.trim().parse().map_err(|_| refused())?;
        match range {
            Values::Count { low, high } if !(low..=high).contains(&value) => Err(refused()),
            _ => usize::try_from(value).map_err(|_| refused()),
        }
    }
}

/// One of the words of the option `name`.
pub fn choice<T>(name: &str) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err = superdeform::Error> + Clone + Send + Sync + 'static,
{
    let words: &'static [&'static str] = match info(name).values {
        Values::Choice(words) => words,
        _ => &[],
    };
    PossibleValuesParser::new(words).try_map(|word| word.parse::<T>())
}

/// An axis such as `+Y`, `-z` or `x`.
pub fn axis(text: &str) -> Result<Vec3, String> {
    let (sign, letter) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    let axis = match letter {
        "x" | "X" => Vec3::X,
        "y" | "Y" => Vec3::Y,
        "z" | "Z" => Vec3::Z,
        _ => return Err("give one of +X, -X, +Y, -Y, +Z, -Z".to_string()),
    };
    Ok(sign * axis)
}

/// `X,Y,Z` of one eye, or `X,Y,Z,X,Y,Z` of both.
pub fn eyes(text: &str) -> Result<FaceHints, String> {
    let refused = || format!("`{text}` is no eye: give X,Y,Z of one eye, or X,Y,Z,X,Y,Z of both");
    let numbers = text.split(',').map(|number| number.trim().parse::<f64>().map_err(|_| refused()));
    let numbers = numbers.collect::<Result<Vec<f64>, String>>()?;
    let eye = |numbers: &[f64; 3]| EyeHint { middle: DVec3::from_array(*numbers), ..EyeHint::default() };
    match numbers.as_chunks::<3>() {
        ([one], []) => Ok(FaceHints { eye: Some(eye(one)), other_eye: None }),
        ([one, other], []) => Ok(FaceHints { eye: Some(eye(one)), other_eye: Some(eye(other)) }),
        _ => Err(refused()),
    }
}

/// A regular expression; the sentence is the last line of a longer drawing.
pub fn pattern(text: &str) -> Result<Regex, String> {
    Regex::new(text).map_err(|error| {
        let text = error.to_string();
        let line = text.lines().last().unwrap_or_default();
        line.trim_start_matches("error: ").to_string()
    })
}

/// `STYLE.json:0.5`; the last colon counts, because a path may hold others.
pub fn blend(text: &str) -> Result<(PathBuf, f64), String> {
    match text.rsplit_once(':') {
        Some((path, share)) if !path.is_empty() => Ok((PathBuf::from(path), number_of("blend", share)?)),
        _ => Err("give a saved style and its share, as in STYLE.json:0.5".to_string()),
    }
}

/// `upper_leg:length=0.4,thickness=0.8`.
pub fn group(text: &str) -> Result<Group, String> {
    let Some((name, settings_text)) = text.split_once(':') else {
        return Err("give a group and its settings, as in upper_leg:length=0.4,thickness=0.8".to_string());
    };
    let mut settings = GroupSettings::default();
    for setting in settings_text.split(',') {
        let Some((key, value)) = setting.split_once('=') else {
            return Err(format!("`{setting}` has no value: write it as length=0.4"));
        };
        let key = key.trim();
        let (place, name) = match key {
            "length" => (&mut settings.length_scale, "length_scale"),
            "thickness" => (&mut settings.thickness_scale, "thickness_scale"),
            "length_transfer" => (&mut settings.length_transfer, key),
            "thickness_transfer" => (&mut settings.thickness_transfer, key),
            other => {
                return Err(format!(
                    "`{other}` is no setting: use length, thickness, length_transfer or thickness_transfer"
                ));
            }
        };
        *place = Some(number_of(name, value).map_err(|why| format!("{key}: {why}"))?);
    }
    Ok(Group { name: name.trim().to_string(), settings })
}
