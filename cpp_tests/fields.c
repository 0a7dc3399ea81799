// Fields that hardly any host sets, and which must still do what the header says: each is set here so that to ignore it
// shows.
#include "superdeform.h"
#include "check.h"
#include "figure.h"
#include <math.h>

static Figure figure;
static SdefError error = SDEF_ERROR_INIT;

// The figure of figure.h; its face looks along +Z.
static SdefCharacter make_character(void) {
  SdefCharacter character = {0};
  const float up[3] = {0, 1, 0}, forward[3] = {0, 0, 1};
  OK(sdef_character_create(up, forward, &character, &error));
  OK(sdef_character_set_skeleton(character, &figure.skeleton, &error));
  OK(sdef_character_add_mesh(character, &figure.mesh, NULL, &error));
  return character;
}

static SdefDeformer make_deformer(SdefCharacter character) {
  const SdefStyle none = {0};
  SdefStyle style = {0};
  SdefDeformer deformer = {0};
  OK(sdef_style_from_heads(2.5, none, &style, &error));
  OK(sdef_deformer_create(character, style, NULL, NULL, NULL, &deformer, &error));
  OK(sdef_destroy(style.id, &error));
  return deformer;
}

// Where along x the made rig has its left hand.
static double left_hand(SdefCharacter character, uint32_t left_handed) {
  enum { MOST = 200 };
  static uint32_t roles[MOST];
  static double rest[MOST][16];
  size_t count = 0;
  SdefOptions options;
  OK(sdef_options_init(&options, sizeof options, &error));
  options.rig_voxel_resolution = 32;
  options.rig_left_handed = left_handed;
  OK(sdef_character_rig(character, &options, NULL, NULL, &error));
  OK(sdef_character_get_joints(character, NULL, roles, rest[0], NULL, MOST, &count, &error));
  // Own joints have their roles no more; those of the rig come behind them.
  for (size_t joint = count; joint-- > FIGURE_PARTS;)
    if (roles[joint] == SDEF_ROLE_LEFT_HAND) return rest[joint][12];
  CHECK(!"the rig has a left hand");
  return 0;
}

// Up +Y, forward +Z: the left is at +X in right-handed axes, at -X in Unity's.
static void rig_left_handed_tells_left_from_right(void) {
  const SdefCharacter character = make_character();
  CHECK(left_hand(character, 0) > 0.3);
  CHECK(left_hand(character, 1) < -0.3);
  OK(sdef_destroy(character.id, &error));
}

// The changes of normals of a smile, with another number between any two of them.
static void normals_of_morph_targets_may_have_a_stride(void) {
  static float packed[FIGURE_VERTICES][3], apart[FIGURE_VERTICES][5], out[2][FIGURE_VERTICES][3];
  for (int vertex = 0; vertex < FIGURE_VERTICES; vertex++) {
    for (int i = 0; i < 3; i++) packed[vertex][i] = apart[vertex][i] = 0.01f * (float)((vertex + i) % 7);
    apart[vertex][3] = apart[vertex][4] = 100;
  }
  for (int with_stride = 0; with_stride < 2; with_stride++) {
    const SdefCharacter character = make_character();
    SdefMorphTarget target = figure.target;
    target.normals = with_stride ? apart[0] : packed[0];
    target.normal_stride = with_stride ? sizeof apart[0] : 0;
    OK(sdef_character_add_morph_target(character, 0, &target, &error));
    const SdefDeformer deformer = make_deformer(character);
    SdefMeshResult result = {0};
    result.struct_size = sizeof result;
    result.vertex_capacity = FIGURE_VERTICES;
    result.morph_target_capacity = 1;
    result.morph_normals = out[with_stride][0];
    OK(sdef_deformer_apply(deformer, &result, 1, NULL, NULL, &error));
    OK(sdef_destroy(deformer.id, &error));
    OK(sdef_destroy(character.id, &error));
  }
  CHECK(memcmp(out[0], out[1], sizeof out[0]) == 0);
  float largest = 0;
  for (int vertex = 0; vertex < FIGURE_VERTICES; vertex++)
    if (out[0][vertex][0] > largest) largest = out[0][vertex][0];
  CHECK(largest > 0.01f && largest < 1);
}

// A head around the figure's own, with eyes that a host tells and brows that are painted, which fall towards the nose.
enum { FINE = 96, HEAD_VERTICES = (FINE + 1) * (FINE + 1), HEAD_INDICES = 6 * FINE * FINE, PIXELS = 256 };
static const float head_middle[3] = {0, 1.64f, 0}, head_half[3] = {0.125f, 0.17f, 0.15f};

static const double left_eye[3] = {0.055, 1.62, 0.134};
static const SdefFaceHints eyes = {sizeof(SdefFaceHints), 0, left_eye, NULL, 0.02, 0.01};

static uint8_t paint(float x, float y) {
  const float aside = fabsf(x - head_middle[0]);
  return aside < 0.09f && fabsf(y - 1.65f - 0.35f * (aside - 0.05f)) < 0.007f ? 25 : 180;
}

typedef struct Head {
  float positions[HEAD_VERTICES][3];
  uint32_t indices[HEAD_INDICES];
  uint8_t joints[HEAD_VERTICES];
  uint8_t weights[HEAD_VERTICES];
  SdefMesh mesh;
} Head;
static Head head;

static void head_make(void) {
  uint32_t *index = head.indices;
  for (uint32_t row = 0; row <= FINE; row++)
    for (uint32_t column = 0; column <= FINE; column++) {
      const uint32_t vertex = row * (FINE + 1) + column;
      const double turn = 6.283185307179586 * column / FINE, lift = 3.141592653589793 * ((double)row / FINE - 0.5);
      const double direction[3] = {sin(turn) * cos(lift), sin(lift), cos(turn) * cos(lift)};
      for (int i = 0; i < 3; i++) head.positions[vertex][i] = head_middle[i] + head_half[i] * (float)direction[i];
      head.joints[vertex] = 3, head.weights[vertex] = 255;
      if (row == FINE || column == FINE) continue;
      const uint32_t above = vertex + FINE + 1, corners[6] = {vertex, vertex + 1, above + 1, vertex, above + 1, above};
      memcpy(index, corners, sizeof corners);
      index += 6;
    }
  SdefMesh *mesh = &head.mesh;
  mesh->struct_size = sizeof *mesh;
  mesh->kind = SDEF_MESH_BODY;
  mesh->name = "head";
  mesh->vertex_count = HEAD_VERTICES;
  mesh->positions = head.positions[0];
  mesh->indices = head.indices;
  mesh->index_count = HEAD_INDICES;
  mesh->influence_count = 1;
  mesh->joint_type = mesh->weight_type = SDEF_TYPE_U8;
  mesh->joints = head.joints;
  mesh->weights = head.weights;
}

// What the report of the figure with a head like that says of its face, and where the head's vertices go.
typedef struct Seen {
  char face[2000];
  float positions[HEAD_VERTICES][3];
} Seen;
static Seen bare, seen, other;

static int has_eyes(const Seen *of) { return strstr(of->face, "left_eye") != NULL; }
// Than without paint.
static int is_elsewhere(const Seen *of) { return memcmp(bare.positions, of->positions, sizeof bare.positions) != 0; }

static void see(const SdefMesh *mesh, const SdefImage *image, const SdefFaceHints *hints, Seen *into) {
  static float body[FIGURE_VERTICES][3];
  static char report[1 << 20];
  SdefMesh shown = *mesh;
  const SdefCharacter character = make_character();
  if (image) OK(sdef_character_add_image(character, image, &shown.image, &error));
  OK(sdef_character_add_mesh(character, &shown, NULL, &error));
  if (hints) OK(sdef_character_set_face_hints(character, hints, &error));
  const SdefDeformer deformer = make_deformer(character);
  SdefMeshResult results[2] = {{0}};
  results[0].struct_size = results[1].struct_size = sizeof results[0];
  results[0].positions = body[0], results[0].vertex_capacity = FIGURE_VERTICES;
  results[1].positions = into->positions[0], results[1].vertex_capacity = HEAD_VERTICES;
  OK(sdef_deformer_apply(deformer, results, 2, NULL, NULL, &error));
  OK(sdef_deformer_get_report(deformer, NULL, report, sizeof report, NULL, &error));
  // The target's: the first of the report.
  const char *from = strstr(report, "\"face\""), *to = from ? strstr(from, "\"result\"") : NULL;
  CHECK(to != NULL && (size_t)(to - from) < sizeof into->face);
  memset(into->face, 0, sizeof into->face);
  memcpy(into->face, from, (size_t)(to - from));
  OK(sdef_destroy(deformer.id, &error));
  OK(sdef_destroy(character.id, &error));
}

static void painted_brows_are_seen_through_any_stride(void) {
  see(&head.mesh, NULL, &eyes, &bare);
  CHECK(has_eyes(&bare));

  // A byte a vertex: packed, and with two that say the contrary between any two.
  static uint8_t packed[HEAD_VERTICES], apart[HEAD_VERTICES][3];
  for (int vertex = 0; vertex < HEAD_VERTICES; vertex++) {
    const float *at = head.positions[vertex];
    packed[vertex] = apart[vertex][0] = at[2] > 0 ? paint(at[0], at[1]) : 180;
    apart[vertex][1] = apart[vertex][2] = (uint8_t)(255 - packed[vertex]);
  }
  SdefMesh mesh = head.mesh;
  mesh.luminance = packed;
  see(&mesh, NULL, &eyes, &seen);
  CHECK(is_elsewhere(&seen));
  mesh.luminance = apart[0];
  mesh.luminance_stride = sizeof apart[0];
  see(&mesh, NULL, &eyes, &other);
  CHECK(memcmp(&seen, &other, sizeof other) == 0);

  // An image of front (its left half) and back, rows with a border that says the contrary; uvs with numbers between that
  // are none.
  static uint8_t image_packed[PIXELS][PIXELS], image_apart[PIXELS][PIXELS + 40];
  static float uvs_packed[HEAD_VERTICES][2], uvs_apart[HEAD_VERTICES][3];
  memset(image_apart, 100, sizeof image_apart);
  for (int row = 0; row < PIXELS; row++)
    for (int column = 0; column < PIXELS; column++) {
      const float x = head_half[0] * (4 * (column + 0.5f) / PIXELS - 1);
      const float y = head_middle[1] + head_half[1] * (2 * (row + 0.5f) / PIXELS - 1);
      image_packed[row][column] = image_apart[row][column] = column < PIXELS / 2 ? paint(x, y) : 180;
    }
  for (int vertex = 0; vertex < HEAD_VERTICES; vertex++) {
    const float *at = head.positions[vertex];
    const float across = 0.25f + 0.25f * at[0] / head_half[0];
    uvs_packed[vertex][0] = uvs_apart[vertex][0] = at[2] > 0 ? across : 1 - across;
    uvs_packed[vertex][1] = uvs_apart[vertex][1] = 0.5f + 0.5f * (at[1] - head_middle[1]) / head_half[1];
    uvs_apart[vertex][2] = NAN;
  }
  SdefImage image = {sizeof(SdefImage), PIXELS, PIXELS, 0, image_packed[0], 0};
  mesh = head.mesh;
  mesh.uvs = uvs_packed[0];
  see(&mesh, &image, &eyes, &seen);
  CHECK(is_elsewhere(&seen));
  mesh.uvs = uvs_apart[0];
  mesh.uv_stride = sizeof uvs_apart[0];
  see(&mesh, &image, &eyes, &other);
  CHECK(memcmp(&seen, &other, sizeof other) == 0);
  image.pixels = image_apart[0];
  image.row_stride = sizeof image_apart[0];
  see(&mesh, &image, &eyes, &other);
  CHECK(memcmp(&seen, &other, sizeof other) == 0);
}

static void a_hint_says_how_high_an_eye_is(void) {
  SdefFaceHints hints = eyes;
  see(&head.mesh, NULL, &hints, &seen);
  hints.half_height = 0.02;
  see(&head.mesh, NULL, &hints, &other);
  CHECK(has_eyes(&seen) && has_eyes(&other));
  CHECK(memcmp(seen.positions, other.positions, sizeof seen.positions) != 0);
  const SdefCharacter character = make_character();
  hints.half_height = -0.01;
  GIVES(SDEF_STATUS_BAD_INPUT, sdef_character_set_face_hints(character, &hints, &error));
  OK(sdef_destroy(character.id, &error));
}

// The end of a strand of hair just above a ball in the trunk: the neck shortens, so the ball yields, and says by how much.
static void a_collider_says_how_much_it_yields(void) {
  const SdefCharacter character = make_character();
  const SdefDeformer deformer = make_deformer(character);
  const uint32_t spring = 0;
  const SdefSpringBall ball = {sizeof(SdefSpringBall), 3, 0, 1.54, 0, 0.03};
  SdefCollider collider = {0}, alone;
  collider.struct_size = sizeof collider;
  collider.kind = SDEF_COLLIDER_SPHERE;
  collider.joint = 1;
  collider.y = 1.35;
  collider.radius = 0.14;
  alone = collider;
  collider.springs = &spring;
  collider.spring_count = 1;
  OK(sdef_deformer_map_colliders(deformer, &alone, 1, NULL, 0, &alone, &error));
  OK(sdef_deformer_map_colliders(deformer, &collider, 1, &ball, 1, &collider, &error));
  CHECK(alone.yielded == 0 && collider.yielded > 0.1 && collider.yielded <= 0.2);
  CHECK(fabs(collider.radius - (1 - collider.yielded) * alone.radius) < 1e-9);
  OK(sdef_destroy(deformer.id, &error));
  OK(sdef_destroy(character.id, &error));
}

// A host that was built with a later header, and a field of it that this library does not know.
static void what_a_newer_host_sets_is_refused(void) {
  struct {
    SdefOptions known;
    double more;
  } newer;
  const double unset[2] = {0, NAN};
  const SdefCharacter character = make_character();
  const SdefStyle none = {0};
  SdefStyle style = {0};
  OK(sdef_style_from_heads(2.5, none, &style, &error));
  OK(sdef_options_init(&newer.known, sizeof newer, &error));
  for (int i = 0; i < 2; i++) {
    SdefDeformer deformer = {0};
    newer.more = unset[i];
    OK(sdef_deformer_create(character, style, &newer.known, NULL, NULL, &deformer, &error));
    OK(sdef_destroy(deformer.id, &error));
  }
  newer.more = 0.5;
  SdefDeformer deformer = {0};
  GIVES(SDEF_STATUS_BAD_ARGUMENT, sdef_deformer_create(character, style, &newer.known, NULL, NULL, &deformer, &error));
  OK(sdef_destroy(style.id, &error));
  OK(sdef_destroy(character.id, &error));
}

int main(void) {
  figure_make(&figure);
  head_make();
  RUN(rig_left_handed_tells_left_from_right);
  RUN(normals_of_morph_targets_may_have_a_stride);
  RUN(painted_brows_are_seen_through_any_stride);
  RUN(a_hint_says_how_high_an_eye_is);
  RUN(a_collider_says_how_much_it_yields);
  RUN(what_a_newer_host_sets_is_refused);
  return REPORT();
}
