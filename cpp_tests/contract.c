// What arrays and results promise beyond their numbers: where they end, how they lie, and when they are new.
#include "superdeform.h"
#include "check.h"
#include "figure.h"
#include <math.h>

static Figure figure;
static SdefError error = SDEF_ERROR_INIT;
static SdefCharacter character;
static SdefStyle style;
static SdefDeformer deformer;

static void begin(void) {
  const SdefStyle none = {0};
  OK(sdef_character_create(NULL, NULL, &character, &error));
  OK(sdef_character_set_skeleton(character, &figure.skeleton, &error));
  OK(sdef_character_add_mesh(character, &figure.mesh, NULL, &error));
  OK(sdef_character_add_morph_target(character, 0, &figure.target, &error));
  // A second target, twice the first.
  static float wide[FIGURE_VERTICES][3];
  for (int vertex = 0; vertex < FIGURE_VERTICES; vertex++)
    for (int i = 0; i < 3; i++) wide[vertex][i] = 2 * figure.smile[vertex][i];
  SdefMorphTarget target = figure.target;
  target.name = "wide smile";
  target.positions = wide[0];
  OK(sdef_character_add_morph_target(character, 0, &target, &error));
  OK(sdef_style_from_heads(2.5, none, &style, &error));
  OK(sdef_deformer_create(character, style, NULL, NULL, NULL, &deformer, &error));
}

static void end(void) {
  OK(sdef_destroy(deformer.id, &error));
  OK(sdef_destroy(style.id, &error));
  OK(sdef_destroy(character.id, &error));
}

static void text_ends_within_its_capacity(void) {
  SdefStyle built_in;
  OK(sdef_style_from_text("sd3", 3, &built_in, &error));
  size_t size = 0, needed = 0;
  OK(sdef_style_to_json(built_in, NULL, 0, &size, &error));
  CHECK(size > 1);
  char *text = (char *)malloc(size + 1);
  memset(text, 'x', size + 1);
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL, sdef_style_to_json(built_in, text, size - 1, &needed, &error));
  CHECK(needed == size && text[size - 1] == 'x' && text[size] == 'x');
  OK(sdef_style_to_json(built_in, text, size, &needed, &error));
  CHECK(needed == size && strlen(text) + 1 == size && text[size] == 'x');
  free(text);
  OK(sdef_destroy(built_in.id, &error));
}

static void a_jacobian_is_the_slope_of_the_map(void) {
  begin();
  // Points along an arm, and points a little further along each axis; a map that turns or shears tells rows and columns.
  const double step = 1e-5;
  const uint32_t owners[4] = {5, 5, 5, 5};
  double points[4][3], mapped[4][3], jacobians[4][9];
  int skewed = 0;
  for (int place = 0; place < 20; place++) {
    for (int point = 0; point < 4; point++) {
      points[point][0] = 0.17 + 0.03 * place;
      points[point][1] = 1.36 + 0.003 * place;
      points[point][2] = 0.02;
      if (point > 0) points[point][point - 1] += step;
    }
    OK(sdef_deformer_map_points(deformer, owners, points[0], 4, mapped[0], NULL, jacobians[0], &error));
    for (int column = 0; column < 3; column++)
      for (int row = 0; row < 3; row++) {
        const double slope = (mapped[column + 1][row] - mapped[0][row]) / step;
        CHECK(fabs(slope - jacobians[0][3 * column + row]) < 1e-3);
        skewed += fabs(jacobians[0][3 * column + row] - jacobians[0][3 * row + column]) > 0.01;
      }
  }
  CHECK(skewed > 0); // else the transposed would pass
  end();
}

static double heads_of_result(void) {
  SdefFigure after = {0};
  after.struct_size = sizeof after;
  OK(sdef_deformer_get_figure(deformer, SDEF_FIGURE_RESULT, &after, &error));
  return after.heads;
}

static void a_report_is_of_the_options_that_are_set(void) {
  begin();
  SdefOptions options;
  OK(sdef_options_init(&options, sizeof options, &error));
  const double all = heads_of_result();
  options.amount = 0;
  OK(sdef_deformer_set_options(deformer, &options, NULL, NULL, &error));
  const double none = heads_of_result();
  CHECK(all < 3 && none > 5);
  end();
}

static void a_rig_is_of_the_meshes_that_are_there(void) {
  begin();
  SdefCharacterInfo info = {0};
  info.struct_size = sizeof info;
  SdefOptions options;
  OK(sdef_options_init(&options, sizeof options, &error));
  options.rig_voxel_resolution = 32;
  OK(sdef_character_rig(character, &options, NULL, NULL, &error));
  OK(sdef_character_get_info(character, &info, &error));
  CHECK(info.rig_made == 1 && info.joint_count > info.own_joint_count);
  OK(sdef_character_add_mesh(character, &figure.mesh, NULL, &error));
  OK(sdef_character_get_info(character, &info, &error));
  CHECK(info.rig_made == 0 && info.joint_count == info.own_joint_count);
  end();
}

static void morph_targets_lie_one_after_the_other_whatever_the_capacity(void) {
  begin();
  enum { ROOM = FIGURE_VERTICES + 100 };
  static float positions[ROOM][3], morphs[2 * ROOM][3];
  for (int i = 0; i < 2 * ROOM; i++) morphs[i][2] = 77;
  SdefMeshResult result = {0};
  result.struct_size = sizeof result;
  result.vertex_capacity = ROOM;
  result.morph_target_capacity = 2;
  result.positions = positions[0];
  result.morph_positions = morphs[0];
  OK(sdef_deformer_apply(deformer, &result, 1, NULL, NULL, &error));
  // The crown, the last vertex of the head, smiles most.
  const int crown = 4 * FIGURE_PART_VERTICES - 1;
  CHECK(morphs[crown][2] > 0 && morphs[FIGURE_VERTICES + crown][2] > 1.5f * morphs[crown][2]);
  CHECK(morphs[2 * FIGURE_VERTICES - 1][2] != 77 && morphs[2 * FIGURE_VERTICES][2] == 77);
  end();
}

int main(void) {
  figure_make(&figure);
  RUN(text_ends_within_its_capacity);
  RUN(a_jacobian_is_the_slope_of_the_map);
  RUN(a_report_is_of_the_options_that_are_set);
  RUN(a_rig_is_of_the_meshes_that_are_there);
  RUN(morph_targets_lie_one_after_the_other_whatever_the_capacity);
  return REPORT();
}
