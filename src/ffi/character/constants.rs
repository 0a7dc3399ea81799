//! Kinds of meshes, types of numbers, roles of joints: the constants of a character's structs.
#![allow(missing_docs)]

/// Guessed from the name; else body, or what sdef_character_rig sees in it.
pub const SDEF_MESH_UNKNOWN: u32 = 0;
/// Skin, or skin fused with clothes.
pub const SDEF_MESH_BODY: u32 = 1;
/// Clothes.
pub const SDEF_MESH_GARMENT: u32 = 2;
/// Hair of the head.
pub const SDEF_MESH_HAIR: u32 = 3;
/// Brows, lashes, teeth, tongue: what follows the face.
pub const SDEF_MESH_FACE_PART: u32 = 4;
/// Hats, glasses, bags, weapons: what keeps its shape.
pub const SDEF_MESH_ACCESSORY: u32 = 5;
/// Eyeballs, irises, pupils: face parts that keep their shape.
pub const SDEF_MESH_EYE: u32 = 6;

/// uint32_t for indices and joints, float for weights.
pub const SDEF_TYPE_DEFAULT: u32 = 0;
/// uint8_t; as a weight 255 stands for 1.
pub const SDEF_TYPE_U8: u32 = 1;
/// uint16_t; as a weight 65535 stands for 1.
pub const SDEF_TYPE_U16: u32 = 2;
/// uint32_t; indices and joints only.
pub const SDEF_TYPE_U32: u32 = 3;
/// float; weights only.
pub const SDEF_TYPE_F32: u32 = 4;

/// Humanoid roles: the numbers of Unity's HumanBodyBones under the names of VRM 1.0 (Unity calls the thumb's joints
/// Proximal, Intermediate, Distal).
pub const SDEF_ROLE_COUNT: u32 = 55;
pub const SDEF_ROLE_HIPS: u32 = 0;
pub const SDEF_ROLE_LEFT_UPPER_LEG: u32 = 1;
pub const SDEF_ROLE_RIGHT_UPPER_LEG: u32 = 2;
pub const SDEF_ROLE_LEFT_LOWER_LEG: u32 = 3;
pub const SDEF_ROLE_RIGHT_LOWER_LEG: u32 = 4;
pub const SDEF_ROLE_LEFT_FOOT: u32 = 5;
pub const SDEF_ROLE_RIGHT_FOOT: u32 = 6;
pub const SDEF_ROLE_SPINE: u32 = 7;
pub const SDEF_ROLE_CHEST: u32 = 8;
pub const SDEF_ROLE_NECK: u32 = 9;
pub const SDEF_ROLE_HEAD: u32 = 10;
pub const SDEF_ROLE_LEFT_SHOULDER: u32 = 11;
pub const SDEF_ROLE_RIGHT_SHOULDER: u32 = 12;
pub const SDEF_ROLE_LEFT_UPPER_ARM: u32 = 13;
pub const SDEF_ROLE_RIGHT_UPPER_ARM: u32 = 14;
pub const SDEF_ROLE_LEFT_LOWER_ARM: u32 = 15;
pub const SDEF_ROLE_RIGHT_LOWER_ARM: u32 = 16;
pub const SDEF_ROLE_LEFT_HAND: u32 = 17;
pub const SDEF_ROLE_RIGHT_HAND: u32 = 18;
pub const SDEF_ROLE_LEFT_TOES: u32 = 19;
pub const SDEF_ROLE_RIGHT_TOES: u32 = 20;
pub const SDEF_ROLE_LEFT_EYE: u32 = 21;
pub const SDEF_ROLE_RIGHT_EYE: u32 = 22;
pub const SDEF_ROLE_JAW: u32 = 23;
pub const SDEF_ROLE_LEFT_THUMB_METACARPAL: u32 = 24;
pub const SDEF_ROLE_LEFT_THUMB_PROXIMAL: u32 = 25;
pub const SDEF_ROLE_LEFT_THUMB_DISTAL: u32 = 26;
pub const SDEF_ROLE_LEFT_INDEX_PROXIMAL: u32 = 27;
pub const SDEF_ROLE_LEFT_INDEX_INTERMEDIATE: u32 = 28;
pub const SDEF_ROLE_LEFT_INDEX_DISTAL: u32 = 29;
pub const SDEF_ROLE_LEFT_MIDDLE_PROXIMAL: u32 = 30;
pub const SDEF_ROLE_LEFT_MIDDLE_INTERMEDIATE: u32 = 31;
pub const SDEF_ROLE_LEFT_MIDDLE_DISTAL: u32 = 32;
pub const SDEF_ROLE_LEFT_RING_PROXIMAL: u32 = 33;
pub const SDEF_ROLE_LEFT_RING_INTERMEDIATE: u32 = 34;
pub const SDEF_ROLE_LEFT_RING_DISTAL: u32 = 35;
pub const SDEF_ROLE_LEFT_LITTLE_PROXIMAL: u32 = 36;
pub const SDEF_ROLE_LEFT_LITTLE_INTERMEDIATE: u32 = 37;
pub const SDEF_ROLE_LEFT_LITTLE_DISTAL: u32 = 38;
pub const SDEF_ROLE_RIGHT_THUMB_METACARPAL: u32 = 39;
pub const SDEF_ROLE_RIGHT_THUMB_PROXIMAL: u32 = 40;
pub const SDEF_ROLE_RIGHT_THUMB_DISTAL: u32 = 41;
pub const SDEF_ROLE_RIGHT_INDEX_PROXIMAL: u32 = 42;
pub const SDEF_ROLE_RIGHT_INDEX_INTERMEDIATE: u32 = 43;
pub const SDEF_ROLE_RIGHT_INDEX_DISTAL: u32 = 44;
pub const SDEF_ROLE_RIGHT_MIDDLE_PROXIMAL: u32 = 45;
pub const SDEF_ROLE_RIGHT_MIDDLE_INTERMEDIATE: u32 = 46;
pub const SDEF_ROLE_RIGHT_MIDDLE_DISTAL: u32 = 47;
pub const SDEF_ROLE_RIGHT_RING_PROXIMAL: u32 = 48;
pub const SDEF_ROLE_RIGHT_RING_INTERMEDIATE: u32 = 49;
pub const SDEF_ROLE_RIGHT_RING_DISTAL: u32 = 50;
pub const SDEF_ROLE_RIGHT_LITTLE_PROXIMAL: u32 = 51;
pub const SDEF_ROLE_RIGHT_LITTLE_INTERMEDIATE: u32 = 52;
pub const SDEF_ROLE_RIGHT_LITTLE_DISTAL: u32 = 53;
pub const SDEF_ROLE_UPPER_CHEST: u32 = 54;
