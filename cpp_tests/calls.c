// Every function of the ABI as a host in C calls it, in the order of the header.
#include "superdeform.h"
#include "check.h"
#include "figure.h"
#include <math.h>

static Figure figure;
static SdefError error = SDEF_ERROR_INIT;

static int32_t count_calls(void *user, float fraction) {
  CHECK(fraction >= 0 && fraction <= 1);
  *(int *)user += 1;
  return 0;
}

static SdefCharacter make_character(int with_joints) {
  SdefCharacter character = {0};
  const float up[3] = {0, 2, 0}, forward[3] = {0, 0, 1};
  uint32_t index = 7;
  OK(sdef_character_create(up, forward, &character, &error));
  SdefMesh mesh = figure.mesh;
  if (with_joints) {
    OK(sdef_character_set_skeleton(character, &figure.skeleton, &error));
  } else {
    mesh.influence_count = 0;
    mesh.joints = mesh.weights = NULL;
    mesh.joint_stride = mesh.weight_stride = 0;
  }
  const uint8_t pixels[6] = {0, 255, 9, 255, 0, 9};
  const SdefImage image = {sizeof(SdefImage), 2, 2, 0, pixels, 3};
  const double eye[3] = {0.03, 1.65, 0.1};
  const SdefFaceHints hints = {sizeof(SdefFaceHints), 0, eye, NULL, 0.012, 0};
  OK(sdef_character_add_image(character, &image, &mesh.image, &error));
  CHECK(mesh.image == 1);
  mesh.uvs = figure.vertices[0].position;
  mesh.uv_stride = sizeof figure.vertices[0];
  const SdefFaceHints none = {sizeof(SdefFaceHints), 0, NULL, NULL, 0, 0};
  OK(sdef_character_set_face_hints(character, &hints, &error));
  // The call that keeps nothing takes none.
  OK(sdef_character_set_face_hints(character, &none, &error));
  OK(sdef_character_add_mesh(character, &mesh, &index, &error));
  CHECK(index == 0);
  OK(sdef_character_add_morph_target(character, 0, &figure.target, &error));
  return character;
}

static void version_status_errors_handles(void) {
  CHECK(sdef_abi_version() == SDEF_ABI_VERSION);
  CHECK(sdef_version()[0] == (char)('0' + SDEF_VERSION_MAJOR) && sdef_version()[1] == '.');
  CHECK(strcmp(sdef_status_name(SDEF_STATUS_BUSY), "SDEF_STATUS_BUSY") == 0);
  CHECK(strcmp(sdef_status_name(12345), "unknown status") == 0);
  CHECK(sdef_live_handles() == 0);
  OK(sdef_destroy(0, &error));
  OK(sdef_destroy(0, NULL));
}

static void options(void) {
  SdefOptions options;
  memset(&options, 0xAB, sizeof options);
  OK(sdef_options_init(&options, sizeof options, &error));
  CHECK(options.struct_size == sizeof options && options.thread_count == 0);
  CHECK(options.mode == SDEF_MODE_PRODUCT && options.stage == SDEF_STAGE_FACE && options.rays == 0);
  CHECK(options.limits == 1 && options.head_scale == 1.5 && options.amount == 1 && options.hair_length == 1);
  CHECK(isnan(options.face_squash) && options.face_curve == SDEF_FACE_CURVE_F4 && options.group_count == 0);
  CHECK(options.repair == SDEF_REPAIR_ON);
  CHECK(options.groups == NULL && options.bone_groups == NULL && options.bone_group_count == 0);
  CHECK(options.rig_weights == SDEF_WEIGHTS_AUTO && options.rig_garments == SDEF_GARMENTS_ROBUST);
  CHECK(options.rig_voxel_resolution == 128 && options.rig_fingers == 1 && options.rig_left_handed == 0);
  CHECK(options.rig_heat == 1 && options.rig_joints == NULL && options.rig_joint_count == 0);
}

static void a_character_gives_back_what_it_got(void) {
  SdefCharacter character = make_character(1);
  SdefCharacterInfo info = {0};
  info.struct_size = sizeof info;
  OK(sdef_character_get_info(character, &info, &error));
  CHECK(info.mesh_count == 1 && info.joint_count == FIGURE_PARTS && info.own_joint_count == FIGURE_PARTS);
  CHECK(info.morph_target_count == 1 && info.rig_made == 0);
  CHECK(info.vertex_count == FIGURE_VERTICES && info.triangle_count == FIGURE_INDICES / 3);

  int32_t parents[FIGURE_PARTS];
  uint32_t roles[FIGURE_PARTS];
  double rest[FIGURE_PARTS][16], confidence[FIGURE_PARTS];
  size_t joint_count = 0;
  OK(sdef_character_get_joints(character, parents, roles, rest[0], confidence, FIGURE_PARTS, &joint_count, &error));
  CHECK(joint_count == FIGURE_PARTS && memcmp(parents, figure.parents, sizeof parents) == 0);
  CHECK(memcmp(rest, figure.rest, sizeof rest) == 0);
  for (int joint = 0; joint < FIGURE_PARTS; joint++)
    CHECK(roles[joint] == figure_parts[joint].role && confidence[joint] == 1);

  static uint32_t joints[FIGURE_VERTICES][2];
  static float weights[FIGURE_VERTICES][2];
  OK(sdef_character_get_weights(character, 0, 2, joints[0], weights[0], FIGURE_VERTICES, &error));
  for (int vertex = 0; vertex < FIGURE_VERTICES; vertex++) {
    CHECK(joints[vertex][0] == figure.vertices[vertex].joint && weights[vertex][0] == 1);
    CHECK(joints[vertex][1] == 0 && weights[vertex][1] == 0);
  }
  OK(sdef_destroy(character.id, &error));
}

static void in_order(void *user, SdefTask task, void *data, uint32_t count) {
  for (uint32_t index = 0; index < count; index++) task(data, index);
  ++*(int *)user;
}

static void a_rig_is_made(void) {
  SdefCharacter character = make_character(0);
  SdefOptions options;
  OK(sdef_options_init(&options, sizeof options, &error));
  SdefGivenJoint known = {sizeof known, SDEF_ROLE_LEFT_LOWER_LEG, 0.1, 0.46, 0.0};
  options.rig_joints = &known;
  options.rig_joint_count = 1;
  options.rig_weights = SDEF_WEIGHTS_VOLUME;
  options.rig_voxel_resolution = 48;
  options.thread_count = 2;
  int calls = 0, jobs = 0;
  OK(sdef_set_jobs(in_order, &jobs, &error));
  OK(sdef_character_rig(character, &options, count_calls, &calls, &error));
  OK(sdef_set_jobs(NULL, NULL, &error));
  CHECK(calls > 0 && jobs > 0);
  SdefCharacterInfo info = {0};
  info.struct_size = sizeof info;
  OK(sdef_character_get_info(character, &info, &error));
  CHECK(info.rig_made == 1 && info.own_joint_count == 0 && info.joint_count >= 15);
  size_t size = 0;
  OK(sdef_get_warnings(character.id, NULL, 0, &size, &error));
  CHECK(size >= 1);
  char *text = (char *)malloc(size);
  OK(sdef_get_warnings(character.id, text, size, &size, &error));
  CHECK(strlen(text) + 1 == size);
  free(text);
  OK(sdef_destroy(character.id, &error));
}

static void styles(void) {
  SdefStyle none = {0}, heads = {0}, like = {0}, built_in = {0}, measured = {0}, made = {0}, blend = {0}, read = {0};
  OK(sdef_style_from_heads(3, none, &heads, &error));
  OK(sdef_style_from_text("sd2.5", 5, &built_in, &error));
  OK(sdef_style_from_heads(2.2, built_in, &like, &error));
  SdefCharacter character = make_character(1);
  OK(sdef_style_measure(character, "figure", NULL, &measured, &error));
  SdefStyleNumbers numbers = {0};
  numbers.struct_size = sizeof numbers;
  SdefBone bones[64];
  bones[0].struct_size = sizeof *bones;
  size_t bone_count = 0;
  OK(sdef_style_get_numbers(measured, &numbers, bones, 64, &bone_count, &error));
  CHECK(bone_count > 8 && bones[bone_count - 1].end == SDEF_BONE_HEAD_TOP);
  CHECK(numbers.heads > 4 && numbers.heads < 10 && fabs(numbers.crown - 1.75) < 0.02);
  OK(sdef_style_from_numbers("again", &numbers, bones, bone_count, &made, &error));
  OK(sdef_style_blend(built_in, made, 0.5, &blend, &error));
  size_t size = 0;
  OK(sdef_style_to_json(blend, NULL, 0, &size, &error));
  char *text = (char *)malloc(size);
  OK(sdef_style_to_json(blend, text, size, NULL, &error));
  OK(sdef_style_from_text(text, size - 1, &read, &error));
  SdefStyleNumbers blended = {0}, reread = {0};
  blended.struct_size = reread.struct_size = sizeof blended;
  OK(sdef_style_get_numbers(blend, &blended, NULL, 0, NULL, &error));
  OK(sdef_style_get_numbers(read, &reread, NULL, 0, NULL, &error));
  CHECK(blended.heads == reread.heads && blended.arm == reread.arm);
  free(text);
  const uint64_t ids[] = {heads.id, like.id, built_in.id, measured.id, made.id, blend.id, read.id, character.id};
  for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) OK(sdef_destroy(ids[i], &error));
}

static void a_deformer_is_applied(void) {
  SdefCharacter character = make_character(1);
  SdefStyle style = {0}, none = {0};
  SdefDeformer deformer = {0};
  int calls = 0;
  OK(sdef_style_from_heads(2.5, none, &style, &error));
  OK(sdef_deformer_create(character, style, NULL, count_calls, &calls, &deformer, &error));
  CHECK(calls > 0);
  OK(sdef_destroy(character.id, &error));
  OK(sdef_destroy(style.id, &error));

  static FigureVertex results[FIGURE_VERTICES];
  static float smiles[FIGURE_VERTICES][3];
  memset(results, 0, sizeof results);
  SdefMeshResult result = {0};
  result.struct_size = sizeof result;
  result.vertex_capacity = FIGURE_VERTICES;
  result.morph_target_capacity = 1;
  result.positions = results[0].position;
  result.normals = results[0].normal;
  result.tangents = results[0].tangent;
  result.position_stride = result.normal_stride = result.tangent_stride = sizeof(FigureVertex);
  result.morph_positions = smiles[0];
  OK(sdef_deformer_apply(deformer, &result, 1, count_calls, &calls, &error));
  for (int vertex = 0; vertex < FIGURE_VERTICES; vertex++) {
    const float *n = results[vertex].normal;
    CHECK(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-4f);
    CHECK(results[vertex].tangent[3] == 1 && results[vertex].joint == 0 && results[vertex].weight == 0);
  }
  SdefReport report = {0};
  report.struct_size = sizeof report;
  size_t size = 0;
  calls = 0;
  OK(sdef_deformer_measure(deformer, count_calls, &calls, &error));
  CHECK(calls > 3);
  OK(sdef_deformer_get_report(deformer, &report, NULL, 0, &size, &error));
  SdefFigure before = {0}, after = {0};
  before.struct_size = after.struct_size = sizeof before;
  OK(sdef_deformer_get_figure(deformer, SDEF_FIGURE_TARGET, &before, &error));
  OK(sdef_deformer_get_figure(deformer, SDEF_FIGURE_RESULT, &after, &error));
  CHECK(size > 100 && fabs(after.heads - 2.5) < 0.3 && before.heads > 5 && report.rig_made == 0);
  char *json = (char *)malloc(size + 4096);
  OK(sdef_deformer_get_report(deformer, NULL, json, size + 4096, &size, &error));
  CHECK(json[0] == '{' && strlen(json) + 1 == size);
  free(json);

  double joints[FIGURE_PARTS][3], binds[FIGURE_PARTS][16];
  size_t count = 0;
  OK(sdef_deformer_get_joints(deformer, joints[0], binds[0], FIGURE_PARTS, &count, &error));
  CHECK(count == FIGURE_PARTS && joints[3][1] < 1.5 && fabs(binds[3][13] + joints[3][1]) < 1e-12);

  // A joint is a point that moves with itself.
  uint32_t owners[FIGURE_PARTS];
  double points[FIGURE_PARTS][3], mapped[FIGURE_PARTS][3], scales[FIGURE_PARTS], jacobians[FIGURE_PARTS][9];
  for (uint32_t joint = 0; joint < FIGURE_PARTS; joint++) {
    owners[joint] = joint;
    memcpy(points[joint], &figure.rest[joint][12], sizeof points[joint]);
  }
  OK(sdef_deformer_map_points(deformer, owners, points[0], FIGURE_PARTS, mapped[0], scales, jacobians[0], &error));
  for (int joint = 0; joint < FIGURE_PARTS; joint++) CHECK(scales[joint] > 0.05 && scales[joint] < 20);

  // A capsule is as thick as the limb; a ball that it was clear of stays clear of it.
  const uint32_t guarded[] = {0};
  SdefSpringBall ball = {.struct_size = sizeof ball, .joint = 3, .y = figure.rest[3][13], .z = 0.6, .radius = 0.05};
  SdefCollider collider = {.struct_size = sizeof collider, .kind = SDEF_COLLIDER_CAPSULE, .joint = 3, .spring_count = 1,
                           .springs = guarded, .y = figure.rest[3][13], .end_y = figure.rest[3][13] + 0.1, .radius = 0.1};
  OK(sdef_deformer_map_colliders(deformer, &collider, 1, &ball, 1, &collider, &error));
  CHECK(fabs(collider.y - mapped[3][1]) < 1e-9 && collider.end_y > collider.y);
  CHECK(collider.radius > 0.01 && collider.radius < 1 && collider.newly_inside == 0 && collider.yielded <= 0.2);
  collider.kind = 9;
  CHECK(sdef_deformer_map_colliders(deformer, &collider, 1, &ball, 1, &collider, &error) == SDEF_STATUS_BAD_INPUT);
  CHECK(error.element_kind == SDEF_ELEMENT_COLLIDER && error.element == 0);

  SdefGroup groups[32];
  groups[0].struct_size = sizeof *groups;
  OK(sdef_deformer_get_groups(deformer, groups, 32, &count, &error));
  CHECK(count >= 6 && count <= 32);
  for (size_t group = 0; group < count; group++) CHECK(strlen(groups[group].name) > 0);

  SdefOptions options;
  OK(sdef_options_init(&options, sizeof options, &error));
  options.amount = 0;
  OK(sdef_deformer_set_options(deformer, &options, count_calls, &calls, &error));
  OK(sdef_deformer_apply(deformer, &result, 1, NULL, NULL, &error));
  for (int vertex = 0; vertex < FIGURE_VERTICES; vertex++)
    for (int i = 0; i < 3; i++)
      CHECK(fabsf(results[vertex].position[i] - figure.vertices[vertex].position[i]) < 1e-5f);
  OK(sdef_options_init(&options, sizeof options, &error));
  OK(sdef_deformer_set_options(deformer, &options, NULL, NULL, &error));
  OK(sdef_style_from_heads(4, (SdefStyle){0}, &style, &error));
  OK(sdef_deformer_set_style(deformer, style, count_calls, &calls, &error));
  OK(sdef_destroy(style.id, &error));
  OK(sdef_deformer_get_figure(deformer, SDEF_FIGURE_RESULT, &after, &error));
  CHECK(fabs(after.heads - 4) < 0.3);
  OK(sdef_destroy(deformer.id, &error));
}

static void all_at_once_is_the_same(void) {
  SdefStyle style = {0};
  OK(sdef_style_from_text("sd3", 3, &style, &error));
  static float one[FIGURE_VERTICES][3], two[FIGURE_VERTICES][3];
  SdefMeshResult result = {0};
  result.struct_size = sizeof result;
  result.vertex_capacity = FIGURE_VERTICES;
  result.positions = one[0];
  OK(sdef_super_deform(NULL, NULL, &figure.skeleton, &figure.mesh, 1, style, NULL, &result, NULL, NULL, &error));
  SdefCharacter character = make_character(1);
  SdefDeformer deformer = {0};
  OK(sdef_deformer_create(character, style, NULL, NULL, NULL, &deformer, &error));
  result.positions = two[0];
  OK(sdef_deformer_apply(deformer, &result, 1, NULL, NULL, &error));
  CHECK(memcmp(one, two, sizeof one) == 0);
  OK(sdef_destroy(deformer.id, &error));
  OK(sdef_destroy(character.id, &error));
  OK(sdef_destroy(style.id, &error));
}

int main(void) {
  figure_make(&figure);
  RUN(version_status_errors_handles);
  RUN(options);
  RUN(a_character_gives_back_what_it_got);
  RUN(a_rig_is_made);
  RUN(styles);
  RUN(a_deformer_is_applied);
  RUN(all_at_once_is_the_same);
  return REPORT();
}
