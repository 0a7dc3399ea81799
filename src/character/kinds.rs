//! What a mesh depicts: as its names say, where the place of the mesh bears them out.

use super::{Character, Mesh, Role};
use crate::geometry::range;
use glam::Vec3;
use std::collections::BTreeMap;
use std::fmt;

/// What a mesh depicts. Hosts give it, or have it guessed from names: see
/// [`kinds_from_names`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MeshKind {
    /// Skin, or skin fused with clothes.
    #[default]
    Body,
    /// Clothes.
    Garment,
    /// Hair that belongs to the head.
    Hair,
    /// Brows, lashes, teeth, tongue: parts that follow the face.
    FacePart,
    /// Hats, glasses, bags, weapons: things that keep their shape.
    Accessory,
    /// Eyeballs, irises, pupils: parts of the face that keep their shape.
    Eye,
}

/// Words that name things which keep their shape; they come before hair and face, so that a hair band or eye glasses
/// are accessories.
const ACCESSORY_WORDS: &str = "accessory accessories axe backpack bag band bow bracelet clip crown earring earrings gadget \
    glasses eyeglasses goggles gun halo hairband hairclip hairpin hat headband headphone headphones \
    headset helm helmet horn horns jewelry knife mask necklace pin prop props quiver ribbon ring \
    rucksack shield staff sunglasses sword watch weapon";

/// Words that name skin, which is the body even beside a word for hair or face ("Body_Hair", "Face_Skin").
const BODY_WORDS: &str = "body skin torso";

const FACE_WORDS: &str = "brow brows eyebrow eyebrows eyelash eyelashes eyelid eyelids eyeline eyeliner eyeshadow lash \
    lashes lips mouth tear tears teeth tooth tongue";

const EYE_WORDS: &str = "cornea corneas eye eyeball eyeballs eyes iris irises pupil pupils sclera scleras";

/// Beside a word for the eye, these name what is around it.
const AROUND_EYE_WORDS: &str = "lid lids line liner makeup shadow socket";

/// Beards are hair, so that no chin is seen at their tip.
const HAIR_WORDS: &str = "ahoge bang bangs beard beards braid braids forelock fringe goatee hair hairs hairback hairfront \
    hairstyle moustache moustaches mustache pigtail pigtails ponytail ponytails sideburns sidelock twintail twintails \
    whiskers wig";

const GARMENT_WORDS: &str = "apron armor armour belt blouse boot boots bottoms bra cape cardigan cloak cloth clothes clothing \
    coat costume dress garment glove gloves gown hood hoodie jacket jeans kimono leggings necktie \
    outfit overalls pants panties robe scarf shirt shirts shoe shoes shorts skirt sleeve sleeves \
    sneakers sock socks stocking stockings suit sweater tie tights top tops trousers tshirt underwear \
    uniform vest";

/// A mesh called hair is hair where the head moves at least this share of it: hair to the waist may hang from the spine
/// below the neck, fur on boots does not. Seen: 0.61 for MakeHuman's hair to the waist, 0.98 and more for all other
/// hair.
const HAIR_OF_HEAD: f64 = 0.5;

/// A mesh called by a word of the face is part of it where the head moves at least this share of it: one black material
/// may serve for teeth and shoes. Seen: 1 for teeth.
const FACE_OF_HEAD: f64 = 0.9;

/// A mesh of eyes may hold more than these, such as black shoes: what of it the head moves are the eyes. Less than this is
/// none. Seen: 0.69 where eyes and shoes are one mesh.
const EYE_OF_HEAD: f64 = 0.05;

/// The same of one vertex, and the share by which limbs move no hair: the greater one decides. A majority.
const MOST_OF_A_VERTEX: f64 = 0.5;

/// Without a head joint: what is part of a face or hair reaches above this height of the figure, and the face nowhere
/// below it. A figure of 1.7 heads, smaller than the smallest style, has its chin there. 1 - 1 / 1.7.
pub(crate) const LOWEST_CHIN: f64 = 0.41;

impl MeshKind {
    /// True for hair and for things that are worn or carried: no part of a body's girth.
    pub fn is_carried(self) -> bool {
        matches!(self, Self::Hair | Self::Accessory)
    }

    /// True for all that follows the face.
    pub fn is_of_face(self) -> bool {
        matches!(self, Self::FacePart | Self::Eye)
    }

    /// What stages see that make no difference between the eyes and the rest of a face.
    pub(crate) fn without_eyes(self) -> Self {
        if self == Self::Eye { Self::FacePart } else { self }
    }

    /// Guesses what a mesh depicts from one name, of its material, mesh or node; `None` where no word of it is known.
    ///
    /// A name is cut into words at anything that is no letter and before a capital (`HairBack_01` is hair, back), so
    /// that a chair is no hair and what is no hat. English words only. Words for accessories count before those for
    /// skin, face, eyes, hair and clothes, in this order.
    ///
    /// ```
    /// use superdeform::MeshKind;
    /// assert_eq!(MeshKind::guess("N00_000_Hair_00_HAIR"), Some(MeshKind::Hair));
    /// assert_eq!(MeshKind::guess("chair"), None);
    /// ```
    pub fn guess(name: &str) -> Option<MeshKind> {
        let words = words_of(name);
        let any_of =
            |known: &str| known.split_whitespace().any(|known| words.iter().any(|word| word == known));
        let order = [
            (ACCESSORY_WORDS, MeshKind::Accessory),
            (BODY_WORDS, MeshKind::Body),
            (FACE_WORDS, MeshKind::FacePart),
            (EYE_WORDS, MeshKind::Eye),
            (HAIR_WORDS, MeshKind::Hair),
            (GARMENT_WORDS, MeshKind::Garment),
        ];
        let kind = order.into_iter().find(|(known, _)| any_of(known)).map(|(_, kind)| kind)?;
        Some(if any_of(AROUND_EYE_WORDS) { kind.without_eyes() } else { kind })
    }

    /// What one vertex of a mesh of this kind is, of whose weight `head` is the head's share and `limbs` that of arms
    /// and legs: a mesh may hold more than its name says. What the head does not move is no part of a face, and what a
    /// limb moves is no hair.
    pub(crate) fn of_vertex(self, head: f64, limbs: f64) -> MeshKind {
        match self {
            Self::FacePart | Self::Eye if head <= MOST_OF_A_VERTEX => Self::Body,
            Self::Hair if limbs > MOST_OF_A_VERTEX => Self::Body,
            kind => kind,
        }
    }
}

impl fmt::Display for MeshKind {
    /// The kind in words, such as `face part`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Body => "body",
            Self::Garment => "garment",
            Self::Hair => "hair",
            Self::FacePart => "face part",
            Self::Accessory => "accessory",
            Self::Eye => "eye",
        })
    }
}

/// The names that a file has for one mesh; empty where there is none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MeshNames {
    /// The node (object, renderer) that shows it.
    pub node: String,
    /// The mesh itself.
    pub mesh: String,
    /// Its material.
    pub material: String,
}

impl MeshNames {
    /// The names in a path such as `node/mesh/material`, `node/material` or `node`.
    pub fn of_path(path: &str) -> Self {
        let mut names = path.rsplitn(3, '/').map(String::from);
        let last = names.next().unwrap_or_default();
        match (names.next(), names.next()) {
            (Some(mesh), Some(node)) => Self { node, mesh, material: last },
            (Some(node), None) => Self { node, mesh: String::new(), material: last },
            _ => Self { node: last, ..Self::default() },
        }
    }

    fn all(&self) -> [&str; 3] {
        [&self.node, &self.mesh, &self.material]
    }
}

/// What each mesh of `character` depicts, as far as its names tell; `None` where they do not.
///
/// - `names`: one for each mesh, in order.
///
/// Of a mesh's names the one that the fewest meshes share says most: a material called body that teeth and eyes share
/// with the skin says nothing about the teeth, a node called body nothing about the one of its materials that is called
/// backpack. Among equals the node's name comes first, then the mesh's, then the material's. A name counts only where
/// the mesh lies where it says: the head joint, and what hangs from it, moves most of hair and nearly all of what is
/// part of a face; without a head joint both lie high enough for a head.
pub fn kinds_from_names(character: &Character, names: &[MeshNames]) -> Vec<Option<MeshKind>> {
    let mut bearers = [const { BTreeMap::<&str, usize>::new() }; 3];
    for names in names {
        for (bearers, name) in bearers.iter_mut().zip(names.all()) {
            *bearers.entry(name).or_default() += 1;
        }
    }
    let place = Place::of(character);
    let kind_of = |(mesh, names): (&Mesh, &MeshNames)| {
        let mut told: Vec<(usize, MeshKind)> = names
            .all()
            .into_iter()
            .zip(&bearers)
            .filter_map(|(name, bearers)| Some((bearers[name], MeshKind::guess(name)?)))
            .collect();
        // Stable: equals stay in the order of node, mesh, material.
        told.sort_by_key(|&(bearers, _)| bearers);
        told.into_iter().map(|(_, kind)| kind).find(|&kind| place.bears_out(kind, mesh))
    };
    character.meshes.iter().zip(names).map(kind_of).collect()
}

/// Where a head is.
enum Place {
    /// For each joint whether it is the head's or hangs from it.
    Rigged(Vec<bool>),
    /// Nobody knows which joints: the figure's extent along up.
    Extent { up: Vec3, low: f64, high: f64 },
}

impl Place {
    fn of(character: &Character) -> Self {
        if let Some(head) = character.humanoid.joint(Role::Head)
            && character.skeleton.validate().is_ok()
        {
            let joints = &character.skeleton.joints;
            let mut of_head = vec![false; joints.len()];
            for joint in character.skeleton.parents_first() {
                of_head[joint] = joint == head || joints[joint].parent.is_some_and(|parent| of_head[parent]);
            }
            return Self::Rigged(of_head);
        }
        let up = character.axes.up;
        let heights = character.meshes.iter().flat_map(|mesh| &mesh.positions).map(|p| f64::from(p.dot(up)));
        let (low, high) = range(heights);
        Self::Extent { up, low, high }
    }

    /// True where `mesh` lies where what `kind` says does.
    fn bears_out(&self, kind: MeshKind, mesh: &Mesh) -> bool {
        if !(kind == MeshKind::Hair || kind.is_of_face()) || mesh.positions.is_empty() {
            return true;
        }
        match self {
            Self::Rigged(of_head) => {
                let entries = mesh.weights.rows().flatten();
                let of_head = entries.filter(|&&(joint, _)| of_head.get(joint as usize) == Some(&true));
                let held: f64 = of_head.map(|&(_, weight)| f64::from(weight)).sum();
                let least = match kind {
                    MeshKind::Hair => HAIR_OF_HEAD,
                    MeshKind::Eye => EYE_OF_HEAD,
                    _ => FACE_OF_HEAD,
                };
                held / mesh.weights.row_count().max(1) as f64 >= least
            }
            Self::Extent { up, low, high } => {
                let chin = low + LOWEST_CHIN * (high - low);
                let mut heights = mesh.positions.iter().map(|p| f64::from(p.dot(*up)));
                if kind == MeshKind::Hair { heights.any(|y| y >= chin) } else { heights.all(|y| y >= chin) }
            }
        }
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

#[cfg(test)]
mod tests {
    use super::MeshKind::{self, *};
    use super::{MeshNames, kinds_from_names};
    use crate::character::{Character, Joint, Mesh, Role, Weights};
    use glam::{DMat4, DVec3, Vec3};

    #[test]
    fn kinds_are_guessed_from_whole_words() {
        for (name, kind) in [
            ("Hair001", Some(Hair)),
            ("HairBack_01", Some(Hair)),
            ("Long_Ponytail", Some(Hair)),
            ("Dwarf_Beard", Some(Hair)),
            ("bangs.L", Some(Hair)),
            ("chair", None),
            ("what", None),
            ("Hat", Some(Accessory)),
            ("hair_ribbon", Some(Accessory)),
            ("EyeGlasses", Some(Accessory)),
            ("sunglasses", Some(Accessory)),
            ("Knight_Helmet", Some(Accessory)),
            ("eyelash", Some(FacePart)),
            ("N00_000_00_EyeIris_00_EYE (Instance)", Some(Eye)),
            ("N00_000_00_FaceEyeline_00_FACE", Some(FacePart)),
            ("Eye_Shadow", Some(FacePart)),
            ("eyes", Some(Eye)),
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

    /// A mesh from `low` to `high`, moved by `rows` of (joint, weight), one a vertex.
    fn mesh(low: f32, high: f32, rows: &[&[(u32, f32)]]) -> Mesh {
        let count = rows.len().max(2);
        let at = |vertex: usize| Vec3::Y * (low + (high - low) * vertex as f32 / (count - 1) as f32);
        let weights = Weights::from_rows(rows.iter().map(|row| row.iter().copied()));
        Mesh { positions: (0..count).map(at).collect(), weights, ..Mesh::default() }
    }

    /// Hips (0), a head on them (1), a hair joint on the head (2); a body from 0 to 1 and `meshes`.
    fn character(meshes: &[Mesh]) -> Character {
        let mut character = Character::default();
        for (name, parent, y) in [("hips", None, 0.5), ("head", Some(0), 0.8), ("hair", Some(1), 0.9)] {
            let rest = DMat4::from_translation(DVec3::Y * y);
            character.skeleton.joints.push(Joint { name: name.to_string(), parent, rest });
        }
        character.humanoid.set(Role::Hips, 0);
        character.humanoid.set(Role::Head, 1);
        character.meshes.push(mesh(0.0, 1.0, &[&[(0, 1.0)], &[(1, 1.0)]]));
        character.meshes.extend_from_slice(meshes);
        character
    }

    /// The kinds of `character`'s meshes but the first, called by these paths.
    fn kinds(character: &Character, paths: &[&str]) -> Vec<Option<MeshKind>> {
        let names: Vec<MeshNames> =
            ["figure"].iter().chain(paths).map(|path| MeshNames::of_path(path)).collect();
        kinds_from_names(character, &names)[1..].to_vec()
    }

    #[test]
    fn the_name_that_the_fewest_meshes_share_says_most() {
        let on_head = || mesh(0.85, 0.95, &[&[(1, 1.0)], &[(1, 1.0)]]);
        let three = character(&[on_head(), on_head(), on_head()]);
        // One material for all: the nodes tell.
        let shared = ["skin/skin/body", "teeth/teeth/body", "hair_band/hair_band/body"];
        assert_eq!(kinds(&three, &shared), [Some(Body), Some(FacePart), Some(Accessory)]);
        // One node for all: the materials tell.
        let parts = ["Body/BodyMesh/Body", "Body/BodyMesh/Backpack", "Body/BodyMesh/Hair"];
        assert_eq!(kinds(&three, &parts), [Some(Body), Some(Accessory), Some(Hair)]);
        // Each its own: the node before the mesh, the mesh before the material.
        let own = ["teeth/skin/shirt", "Cube/hair/skirt", "Plane/Cube.001/Trousers"];
        assert_eq!(kinds(&three, &own), [Some(FacePart), Some(Hair), Some(Garment)]);
    }

    #[test]
    fn a_name_is_not_believed_against_where_the_mesh_hangs() {
        let (head, hips, hair): (&[_], &[_], &[_]) = (&[(1, 1.0)], &[(0, 1.0)], &[(2, 1.0)]);
        let figure = character(&[
            mesh(0.0, 0.9, &[head, head, hips, hips, hips]),
            mesh(0.0, 0.9, &[hips, hair, head]),
            mesh(0.8, 0.9, &[head, hair, head]),
            mesh(0.0, 0.2, &[hips, hips]),
        ]);
        // Of eyes and shoes of one material the eyes are what the head moves; fur on boots is no hair: the next name counts.
        let paths = ["eyes", "hair", "mouth", "fur_hair/Boots"];
        assert_eq!(kinds(&figure, &paths), [Some(Eye), Some(Hair), Some(FacePart), Some(Garment)]);
    }

    #[test]
    fn without_a_rig_a_face_lies_as_high_as_a_head() {
        let bare = |low: f32, high: f32| mesh(low, high, &[]);
        let mut figure = character(&[bare(0.0, 0.9), bare(0.7, 0.8), bare(0.0, 0.1), bare(0.3, 0.9)]);
        figure.skeleton.joints.clear();
        figure.humanoid = Default::default();
        figure.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
        assert_eq!(kinds(&figure, &["eyes", "eyes", "hair", "hair"]), [None, Some(Eye), None, Some(Hair)]);
    }

    #[test]
    fn a_path_has_up_to_three_names() {
        let names = |path: &str| {
            let MeshNames { node, mesh, material } = MeshNames::of_path(path);
            [node, mesh, material]
        };
        assert_eq!(names("node/mesh/material"), ["node", "mesh", "material"]);
        assert_eq!(names("above/node/mesh/"), ["above/node", "mesh", ""]);
        assert_eq!(names("node/material"), ["node", "", "material"]);
        assert_eq!(names("node"), ["node", "", ""]);
        assert_eq!(names(""), ["", "", ""]);
    }
}
