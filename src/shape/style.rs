//! Styles: what a character should become, with or without a reference model.
//!
//! A measured body is needed for nothing but its numbers, so it can be saved as a small JSON text and used without
//! its model, blended with another, or stretched to a number of heads.

use super::body_shape::{BodyShape, BoneShape, FaceStyle, VERSION, either};
use super::measured::Measured;
use super::product::anatomy::Proportions;
use super::product::profile::Profile;
use super::product::profile::wanted::canonical;
use crate::character::Character;
use crate::error::{Error, ErrorKind, Result};
use crate::options::{HEADS, Options};

/// What a character should become.
#[derive(Clone, Debug, PartialEq)]
pub enum Style {
    /// Like a body that was measured.
    Shape(Box<BodyShape>),
    /// So many heads tall, from 1.8 to 6; everything else after the target.
    Heads(f64),
}

impl Style {
    /// Like `character`, which is measured.
    ///
    /// # Errors
    /// As [`Measured::of`].
    pub fn of(character: &Character, options: &Options) -> Result<Self> {
        Ok(Self::Shape(Box::new(Measured::of(character, options)?.shape)))
    }

    /// A style for `heads` heads.
    ///
    /// # Errors
    /// `ErrorKind::BadOption` outside of 1.8 to 6.
    pub fn heads(heads: f64) -> Result<Self> {
        if !(HEADS.0..=HEADS.1).contains(&heads) {
            let message = format!("{heads} heads: give a number from {} to {}", HEADS.0, HEADS.1);
            return Err(Error::new(ErrorKind::BadOption, message).about("heads"));
        }
        Ok(Self::Heads(heads))
    }

    /// The body that it is like; `None` for a number of heads.
    pub(crate) fn shape(&self) -> Option<&BodyShape> {
        match self {
            Self::Shape(shape) => Some(shape),
            Self::Heads(_) => None,
        }
    }
}

/// The names of the built-in bodies.
pub const BUILT_IN: [&str; 4] = ["sd2", "sd2.5", "sd3", "sd4"];

impl BodyShape {
    /// One of the built-in bodies: `sd2`, `sd2.5`, `sd3`, `sd4`.
    ///
    /// They were measured and are stretched to 2, 2.5, 3 and 4 heads: up to 2.5 the KayKit Rogue (Kay Lousberg, CC0; 2.3
    /// heads), 4 a toddler of MakeHuman (MakeHuman team, CC0; 4.6 heads), 3 halfway between both. The counts are those
    /// that drawing guides use: 2 to 3 heads for a chibi, and at 3 a head each for torso, legs and arms ("Chibi Styles
    /// Part 1", drawcentral.com, 2013; `sd3` has 0.94 and 0.89 for torso and legs).
    pub fn built_in(name: &str) -> Option<Self> {
        let figurine = || Self::from_json(include_str!("styles/figurine.json")).ok();
        let toddler = || Self::from_json(include_str!("styles/toddler.json")).ok();
        let (shape, heads) = match name {
            "sd2" => (figurine()?, 2.0),
            "sd2.5" => (figurine()?, 2.5),
            "sd3" => (figurine()?.blended(&toddler()?, 0.5), 3.0),
            "sd4" => (toddler()?, 4.0),
            _ => return None,
        };
        Some(Self { version: VERSION, name: name.to_string(), ..shape.with_heads(heads) })
    }

    /// The style as JSON text, indented.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Reads a style that [`BodyShape::to_json`] wrote.
    ///
    /// # Errors
    /// `ErrorKind::BadStyle` where the text is no style, is of a newer version, or holds a number out of range.
    pub fn from_json(text: &str) -> Result<Self> {
        let bad = |message: String| Error::new(ErrorKind::BadStyle, message);
        let shape: Self = serde_json::from_str(text).map_err(|error| {
            bad(format!("this is no saved style ({error}): save one from a measured model"))
        })?;
        if shape.version == 0 || shape.version > VERSION {
            return Err(bad(format!(
                "the style has version {}, and this library reads versions 1 to {VERSION}: save it again, or update",
                shape.version
            )));
        }
        shape.validate()?;
        Ok(shape)
    }

    /// Checks every number against its range.
    ///
    /// # Errors
    /// `ErrorKind::BadStyle` names the number and its value.
    pub fn validate(&self) -> Result<()> {
        let bad = |message: String| Error::new(ErrorKind::BadStyle, message);
        if !(self.head_length.is_finite() && self.head_length > 0.0) {
            return Err(bad(format!("the style's head_length is {}: it must be above 0", self.head_length)));
        }
        for (name, bone) in &self.bones {
            let radius = bone.radius.unwrap_or(1.0);
            if !(bone.length.is_finite() && bone.length >= 0.0 && radius.is_finite() && radius > 0.0) {
                return Err(bad(format!(
                    "the style's bone {name} has length {} and radius {radius}: lengths must be 0 or more, radii above 0",
                    bone.length
                )));
            }
        }
        if let Some(landmarks) = &self.landmarks {
            for (name, height) in [
                ("crown", landmarks.crown),
                ("chin", landmarks.chin),
                ("shoulder_line", landmarks.shoulder_line),
                ("crotch", landmarks.crotch),
                ("sole", landmarks.sole),
            ] {
                if !height.is_finite() {
                    return Err(bad(format!(
                        "the style's {name} is at {height}: give each landmark's height along up, or no crown"
                    )));
                }
            }
        }
        if let Some(FaceStyle { eye_height, eye_size }) = self.face
            && !((0.0..1.0).contains(&eye_height) && eye_size > 0.0 && eye_size < 0.5)
        {
            return Err(bad(format!(
                "the style's eyes are {eye_size} large at {eye_height}: give both in head lengths, or no face"
            )));
        }
        if let Some(proportions) = &self.proportions {
            proportions.validate()?;
        }
        if let Some((name, value)) = self.profile.as_ref().and_then(Profile::out_of_range) {
            return Err(bad(format!(
                "the style's profile has {name} {value}: extents must be from 0.001 to 20 head lengths, places from -20 to 20"
            )));
        }
        Ok(())
    }

    /// How many heads tall, where the proportions are known.
    pub fn heads(&self) -> Option<f64> {
        self.proportions.as_ref().map(Proportions::heads)
    }

    /// This style (0) to `other` (1), measured in heads; what only one of them has is taken from that one, but for a profile:
    /// in its place stands that of a body of so many heads.
    pub fn blended(&self, other: &Self, amount: f64) -> Self {
        let mix = |a: f64, b: f64| a + amount * (b - a);
        let unit = self.head_length / other.head_length;
        let bones = self
            .bones
            .keys()
            .chain(other.bones.keys())
            .map(|name| {
                let scaled = other.bones.get(name).map(|bone| BoneShape {
                    length: bone.length * unit,
                    radius: bone.radius.map(|radius| radius * unit),
                });
                let bone = either(&self.bones.get(name).copied(), &scaled, |a, b| BoneShape {
                    length: mix(a.length, b.length),
                    radius: either(&a.radius, &b.radius, |&a, &b| mix(a, b)),
                });
                (name.clone(), bone.unwrap_or_default())
            })
            .collect();
        let proportions = either(&self.proportions, &other.proportions, |a, b| a.blended(b, amount));
        let face = either(&self.face, &other.face, |a, b| a.blended(*b, amount));
        // Two that lack a profile stay without: a mode or a target may yet choose one.
        let profile = (self.profile.is_some() || other.profile.is_some())
            .then(|| self.profile_or_canonical().zip(other.profile_or_canonical()))
            .flatten()
            .map(|(a, b)| a.blended(&b, amount))
            .or_else(|| self.profile.clone().or(other.profile.clone()));
        Self { version: VERSION, bones, proportions, landmarks: None, profile, face, ..self.clone() }
    }

    /// The profile, or that of a body of as many heads, where these are known.
    fn profile_or_canonical(&self) -> Option<Profile> {
        self.profile.clone().or_else(|| self.heads().map(canonical))
    }

    /// The same body with everything below the head made longer or shorter, so that it is `heads` heads tall.
    pub fn with_heads(&self, heads: f64) -> Self {
        let mut shape = self.clone();
        let Some(proportions) = &mut shape.proportions else { return shape };
        let stretch = (heads - 1.0) / (proportions.heads() - 1.0);
        for length in [
            &mut proportions.neck,
            &mut proportions.torso,
            &mut proportions.arm,
            &mut proportions.leg,
            &mut proportions.ankle_height,
        ] {
            *length *= stretch;
        }
        shape.landmarks = None;
        for (name, bone) in &mut shape.bones {
            if name != crate::character::bones::HEAD_TOP {
                bone.length *= stretch;
            }
        }
        if let Some(profile) = &mut shape.profile {
            profile.arm_length *= stretch;
        }
        shape
    }
}

impl Proportions {
    /// How many heads tall.
    pub fn heads(&self) -> f64 {
        1.0 + (self.neck + self.torso + self.leg) / self.head_length
    }

    /// Half the head's width, in head lengths.
    pub(crate) fn head_width(&self) -> f64 {
        self.head_half_width / self.head_length
    }

    /// Half its depth, in head lengths, where that is known.
    pub(crate) fn head_depth(&self) -> Option<f64> {
        self.head_half_depth.map(|half| half / self.head_length)
    }

    fn validate(&self) -> Result<()> {
        let positive = [
            ("head_length", Some(self.head_length)),
            ("head_half_width", Some(self.head_half_width)),
            ("head_half_depth", self.head_half_depth),
            ("torso", Some(self.torso)),
            ("arm", Some(self.arm)),
            ("leg", Some(self.leg)),
            ("hand", self.hand),
            ("foot", self.foot),
            ("torso_half_width", self.torso_half_width),
            ("upper_arm_radius", self.upper_arm_radius),
            ("lower_arm_radius", self.lower_arm_radius),
            ("upper_leg_radius", self.upper_leg_radius),
            ("lower_leg_radius", self.lower_leg_radius),
        ];
        for (name, value) in positive {
            if let Some(value) = value
                && !(value.is_finite() && value > 0.0)
            {
                let message = format!("the style's {name} is {value}: it must be above 0");
                return Err(Error::new(ErrorKind::BadStyle, message));
            }
        }
        for (name, value) in [("neck", self.neck), ("ankle_height", self.ankle_height)] {
            if !(value.is_finite() && value >= 0.0) {
                let message = format!("the style's {name} is {value}: it must be 0 or more");
                return Err(Error::new(ErrorKind::BadStyle, message));
            }
        }
        Ok(())
    }

    /// These proportions (0) to `other` (1), measured in heads.
    pub fn blended(&self, other: &Self, amount: f64) -> Self {
        let unit = self.head_length / other.head_length;
        let place = |a: f64, b: f64| a + amount * (b - a);
        let mix = |a: f64, b: f64| place(a, b * unit);
        let mix_some =
            |a: Option<f64>, b: Option<f64>| either(&a, &b.map(|b| b * unit), |&a, &b| place(a, b));
        Self {
            head_length: self.head_length,
            head_half_width: mix(self.head_half_width, other.head_half_width),
            head_half_depth: mix_some(self.head_half_depth, other.head_half_depth),
            neck: mix(self.neck, other.neck),
            torso: mix(self.torso, other.torso),
            arm: mix(self.arm, other.arm),
            leg: mix(self.leg, other.leg),
            ankle_height: mix(self.ankle_height, other.ankle_height),
            hand: mix_some(self.hand, other.hand),
            foot: mix_some(self.foot, other.foot),
            torso_half_width: mix_some(self.torso_half_width, other.torso_half_width),
            upper_arm_radius: mix_some(self.upper_arm_radius, other.upper_arm_radius),
            lower_arm_radius: mix_some(self.lower_arm_radius, other.lower_arm_radius),
            upper_leg_radius: mix_some(self.upper_leg_radius, other.upper_leg_radius),
            lower_leg_radius: mix_some(self.lower_leg_radius, other.lower_leg_radius),
        }
    }
}
