//! The values of arguments, each from its text; what is refused is refused in one sentence that names the value.

use glam::Vec3;
use regex::Regex;
use std::path::PathBuf;
use superdeform::GroupSettings;

/// Settings of one bone group.
#[derive(Clone, Debug)]
pub struct Group {
    pub name: String,
    pub settings: GroupSettings,
}

/// A number from `low` to `high`, both included.
pub fn number(low: f64, high: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| number_in(text, low, high)
}

fn number_in(text: &str, low: f64, high: f64) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value >= low && value <= high => Ok(value),
        Ok(value) => Err(format!("{value} is out of range: give a number from {low} to {high}")),
        Err(_) => Err(format!("`{text}` is not a number: give one from {low} to {high}")),
    }
}

/// A whole number from `low` to `high`, both included.
pub fn count(low: usize, high: usize) -> impl Fn(&str) -> Result<usize, String> + Clone {
    move |text| match text.trim().parse::<usize>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("{text} is out of range: give a whole number from {low} to {high}")),
    }
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
        Some((path, share)) if !path.is_empty() => Ok((PathBuf::from(path), number_in(share, 0.0, 1.0)?)),
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
        let (place, high, low) = match key.trim() {
            "length" => (&mut settings.length_scale, 10.0, 0.01),
            "thickness" => (&mut settings.thickness_scale, 10.0, 0.01),
            "length_transfer" => (&mut settings.length_transfer, 1.0, 0.0),
            "thickness_transfer" => (&mut settings.thickness_transfer, 1.0, 0.0),
            other => {
                return Err(format!(
                    "`{other}` is no setting: use length, thickness, length_transfer or thickness_transfer"
                ));
            }
        };
        *place = Some(number_in(value, low, high).map_err(|why| format!("{}: {why}", key.trim()))?);
    }
    Ok(Group { name: name.trim().to_string(), settings })
}
