// A slider that re-applies a deformer while it moves, and a hat that goes along: on a character with joints of its own,
// and on one whose rig is made.
#include "superdeform.h"
#include "check.h"
#include "figure.h"
#include <math.h>

enum { STEPS = 5, HEAD = 3 };

static Figure figure;
static SdefError error = SDEF_ERROR_INIT;

static int32_t rises(void *user, float fraction) {
  float *last = (float *)user;
  CHECK(fraction >= *last && fraction <= 1);
  *last = fraction;
  return 0;
}

static SdefCharacter make_character(int make_rig) {
  SdefCharacter character;
  SdefMesh mesh = figure.mesh;
  OK(sdef_character_create(NULL, NULL, &character, &error));
  if (make_rig) {
    mesh.influence_count = 0;
    mesh.joints = mesh.weights = NULL;
    mesh.joint_stride = mesh.weight_stride = 0;
  } else {
    OK(sdef_character_set_skeleton(character, &figure.skeleton, &error));
  }
  OK(sdef_character_add_mesh(character, &mesh, NULL, &error));
  OK(sdef_character_add_morph_target(character, 0, &figure.target, &error));
  if (make_rig) {
    float last = 0;
    OK(sdef_character_rig(character, NULL, rises, &last, &error));
    CHECK(last == 1);
  }
  return character;
}

// The joint that plays the head.
static uint32_t head_of(SdefCharacter character) {
  uint32_t roles[128];
  size_t count = 0;
  OK(sdef_character_get_joints(character, NULL, roles, NULL, NULL, 128, &count, &error));
  for (uint32_t joint = 0; joint < count; joint++)
    if (roles[joint] == SDEF_ROLE_HEAD) return joint;
  CHECK(!"a joint has the role of the head");
  return 0;
}

static void slide(int make_rig) {
  SdefCharacter character = make_character(make_rig);
  const uint32_t head = head_of(character);
  SdefStyle style, none = {0};
  SdefDeformer deformer;
  SdefOptions options;
  OK(sdef_options_init(&options, sizeof options, &error));
  // A face bends; without, the head is one body that things hang from.
  options.face_squash = 0;
  OK(sdef_style_from_heads(2.5, none, &style, &error));
  float last = 0;
  OK(sdef_deformer_create(character, style, &options, rises, &last, &deformer, &error));
  CHECK(last == 1);

  static float positions[FIGURE_VERTICES][3], smile[FIGURE_VERTICES][3];
  SdefMeshResult result = {0};
  result.struct_size = sizeof result;
  result.vertex_capacity = FIGURE_VERTICES;
  result.positions = positions[0];
  result.morph_positions = smile[0];
  result.morph_target_capacity = 1;
  // The crown, the last vertex of the head: a hat sits there.
  const int crown = (HEAD + 1) * FIGURE_PART_VERTICES - 1;
  double hat[3];
  for (int i = 0; i < 3; i++) hat[i] = figure.vertices[crown].position[i];
  float height = 0;
  double size = 0;
  for (int step = 0; step < STEPS; step++) {
    options.amount = (double)step / (STEPS - 1);
    OK(sdef_deformer_set_options(deformer, &options, NULL, NULL, &error));
    OK(sdef_deformer_apply(deformer, &result, 1, NULL, NULL, &error));
    double moved[3], scale;
    OK(sdef_deformer_map_points(deformer, &head, hat, 1, moved, &scale, NULL, &error));
    for (int i = 0; i < 3; i++) CHECK(fabs(moved[i] - positions[crown][i]) < 1e-5);
    if (step == 0) {
      for (int vertex = 0; vertex < FIGURE_VERTICES; vertex++)
        for (int i = 0; i < 3; i++) CHECK(positions[vertex][i] == figure.vertices[vertex].position[i]);
      CHECK(memcmp(smile, figure.smile, sizeof smile) == 0 && scale == 1);
    } else {
      CHECK(positions[crown][1] < height && scale > size);
      // A smile grows with the head.
      CHECK(fabs(smile[crown][2] - scale * figure.smile[crown][2]) < 0.002);
    }
    height = positions[crown][1];
    size = scale;
  }
  SdefReport report = {0};
  report.struct_size = sizeof report;
  OK(sdef_deformer_get_report(deformer, &report, NULL, 0, NULL, &error));
  SdefFigure before = {0}, after = {0};
  before.struct_size = after.struct_size = sizeof before;
  OK(sdef_deformer_get_figure(deformer, SDEF_FIGURE_TARGET, &before, &error));
  OK(sdef_deformer_get_figure(deformer, SDEF_FIGURE_RESULT, &after, &error));
  CHECK(before.heads > 5 && fabs(after.heads - 2.5) < 0.1 && report.rig_made == (uint32_t)make_rig);
  OK(sdef_destroy(deformer.id, &error));
  OK(sdef_destroy(style.id, &error));
  OK(sdef_destroy(character.id, &error));
}

static void with_joints_of_its_own(void) { slide(0); }
static void with_a_made_rig(void) { slide(1); }

int main(void) {
  figure_make(&figure);
  RUN(with_joints_of_its_own);
  RUN(with_a_made_rig);
  return REPORT();
}
