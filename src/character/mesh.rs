//! Meshes of a character: vertices, triangles, normals, tangents, morph targets, and what the mesh depicts.

use super::Weights;
use crate::error::{Error, ErrorKind, Result};
use glam::{Vec3, Vec4};

/// What a mesh depicts. Hosts give it, or guess it with [`MeshKind::guess`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MeshKind {
    /// Skin, or skin fused with clothes.
    #[default]
    Body,
    /// Clothes.
    Garment,
    /// Hair that belongs to the head.
    Hair,
    /// Eyes, brows, lashes, teeth, tongue: parts that follow the face.
    FacePart,
    /// Hats, glasses, bags, weapons: things that keep their shape.
    Accessory,
}

/// Words that name things which keep their shape; they come before hair and face, so that a hair band or eye glasses
/// are accessories.
const ACCESSORY_WORDS: &[&str] = &[
    "accessory",
    "accessories",
    "axe",
    "backpack",
    "bag",
    "band",
    "bow",
    "bracelet",
    "clip",
    "crown",
    "earring",
    "earrings",
    "gadget",
    "glasses",
    "eyeglasses",
    "goggles",
    "gun",
    "halo",
    "hairband",
    "hairclip",
    "hairpin",
    "hat",
    "headband",
    "headphone",
    "headphones",
    "headset",
    "helm",
    "helmet",
    "horn",
    "horns",
    "jewelry",
    "knife",
    "mask",
    "necklace",
    "pin",
    "prop",
    "props",
    "quiver",
    "ribbon",
    "ring",
    "rucksack",
    "shield",
    "staff",
    "sunglasses",
    "sword",
    "watch",
    "weapon",
];

/// Words that name skin, which is the body even beside a word for hair or face ("Body_Hair", "Face_Skin").
const BODY_WORDS: &[&str] = &["body", "skin", "torso"];

const FACE_WORDS: &[&str] = &[
    "brow",
    "brows",
    "eye",
    "eyeball",
    "eyeballs",
    "eyebrow",
    "eyebrows",
    "eyelash",
    "eyelashes",
    "eyelid",
    "eyelids",
    "eyeline",
    "eyeliner",
    "eyes",
    "iris",
    "irises",
    "lash",
    "lashes",
    "lips",
    "mouth",
    "pupil",
    "pupils",
    "sclera",
    "tear",
    "tears",
    "teeth",
    "tooth",
    "tongue",
];

const HAIR_WORDS: &[&str] = &[
    "ahoge",
    "bang",
    "bangs",
    "braid",
    "braids",
    "forelock",
    "fringe",
    "hair",
    "hairs",
    "hairback",
    "hairfront",
    "hairstyle",
    "pigtail",
    "pigtails",
    "ponytail",
    "ponytails",
    "sidelock",
    "twintail",
    "twintails",
    "wig",
];

const GARMENT_WORDS: &[&str] = &[
    "apron",
    "armor",
    "armour",
    "belt",
    "blouse",
    "boot",
    "boots",
    "bottoms",
    "bra",
    "cape",
    "cardigan",
    "cloak",
    "cloth",
    "clothes",
    "clothing",
    "coat",
    "costume",
    "dress",
    "garment",
    "glove",
    "gloves",
    "gown",
    "hood",
    "hoodie",
    "jacket",
    "jeans",
    "kimono",
    "leggings",
    "necktie",
    "outfit",
    "overalls",
    "pants",
    "panties",
    "robe",
    "scarf",
    "shirt",
    "shirts",
    "shoe",
    "shoes",
    "shorts",
    "skirt",
    "sleeve",
    "sleeves",
    "sneakers",
    "sock",
    "socks",
    "stocking",
    "stockings",
    "suit",
    "sweater",
    "tie",
    "tights",
    "top",
    "tops",
    "trousers",
    "tshirt",
    "underwear",
    "uniform",
    "vest",
];

impl MeshKind {
    /// True for hair and for things that are worn or carried: no part of a body's girth.
    pub fn is_carried(self) -> bool {
        matches!(self, Self::Hair | Self::Accessory)
    }

    /// Guesses what a mesh depicts from the name of its material, mesh or node; `None` where no word of it is known.
    ///
    /// A name is cut into words at anything that is no letter and before a capital (`HairBack_01` is hair, back), so
    /// that a chair is no hair and what is no hat. English words only. Words for accessories count before those for
    /// skin, face, hair and clothes, in this order.
    ///
    /// ```
    /// use superdeform::MeshKind;
    /// assert_eq!(MeshKind::guess("N00_000_Hair_00_HAIR"), Some(MeshKind::Hair));
    /// assert_eq!(MeshKind::guess("chair"), None);
    /// ```
    pub fn guess(name: &str) -> Option<MeshKind> {
        let words = words_of(name);
        let any_of = |known: &[&str]| words.iter().any(|word| known.contains(&word.as_str()));
        let order = [
            (ACCESSORY_WORDS, MeshKind::Accessory),
            (BODY_WORDS, MeshKind::Body),
            (FACE_WORDS, MeshKind::FacePart),
            (HAIR_WORDS, MeshKind::Hair),
            (GARMENT_WORDS, MeshKind::Garment),
        ];
        order.into_iter().find(|(known, _)| any_of(known)).map(|(_, kind)| kind)
    }
}

/// The words of a name, in small letters: `HairBack_01` is hair, back; `EYEIris` is eye, iris.
fn words_of(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = vec![String::new()];
    for (index, &letter) in letters.iter().enumerate() {
        let starts_word = letter.is_uppercase()
            && (index.checked_sub(1).is_some_and(|before| letters[before].is_lowercase())
                || letters.get(index + 1).is_some_and(|after| after.is_lowercase()));
        if !letter.is_alphabetic() || starts_word {
            words.push(String::new());
        }
        if letter.is_alphabetic() {
            let last = words.len() - 1;
            words[last].extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// A morph target (blend shape): what is added to each vertex at weight 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// The target's name; may be empty.
    pub name: String,
    /// Displacements, one a vertex, model units.
    pub positions: Vec<Vec3>,
    /// Changes of the normals: one a vertex, or empty.
    pub normals: Vec<Vec3>,
    /// Changes of the tangents' directions: one a vertex, or empty.
    pub tangents: Vec<Vec3>,
}

impl MorphTarget {
    /// Checks target number `target` against the number of vertices; the error is the vertex and a sentence.
    pub(crate) fn validate(
        &self,
        target: usize,
        vertex_count: usize,
    ) -> std::result::Result<(), (Option<usize>, String)> {
        for (what, deltas, may_be_empty) in [
            ("position", &self.positions, false),
            ("normal", &self.normals, true),
            ("tangent", &self.tangents, true),
        ] {
            if deltas.len() != vertex_count && !(may_be_empty && deltas.is_empty()) {
                return Err((
                    None,
                    format!(
                        "morph target {target} ({}) has {} {what} deltas for {vertex_count} vertices: give one a vertex",
                        self.name,
                        deltas.len()
                    ),
                ));
            }
            if let Some(vertex) = deltas.iter().position(|d| !d.is_finite()) {
                return Err((
                    Some(vertex),
                    format!(
                        "morph target {target} ({}) moves the {what} of vertex {vertex} by {}: deltas must be finite",
                        self.name, deltas[vertex]
                    ),
                ));
            }
        }
        Ok(())
    }
}

/// One mesh in rest pose, in model space.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The mesh's name, for messages.
    pub name: String,
    /// What it depicts, as the host says or guesses from names; `None` where nobody knows: a rigged mesh counts as body
    /// then, and the auto-rig looks at where the mesh lies.
    pub kind: Option<MeshKind>,
    /// Positions, model units.
    pub positions: Vec<Vec3>,
    /// Corners of each triangle, as indices into `positions`; the winding is never changed.
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals: one a vertex, or empty.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the handedness in `w`: one a vertex, or empty.
    pub tangents: Vec<Vec4>,
    /// Morph targets, any number.
    pub morph_targets: Vec<MorphTarget>,
    /// Skin weights: one row a vertex. A mesh that hangs rigidly from a joint has weight 1 to it throughout.
    /// No rows at all means that the mesh has no rig.
    pub weights: Weights,
}

impl Mesh {
    /// Checks the arrays of mesh number `index` against each other and against `joint_count`.
    ///
    /// # Errors
    /// `ErrorKind::BadInput` with the mesh, the element, the value and the remedy.
    pub fn validate(&self, index: usize, joint_count: usize) -> Result<()> {
        let place = if self.name.is_empty() {
            format!("mesh {index}")
        } else {
            format!("mesh {index} ({})", self.name)
        };
        let bad = |element: Option<usize>, message: String| {
            let error = Error::new(ErrorKind::BadInput, format!("{place}: {message}")).in_mesh(index);
            Err(match element {
                Some(element) => error.at(element),
                None => error,
            })
        };
        let count = self.positions.len();
        for (vertex, p) in self.positions.iter().enumerate() {
            if !p.is_finite() {
                return bad(
                    Some(vertex),
                    format!("vertex {vertex} is at {p}: positions must be finite numbers"),
                );
            }
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
                return bad(
                    Some(triangle),
                    format!(
                        "triangle {triangle} uses vertex {vertex}, but the mesh has {count} vertices: give indices from 0 to that less 1"
                    ),
                );
            }
        }
        let lengths = [("normals", self.normals.len()), ("tangents", self.tangents.len())];
        for (what, length) in lengths {
            if length != 0 && length != count {
                return bad(
                    None,
                    format!("{length} {what} for {count} vertices: give one a vertex, or none"),
                );
            }
        }
        if let Some(vertex) = self.normals.iter().position(|n| !n.is_finite()) {
            return bad(
                Some(vertex),
                format!("the normal of vertex {vertex} is {}: normals must be finite", self.normals[vertex]),
            );
        }
        if let Some(vertex) = self.tangents.iter().position(|t| !t.is_finite()) {
            return bad(
                Some(vertex),
                format!(
                    "the tangent of vertex {vertex} is {}: tangents must be finite",
                    self.tangents[vertex]
                ),
            );
        }
        for (target, morph) in self.morph_targets.iter().enumerate() {
            morph.validate(target, count).or_else(|(element, message)| bad(element, message))?;
        }
        self.weights.validate(count, joint_count).or_else(|(element, message)| bad(element, message))
    }
}

#[cfg(test)]
mod tests {
    use super::MeshKind::{self, *};

    #[test]
    fn kinds_are_guessed_from_whole_words() {
        for (name, kind) in [
            ("Hair001", Some(Hair)),
            ("HairBack_01", Some(Hair)),
            ("Long_Ponytail", Some(Hair)),
            ("bangs.L", Some(Hair)),
            ("chair", None),
            ("what", None),
            ("Hat", Some(Accessory)),
            ("hair_ribbon", Some(Accessory)),
            ("EyeGlasses", Some(Accessory)),
            ("sunglasses", Some(Accessory)),
            ("Knight_Helmet", Some(Accessory)),
            ("eyelash", Some(FacePart)),
            ("N00_000_00_EyeIris_00_EYE (Instance)", Some(FacePart)),
            ("FaceMouth_00_FACE", Some(FacePart)),
            ("teeth", Some(FacePart)),
            ("Body_Hair", Some(Body)),
            ("N00_000_00_Face_00_SKIN", Some(Body)),
            ("Skirt", Some(Garment)),
            ("Knight_Armor", Some(Garment)),
            ("T-Shirt", Some(Garment)),
            ("N00_004_01_Shoes_01_CLOTH", Some(Garment)),
            ("Material.001", None),
            ("", None),
        ] {
            assert_eq!(MeshKind::guess(name), kind, "{name}");
        }
    }
}
