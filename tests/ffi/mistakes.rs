//! Every mistake that a host can make.

use super::*;

const ARGUMENT: u32 = SDEF_STATUS_BAD_ARGUMENT;
const HANDLE: u32 = SDEF_STATUS_BAD_HANDLE;
const INPUT: u32 = SDEF_STATUS_BAD_INPUT;
const OPTION: u32 = SDEF_STATUS_BAD_OPTION;
const STYLE: u32 = SDEF_STATUS_BAD_STYLE;
const SMALL: u32 = SDEF_STATUS_BUFFER_TOO_SMALL;

/// What the calls take: handles, and arrays that something is wrong with.
struct Host {
    /// The person.
    full: SdefCharacter,
    empty: SdefCharacter,
    /// Joints alone.
    bare: SdefCharacter,
    of_heads: SdefStyle,
    measured: SdefStyle,
    /// Of the person.
    deformer: SdefDeformer,
    nans: Vec<f32>,
    nan_matrices: Vec<f64>,
    negative: Vec<f32>,
    zeros: Vec<u32>,
    huge: Vec<u32>,
    falling: Vec<u32>,
    circle: Vec<i32>,
    wild: Vec<i32>,
    matrices_by_rows: Vec<[f64; 16]>,
    twice: [SdefGroupSettings; 2],
    too_long: SdefGroupSettings,
    knees: SdefGroupSettings,
    nameless: SdefGroupSettings,
    of_zeros: SdefGroupSettings,
    mixed: [SdefGroupSettings; 2],
    bone: SdefBoneGroup,
    joint_of_no_role: SdefGivenJoint,
    joint_nowhere: SdefGivenJoint,
}

impl Host {
    fn new() -> Self {
        let (full, empty, bare) = (given(person()), create(), create());
        let skeleton = c_skeleton(person());
        ask(|error| unsafe { sdef_character_set_skeleton(bare, &skeleton.skeleton, error) }).unwrap();
        let style = of_heads(2.5);
        let vertices = person().meshes[0].positions.len();
        let joints = &person().skeleton.joints;
        Self {
            full,
            empty,
            bare,
            of_heads: style,
            measured: from_text("sd2.5").unwrap(),
            deformer: deformer(full, style, &options()),
            nans: vec![f32::NAN; 3 * vertices],
            nan_matrices: vec![f64::NAN; 16 * joints.len()],
            negative: vec![-0.25; vertices],
            zeros: vec![0; vertices + 1],
            huge: vec![4_000_000_000; 3],
            falling: (0..=vertices as u32).rev().collect(),
            circle: (0..joints.len() as i32).map(|joint| (joint + 1) % 3).collect(),
            wild: vec![-7; joints.len()],
            matrices_by_rows: joints.iter().map(|joint| joint.rest.transpose().to_cols_array()).collect(),
            twice: [group_settings(c"upper_leg"); 2],
            too_long: SdefGroupSettings { length_scale: 1000.0, ..group_settings(c"upper_leg") },
            nameless: SdefGroupSettings::default(),
            of_zeros: SdefGroupSettings {
                struct_size: size_of::<SdefGroupSettings>() as u32,
                group: c"torso".as_ptr(),
                ..zeroed()
            },
            mixed: [
                group_settings(c"foot"),
                SdefGroupSettings { struct_size: 16, ..group_settings(c"hand") },
            ],
            knees: SdefGroupSettings { length_scale: 0.5, ..group_settings(c"knees") },
            bone: SdefBoneGroup {
                struct_size: size_of::<SdefBoneGroup>() as u32,
                role: 77,
                group: c"x".as_ptr(),
            },
            joint_of_no_role: SdefGivenJoint { role: 60, ..given_joint() },
            joint_nowhere: SdefGivenJoint { x: f64::NAN, ..given_joint() },
        }
    }

    /// Makes a call that must fail.
    fn make(&self, call: &Call, error: *mut SdefError) -> SdefStatus {
        let mut style = SdefStyle::default();
        let mut deformer = SdefDeformer::default();
        let known = || unsafe {
            let mut numbers =
                SdefStyleNumbers { struct_size: size_of::<SdefStyleNumbers>() as u32, ..zeroed() };
            sdef_style_get_numbers(self.measured, &mut numbers, null_mut(), 0, null_mut(), null_mut());
            numbers
        };
        unsafe {
            match call {
                Mesh(change) => {
                    let mut given = c_mesh(&person().meshes[0]);
                    change(self, &mut given.mesh);
                    sdef_character_add_mesh(self.full, &given.mesh, null_mut(), error)
                }
                Morph(mesh, change) => {
                    let mut target = c_morph(&person().meshes[0].morph_targets[0]);
                    change(self, &mut target);
                    sdef_character_add_morph_target(self.full, *mesh, &target, error)
                }
                Skeleton(change) => {
                    let mut given = c_skeleton(person());
                    change(self, &mut given.skeleton);
                    sdef_character_set_skeleton(self.empty, &given.skeleton, error)
                }
                Rig(change) => {
                    let mut options = options();
                    change(self, &mut options);
                    sdef_character_rig(self.full, &options, None, null_mut(), error)
                }
                Deform(character, change) => {
                    let mut options = options();
                    change(self, &mut options);
                    let (character, style) = (character(self), self.of_heads);
                    sdef_deformer_create(character, style, &options, None, null_mut(), &mut deformer, error)
                }
                Results(change) => {
                    let mut room = room(person());
                    change(&mut room.meshes[0]);
                    let (start, count) = (room.meshes.as_ptr(), room.meshes.len());
                    sdef_deformer_apply(self.deformer, start, count, None, null_mut(), error)
                }
                Text(text) => sdef_style_from_text(text.as_ptr().cast(), text.len(), &mut style, error),
                Numbers(change) => {
                    let mut numbers = known();
                    change(&mut numbers);
                    sdef_style_from_numbers(null(), &numbers, null(), 0, &mut style, error)
                }
                Bones(bones) => {
                    let bones = bones.map(|(end, length)| SdefBone { end, length, radius: 1.0, ..bone() });
                    sdef_style_from_numbers(null(), &known(), bones.as_ptr(), 2, &mut style, error)
                }
                Other(call) => call(self, error),
            }
        }
    }
}

/// A call, as its change to one that works.
enum Call {
    Mesh(fn(&Host, &mut SdefMesh)),
    Morph(u32, fn(&Host, &mut SdefMorphTarget)),
    Skeleton(fn(&Host, &mut SdefSkeleton)),
    Rig(fn(&Host, &mut SdefOptions)),
    Deform(fn(&Host) -> SdefCharacter, fn(&Host, &mut SdefOptions)),
    Results(fn(&mut SdefMeshResult)),
    Text(&'static str),
    Numbers(fn(&mut SdefStyleNumbers)),
    /// Ends and lengths.
    Bones([(u32, f64); 2]),
    Other(fn(&Host, *mut SdefError) -> SdefStatus),
}
use Call::*;

const FULL: fn(&Host) -> SdefCharacter = |host| host.full;

/// The person's meshes.
const MESHES: usize = 4;

/// The mistake, its status, what its sentence must name, and the call.
const CASES: &[(&str, u32, &str, Call)] = &[
    // ---- a character ----
    ("up of length 0", INPUT, "up", Other(|_, error| create_along(Some(&[0.0; 3]), None, error))),
    ("forward along up", INPUT, "forward", Other(|_, e| create_along(None, Some(&[0.0, 2.0, 0.0]), e))),
    (
        "no place for a character",
        ARGUMENT,
        "character is NULL",
        Other(|_, error| unsafe { sdef_character_create(null(), null(), null_mut(), error) }),
    ),
    (
        "no mesh",
        ARGUMENT,
        "SdefMesh is NULL",
        Other(|host, error| unsafe { sdef_character_add_mesh(host.full, null(), null_mut(), error) }),
    ),
    ("a mesh of size 0", ARGUMENT, "SdefMesh is 0", Mesh(|_, mesh| mesh.struct_size = 0)),
    ("a mesh of a pointer's size", ARGUMENT, "SdefMesh is 8", Mesh(|_, mesh| mesh.struct_size = 8)),
    ("a reserved field of 3", ARGUMENT, "SdefMesh is 3: set it to 0", Mesh(|_, mesh| mesh.reserved_2 = 3)),
    ("a mesh of size 7", ARGUMENT, "SdefMesh is 7", Mesh(|_, mesh| mesh.struct_size = 7)),
    ("a mesh of wild size", ARGUMENT, "3735928556", Mesh(|_, mesh| mesh.struct_size = 0xDEAD_BEEC)),
    ("an unknown kind", ARGUMENT, "kind is 7", Mesh(|_, mesh| mesh.kind = 7)),
    ("no positions", ARGUMENT, "positions is NULL", Mesh(|_, mesh| mesh.positions = null())),
    ("too many vertices", ARGUMENT, "4294967295", Mesh(|_, mesh| mesh.vertex_count = u32::MAX as usize)),
    ("far too many", ARGUMENT, "18446744073709551615", Mesh(|_, mesh| mesh.vertex_count = usize::MAX)),
    ("a stride of 11", ARGUMENT, "positions is 11", Mesh(|_, mesh| mesh.position_stride = 11)),
    ("a wild stride", ARGUMENT, "positions", Mesh(|_, mesh| mesh.position_stride = usize::MAX / 2)),
    ("a tangent stride of 12", ARGUMENT, "tangents is 12", Mesh(|_, mesh| mesh.tangent_stride = 12)),
    ("a position that is NAN", INPUT, "vertex 0", Mesh(|host, mesh| mesh.positions = host.nans.as_ptr())),
    ("a normal that is NAN", INPUT, "normal", Mesh(|host, mesh| mesh.normals = host.nans.as_ptr())),
    ("no indices", ARGUMENT, "indices is NULL", Mesh(|_, mesh| mesh.indices = null())),
    ("4 indices", ARGUMENT, "index_count is 4", Mesh(|_, mesh| mesh.index_count = 4)),
    ("wild indices", ARGUMENT, "indices", Mesh(|_, mesh| mesh.index_count = usize::MAX / 3 * 3)),
    (
        "an index beyond the vertices",
        INPUT,
        "4000000000",
        Mesh(|host, mesh| (mesh.indices, mesh.index_count) = (host.huge.as_ptr().cast(), 3)),
    ),
    ("indices as floats", ARGUMENT, "index_type is 4", Mesh(|_, mesh| mesh.index_type = SDEF_TYPE_F32)),
    ("joints as floats", ARGUMENT, "joint_type is 4", Mesh(|_, mesh| mesh.joint_type = SDEF_TYPE_F32)),
    ("weights as integers", ARGUMENT, "weight_type is 3", Mesh(|_, mesh| mesh.weight_type = SDEF_TYPE_U32)),
    ("no joints", ARGUMENT, "joints is NULL", Mesh(|_, mesh| mesh.joints = null())),
    ("no weights", ARGUMENT, "weights is NULL", Mesh(|_, mesh| mesh.weights = null())),
    (
        "wild influences",
        ARGUMENT,
        "joints",
        Mesh(|_, mesh| (mesh.influence_count, mesh.row_starts) = (usize::MAX / 2, null())),
    ),
    (
        "a joint stride of 1",
        ARGUMENT,
        "joints is 1",
        Mesh(|_, mesh| (mesh.influence_count, mesh.row_starts, mesh.joint_stride) = (1, null(), 1)),
    ),
    ("rows that fall", INPUT, "row_starts 0", Mesh(|host, mesh| mesh.row_starts = host.falling.as_ptr())),
    ("rows that end early", INPUT, "ends at 0", Mesh(|host, mesh| mesh.row_starts = host.zeros.as_ptr())),
    (
        "a negative weight",
        INPUT,
        "-0.25",
        Mesh(|host, mesh| {
            (mesh.influence_count, mesh.row_starts) = (1, null());
            (mesh.joints, mesh.weights) = (host.zeros.as_ptr().cast(), host.negative.as_ptr().cast());
        }),
    ),
    (
        "weights before the skeleton",
        INPUT,
        "sdef_character_set_skeleton",
        Other(|host, error| unsafe {
            sdef_character_add_mesh(host.empty, &c_mesh(&person().meshes[0]).mesh, null_mut(), error)
        }),
    ),
    ("an image that is none", ARGUMENT, "image is 7", Mesh(|_, mesh| mesh.image = 7)),
    (
        "an image without pixels",
        ARGUMENT,
        "width is 0",
        Other(|host, error| unsafe {
            let image = SdefImage { struct_size: size_of::<SdefImage>() as u32, ..zeroed() };
            let mut number = 0;
            sdef_character_add_image(host.full, &image, &mut number, error)
        }),
    ),
    (
        "an eye that is nowhere",
        INPUT,
        "NaN",
        Other(|host, error| unsafe {
            let nowhere = [f64::NAN; 3];
            let eye = nowhere.as_ptr();
            let size = size_of::<SdefFaceHints>() as u32;
            let hints = SdefFaceHints { struct_size: size, eye, ..zeroed() };
            sdef_character_set_face_hints(host.full, &hints, error)
        }),
    ),
    (
        "an eye of no width",
        INPUT,
        "-1 wide",
        Other(|host, error| unsafe {
            let eye = [0.0; 3];
            let size = size_of::<SdefFaceHints>() as u32;
            let hints = SdefFaceHints { struct_size: size, eye: eye.as_ptr(), half_width: -1.0, ..zeroed() };
            sdef_character_set_face_hints(host.full, &hints, error)
        }),
    ),
    (
        "the other eye alone",
        ARGUMENT,
        "eye is NULL",
        Other(|host, error| unsafe {
            let eye = [0.0; 3];
            let size = size_of::<SdefFaceHints>() as u32;
            let hints = SdefFaceHints { struct_size: size, other_eye: eye.as_ptr(), ..zeroed() };
            sdef_character_set_face_hints(host.full, &hints, error)
        }),
    ),
    (
        "no morph target",
        ARGUMENT,
        "SdefMorphTarget is NULL",
        Other(|host, error| unsafe { sdef_character_add_morph_target(host.full, 0, null(), error) }),
    ),
    ("a target without positions", ARGUMENT, "positions is NULL", Morph(0, |_, t| t.positions = null())),
    ("a morph target of no mesh", ARGUMENT, "no mesh 99", Morph(99, |_, _| ())),
    ("a delta that is NAN", INPUT, "vertex 0", Morph(0, |host, target| target.normals = host.nans.as_ptr())),
    (
        "no skeleton",
        ARGUMENT,
        "SdefSkeleton is NULL",
        Other(|host, error| unsafe { sdef_character_set_skeleton(host.empty, null(), error) }),
    ),
    ("no parents", ARGUMENT, "parents is NULL", Skeleton(|_, skeleton| skeleton.parents = null())),
    ("a circle of parents", INPUT, "joint", Skeleton(|host, s| s.parents = host.circle.as_ptr())),
    ("a parent of -7", INPUT, "-7", Skeleton(|host, skeleton| skeleton.parents = host.wild.as_ptr())),
    ("a NAN matrix", INPUT, "joint 0", Skeleton(|host, s| s.rest_matrices = host.nan_matrices.as_ptr())),
    (
        "matrices row by row",
        INPUT,
        "joint 0",
        Skeleton(|host, skeleton| skeleton.rest_matrices = host.matrices_by_rows.as_ptr().cast()),
    ),
    (
        "one joint for two roles",
        INPUT,
        "the joint 0",
        Skeleton(|host, s| (s.role_joints, s.role_count) = (host.zeros.as_ptr().cast(), 2)),
    ),
    ("a matrix stride of 64", ARGUMENT, "rest_matrices is 64", Skeleton(|_, s| s.rest_stride = 64)),
    ("wild joints", ARGUMENT, "18446744073709551615", Skeleton(|_, s| s.joint_count = usize::MAX)),
    ("56 roles", ARGUMENT, "role_count is 56", Skeleton(|_, skeleton| skeleton.role_count = 56)),
    ("no roles", ARGUMENT, "role_joints is NULL", Skeleton(|_, skeleton| skeleton.role_joints = null())),
    (
        "a role for joint -7",
        INPUT,
        "the joint -7",
        Skeleton(|host, skeleton| (skeleton.role_joints, skeleton.role_count) = (host.wild.as_ptr(), 3)),
    ),
    (
        "a skeleton that weights do not fit",
        INPUT,
        "mesh 0",
        Other(|host, error| unsafe {
            let mut one = c_skeleton(person());
            (one.skeleton.joint_count, one.skeleton.role_count) = (1, 0);
            sdef_character_set_skeleton(host.full, &one.skeleton, error)
        }),
    ),
    (
        "no place for info",
        ARGUMENT,
        "SdefCharacterInfo is NULL",
        Other(|host, error| unsafe { sdef_character_get_info(host.full, null_mut(), error) }),
    ),
    ("weights of no mesh", ARGUMENT, "no mesh 17", Other(|host, e| weights_of(host, 17, 4, None, e))),
    ("0 influences", ARGUMENT, "influence_count is 0", Other(|host, e| weights_of(host, 0, 0, None, e))),
    ("weights of 2 vertices", SMALL, "2 vertices", Other(|h, e| weights_of(h, 0, 4, Some(&mut [9; 8]), e))),
    (
        "room for 2 joints",
        SMALL,
        "can hold 2",
        Other(|host, error| unsafe {
            let (mut parents, none) = ([9; 2], null_mut());
            let to = parents.as_mut_ptr();
            sdef_character_get_joints(host.full, to, null_mut(), none, none, 2, null_mut(), error)
        }),
    ),
    // ---- a rig ----
    (
        "rig without meshes",
        SDEF_STATUS_NO_GEOMETRY,
        "",
        Other(|host, error| unsafe { sdef_character_rig(host.empty, null(), None, null_mut(), error) }),
    ),
    ("heat below 0", OPTION, "-1", Rig(|_, options| options.rig_heat = -1.0)),
    ("3 voxels", OPTION, "3", Rig(|_, options| options.rig_voxel_resolution = 3)),
    ("an unknown rule of weights", ARGUMENT, "rig_weights is 3", Rig(|_, options| options.rig_weights = 3)),
    (
        "a given joint of role 60",
        ARGUMENT,
        "role 60",
        Rig(|host, options| (options.rig_joints, options.rig_joint_count) = (&host.joint_of_no_role, 1)),
    ),
    (
        "a given joint at NAN",
        OPTION,
        "hips",
        Rig(|host, options| (options.rig_joints, options.rig_joint_count) = (&host.joint_nowhere, 1)),
    ),
    // ---- options ----
    ("options of size 0", ARGUMENT, "SdefOptions is 0", Deform(FULL, |_, o| o.struct_size = 0)),
    ("an unknown mode", ARGUMENT, "mode is 2", Deform(FULL, |_, options| options.mode = 2)),
    ("an unknown stage", ARGUMENT, "stage is 9", Deform(FULL, |_, options| options.stage = 9)),
    ("repair of 3", ARGUMENT, "repair is 3", Deform(FULL, |_, options| options.repair = 3)),
    ("limits of 2", ARGUMENT, "limits is 2", Deform(FULL, |_, options| options.limits = 2)),
    ("an unknown curve", ARGUMENT, "face_curve is 3", Deform(FULL, |_, options| options.face_curve = 3)),
    ("2 rays", OPTION, "rays", Deform(FULL, |_, options| options.rays = 2)),
    ("a head of NAN", OPTION, "NaN", Deform(FULL, |_, options| options.head_scale = f64::NAN)),
    ("an amount of 2", OPTION, "amount", Deform(FULL, |_, options| options.amount = 2.0)),
    (
        "a height of -1",
        OPTION,
        "height is -1: give style, keep, or a number above 0",
        Deform(FULL, |_, options| options.height = -1.0),
    ),
    (
        "a group without a name",
        ARGUMENT,
        "groups[0].group is NULL",
        Deform(FULL, |host, options| (options.groups, options.group_count) = (&host.nameless, 1)),
    ),
    (
        "groups of mixed sizes",
        ARGUMENT,
        "struct_size of groups[1]",
        Deform(FULL, |host, options| (options.groups, options.group_count) = (host.mixed.as_ptr(), 2)),
    ),
    ("text with its NUL", ARGUMENT, "NUL at byte 5", Text("sd2.5\0")),
    ("hair of -1", OPTION, "hair", Deform(FULL, |_, options| options.hair_length = -1.0)),
    ("a squash of 11", OPTION, "squash", Deform(FULL, |_, options| options.face_squash = 11.0)),
    ("a squash of -11", OPTION, "squash", Deform(FULL, |_, options| options.face_squash = -11.0)),
    ("no groups", ARGUMENT, "groups is NULL", Deform(FULL, |_, options| options.group_count = 1)),
    (
        "a group twice",
        ARGUMENT,
        "upper_leg",
        Deform(FULL, |host, options| (options.groups, options.group_count) = (host.twice.as_ptr(), 2)),
    ),
    (
        "a group out of range",
        OPTION,
        "1000",
        Deform(FULL, |host, options| (options.groups, options.group_count) = (&host.too_long, 1)),
    ),
    (
        "a group of zeros",
        OPTION,
        "torso is 0: give a number from 0.01 to 10, or NAN to leave it as it is (length_scale)",
        Deform(FULL, |host, options| (options.groups, options.group_count) = (&host.of_zeros, 1)),
    ),
    (
        "an unknown group",
        OPTION,
        "knees",
        Deform(FULL, |host, options| (options.groups, options.group_count) = (&host.knees, 1)),
    ),
    (
        "a bone of role 77",
        ARGUMENT,
        "role 77",
        Deform(FULL, |host, options| (options.bone_groups, options.bone_group_count) = (&host.bone, 1)),
    ),
    ("N heads in paper mode", OPTION, "heads", Deform(FULL, |_, options| options.mode = SDEF_MODE_PAPER)),
    ("a deformer of nothing", SDEF_STATUS_NO_HUMANOID, "hips", Deform(|host| host.empty, |_, _| ())),
    ("a deformer of joints alone", SDEF_STATUS_NO_GEOMETRY, "", Deform(|host| host.bare, |_, _| ())),
    (
        "no place for a deformer",
        ARGUMENT,
        "deformer is NULL",
        Other(|host, error| unsafe {
            sdef_deformer_create(host.full, host.of_heads, null(), None, null_mut(), null_mut(), error)
        }),
    ),
    (
        "no place for options",
        ARGUMENT,
        "options is NULL",
        Other(|_, error| unsafe { sdef_options_init(null_mut(), 200, error) }),
    ),
    (
        "options of size 3",
        ARGUMENT,
        "SdefOptions is 3",
        Other(|_, error| unsafe { sdef_options_init(&mut options(), 3, error) }),
    ),
    // ---- a style ----
    ("1.7 heads", OPTION, "1.7", Other(|_, error| style_of(1.7, error))),
    ("NAN heads", OPTION, "NaN", Other(|_, error| style_of(f64::NAN, error))),
    ("a style of no text", STYLE, "\"\"", Text("")),
    ("a style that is none", STYLE, "sd5", Text("sd5")),
    ("a style of broken text", STYLE, "", Text("{\"superdeform_style\": ")),
    ("a later style", STYLE, "99", Text("{\"superdeform_style\": 99, \"head_length\": 1.0, \"bones\": {}}")),
    ("a style that is no UTF-8", STYLE, "byte 1", Other(|_, error| style_from(b"{\xFF}".as_ptr(), 3, error))),
    ("a style of NULL", ARGUMENT, "text is NULL", Other(|_, error| style_from(null(), 5, error))),
    ("a wild text", ARGUMENT, "text", Other(|_, e| style_from(std::ptr::dangling(), usize::MAX, e))),
    (
        "a style of the empty character",
        SDEF_STATUS_NO_HUMANOID,
        "hips",
        Other(|host, error| unsafe {
            sdef_style_measure(host.empty, null(), null(), &mut SdefStyle::default(), error)
        }),
    ),
    (
        "a style of no numbers",
        ARGUMENT,
        "SdefStyleNumbers is NULL",
        Other(|_, error| unsafe {
            sdef_style_from_numbers(null(), null(), null(), 0, &mut SdefStyle::default(), error)
        }),
    ),
    ("a leg of 0", STYLE, "leg", Numbers(|numbers| numbers.leg = 0.0)),
    ("a head of 0", STYLE, "head", Numbers(|numbers| numbers.bone_head_length = 0.0)),
    ("a bone to 56", ARGUMENT, "role 56", Bones([(56, 1.0); 2])),
    ("a bone twice", STYLE, "bones 1", Bones([(55, 1.0); 2])),
    ("a bone of length -1", STYLE, "-1", Bones([(55, 1.0), (5, -1.0)])),
    ("a blend of 11", OPTION, "11", Other(|host, error| blended(host.measured, 11.0, error))),
    (
        "a blend with N heads",
        STYLE,
        "number of heads",
        Other(|host, error| blended(host.of_heads, 0.5, error)),
    ),
    (
        "N heads as JSON",
        STYLE,
        "2.5 heads",
        Other(|host, error| unsafe { sdef_style_to_json(host.of_heads, null_mut(), 0, null_mut(), error) }),
    ),
    (
        "a short text",
        SMALL,
        "room for 10",
        Other(|host, error| unsafe {
            sdef_style_to_json(host.measured, [0; 10].as_mut_ptr(), 10, null_mut(), error)
        }),
    ),
    // ---- results ----
    ("results of another size", ARGUMENT, "is 40", Results(|result| result.struct_size = 40)),
    ("room for 5 vertices", SMALL, "can hold 5", Results(|result| result.vertex_capacity = 5)),
    ("room for 1 morph target", SMALL, "1 morph targets", Results(|r| r.morph_target_capacity = 1)),
    ("a result stride of 8", ARGUMENT, "normals is 8", Results(|result| result.normal_stride = 8)),
    ("results for no mesh", ARGUMENT, "mesh_count is 0", Other(|host, error| no_results(host, 0, error))),
    ("results of NULL", ARGUMENT, "results is NULL", Other(|host, e| no_results(host, MESHES, e))),
    (
        "a point of joint 4000000000",
        INPUT,
        "4000000000",
        Other(|host, e| map(host, &host.huge, &[0.0; 3], e)),
    ),
    ("a point at NAN", INPUT, "point 0", Other(|host, e| map(host, &host.zeros, &host.nan_matrices, e))),
    (
        "room for 1 joint",
        SMALL,
        "can hold 1",
        Other(|host, error| unsafe {
            let mut place = [0.0; 3];
            sdef_deformer_get_joints(host.deformer, place.as_mut_ptr(), null_mut(), 1, null_mut(), error)
        }),
    ),
    (
        "room for 1 group",
        SMALL,
        "can hold 1",
        Other(|host, error| unsafe {
            sdef_deformer_get_groups(host.deformer, &mut zeroed(), 1, null_mut(), error)
        }),
    ),
    (
        "a report of size 0",
        ARGUMENT,
        "SdefReport is 0",
        Other(|host, error| unsafe {
            sdef_deformer_get_report(host.deformer, &mut zeroed(), null_mut(), 0, null_mut(), error)
        }),
    ),
    // ---- handles and progress ----
    (
        "a handle that is none",
        HANDLE,
        "id 0",
        Other(|_, error| unsafe { sdef_character_get_info(SdefCharacter { id: 0 }, null_mut(), error) }),
    ),
    ("a handle that is made up", HANDLE, "0x2a", Other(|_, error| unsafe { sdef_destroy(42, error) })),
    (
        "a style for a character",
        HANDLE,
        "is a style",
        Other(|host, error| unsafe {
            sdef_character_get_info(SdefCharacter { id: host.of_heads.id }, null_mut(), error)
        }),
    ),
    (
        "a progress that stops",
        SDEF_STATUS_CANCELLED,
        "",
        Other(|host, error| unsafe {
            let mut made = SdefDeformer::default();
            let (character, style) = (host.full, host.of_heads);
            sdef_deformer_create(character, style, null(), Some(stop), null_mut(), &mut made, error)
        }),
    ),
];

fn create_along(up: Option<&[f32; 3]>, forward: Option<&[f32; 3]>, error: *mut SdefError) -> SdefStatus {
    let start = |axis: Option<&[f32; 3]>| axis.map_or(null(), |axis| axis.as_ptr());
    unsafe { sdef_character_create(start(up), start(forward), &mut SdefCharacter::default(), error) }
}

/// The weights of a mesh; `joints` holds them of 2 vertices.
fn weights_of(
    host: &Host,
    mesh: u32,
    influences: u32,
    joints: Option<&mut [u32; 8]>,
    error: *mut SdefError,
) -> SdefStatus {
    let joints = joints.map_or(null_mut(), |joints| joints.as_mut_ptr());
    unsafe { sdef_character_get_weights(host.full, mesh, influences, joints, null_mut(), 2, error) }
}

fn style_of(heads: f64, error: *mut SdefError) -> SdefStatus {
    unsafe { sdef_style_from_heads(heads, SdefStyle::default(), &mut SdefStyle::default(), error) }
}

fn style_from(text: *const u8, size: usize, error: *mut SdefError) -> SdefStatus {
    unsafe { sdef_style_from_text(text.cast(), size, &mut SdefStyle::default(), error) }
}

fn blended(with: SdefStyle, amount: f64, error: *mut SdefError) -> SdefStatus {
    let first = from_text("sd3").unwrap();
    let status = unsafe { sdef_style_blend(first, with, amount, &mut SdefStyle::default(), error) };
    destroy(first.id);
    status
}

fn no_results(host: &Host, mesh_count: usize, error: *mut SdefError) -> SdefStatus {
    unsafe { sdef_deformer_apply(host.deformer, null(), mesh_count, None, null_mut(), error) }
}

fn map(host: &Host, joints: &[u32], points: &[f64], error: *mut SdefError) -> SdefStatus {
    let (joints, points, none) = (joints.as_ptr(), points.as_ptr(), null_mut());
    unsafe { sdef_deformer_map_points(host.deformer, joints, points, 1, none, none, none, error) }
}

unsafe extern "C" fn stop(_user: *mut c_void, _fraction: f32) -> i32 {
    1
}

/// The sentences are printed, to be read.
#[test]
fn every_mistake_gets_its_status_and_a_sentence() {
    let _at_work = at_work();
    let host = Host::new();
    let (mut produced, mut wrong) = (BTreeSet::new(), Vec::new());
    for (what, status, named, call) in CASES {
        let name = unsafe { CStr::from_ptr(sdef_status_name(*status)) }.to_str().unwrap();
        match ask(|error| host.make(call, error)) {
            Err(failure) if failure.status == *status => {
                println!("{what}: {name}: {}", failure.message);
                if !failure.message.contains(named) {
                    wrong.push(format!("{what}: {named} is not named: {}", failure.message));
                }
                for word in ["--", "panicked", "unwrap", "index out of bounds"] {
                    if failure.message.contains(word) {
                        wrong.push(format!("{what}: a host does not know {word}: {}", failure.message));
                    }
                }
                produced.insert(failure.status);
            }
            other => wrong.push(format!("{what}: {name} is wanted, but there is {other:?}")),
        }
        if host.make(call, null_mut()) != *status {
            wrong.push(format!("{what}: another status without a struct for the error"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // OK, BUSY, OUT_OF_MEMORY and INTERNAL are produced by tests of their own.
    assert_eq!(produced.len(), 9);
    let characters = [host.full, host.empty, host.bare].map(|handle| handle.id);
    let others = [host.of_heads.id, host.measured.id, host.deformer.id];
    characters.into_iter().chain(others).for_each(destroy);
}

/// Gives a person whose meshes were changed a style; what that says.
fn refused(change: impl Fn(&mut superdeform::Mesh)) -> Failed {
    let mut character = person().clone();
    character.meshes.iter_mut().for_each(change);
    let (character, style) = (given(&character), of_heads(2.5));
    let failed = deformer_with(character, style, null(), None, null_mut()).unwrap_err();
    destroy(character.id);
    destroy(style.id);
    failed
}

#[test]
fn what_nothing_can_be_measured_beside_is_named() {
    let _at_work = at_work();
    // One vertex that a fault has flung away.
    let body = &person().meshes[0].name;
    let failed = refused(|mesh| {
        if mesh.name == *body {
            let vertex = mesh.triangles[7][1] as usize;
            mesh.positions[vertex] = Vec3::new(0.5, 1e30, -2.0);
        }
    });
    let vertex = person().meshes[0].triangles[7][1];
    assert_eq!(
        (failed.status, failed.mesh, failed.element),
        (SDEF_STATUS_NO_GEOMETRY, Some(0), Some(vertex)),
        "{failed:?}"
    );
    let at = format!("vertex, {vertex} at [0.5, 1{}, -2]", "0".repeat(30));
    assert!(failed.message.contains(&at), "{failed:?}");
    // Triangles of one corner.
    let failed = refused(|mesh| mesh.triangles.iter_mut().for_each(|corners| *corners = [corners[0]; 3]));
    assert_eq!(failed.status, SDEF_STATUS_NO_GEOMETRY, "{failed:?}");
    assert!(failed.message.contains("no triangle of the character has an area"), "{failed:?}");
}
