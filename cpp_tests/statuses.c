// Every status that a host can produce, with the sentence that comes with it; printed, to be read.
#if defined(LITTLE_MEMORY)
#define _DEFAULT_SOURCE
#include <sys/resource.h>
#endif
#include "superdeform.h"
#include "check.h"
#include "figure.h"
#include <math.h>

static Figure figure;
static SdefError error = SDEF_ERROR_INIT;
static const char *sentences[SDEF_STATUS_INTERNAL + 1];
static char kept[SDEF_STATUS_INTERNAL + 1][sizeof error.message];
static SdefCharacter character;
static SdefStyle style;

// A call that gives a status other than OK, and a sentence.
#define FAILS(expected, call)                                                                                          \
  do {                                                                                                                 \
    GIVES(expected, call);                                                                                             \
    CHECK(error.status == (expected) && strlen(error.message) > 20);                                                   \
    sentences[expected] = strcpy(kept[expected], error.message);                                                       \
  } while (0)

static void begin(void) {
  OK(sdef_character_create(NULL, NULL, &character, &error));
  OK(sdef_character_set_skeleton(character, &figure.skeleton, &error));
  OK(sdef_character_add_mesh(character, &figure.mesh, NULL, &error));
  OK(sdef_style_from_text("sd3", 3, &style, &error));
  CHECK(error.status == SDEF_STATUS_OK && error.message[0] == 0);
  sentences[SDEF_STATUS_OK] = "(none)";
}

static void end(void) {
  OK(sdef_destroy(character.id, &error));
  OK(sdef_destroy(style.id, &error));
}

static void mistakes_of_the_caller(void) {
  begin();
  SdefMesh mesh = figure.mesh;
  mesh.positions = NULL;
  FAILS(SDEF_STATUS_BAD_ARGUMENT, sdef_character_add_mesh(character, &mesh, NULL, &error));
  SdefSkeleton skeleton = figure.skeleton;
  skeleton.rest_matrices = NULL;
  FAILS(SDEF_STATUS_BAD_ARGUMENT, sdef_character_set_skeleton(character, &skeleton, &error));
  CHECK(strstr(error.message, "rest_matrices") != NULL);
  // Structs of one array have one size, whatever it is.
  SdefOptions options;
  SdefGroupSettings groups[2] = {SDEF_GROUP_SETTINGS_INIT, SDEF_GROUP_SETTINGS_INIT};
  OK(sdef_options_init(&options, sizeof options, &error));
  groups[0].group = "torso", groups[1].group = "head", groups[1].struct_size += 8;
  options.groups = groups, options.group_count = 2;
  SdefDeformer none;
  FAILS(SDEF_STATUS_BAD_ARGUMENT, sdef_deformer_create(character, style, &options, NULL, NULL, &none, &error));
  const SdefStyle gone = style;
  OK(sdef_style_from_text("sd2", 3, &style, &error));
  OK(sdef_destroy(gone.id, &error));
  FAILS(SDEF_STATUS_BAD_HANDLE, sdef_destroy(gone.id, &error));
  size_t count = 0;
  double places[3];
  SdefDeformer deformer;
  OK(sdef_deformer_create(character, style, NULL, NULL, NULL, &deformer, &error));
  FAILS(SDEF_STATUS_BUFFER_TOO_SMALL, sdef_deformer_get_joints(deformer, places, NULL, 1, &count, &error));
  CHECK(count == FIGURE_PARTS);
  OK(sdef_destroy(deformer.id, &error));
  end();
}

static void numbers_that_cannot_be(void) {
  begin();
  SdefMesh mesh = figure.mesh;
  uint16_t indices[3] = {0, 1, FIGURE_VERTICES};
  mesh.indices = indices;
  mesh.index_count = 3;
  FAILS(SDEF_STATUS_BAD_INPUT, sdef_character_add_mesh(character, &mesh, NULL, &error));
  CHECK(error.mesh == 1 && error.element == 0);
  SdefOptions options;
  SdefDeformer deformer = {0};
  OK(sdef_options_init(&options, sizeof options, &error));
  options.head_scale = NAN;
  FAILS(SDEF_STATUS_BAD_OPTION, sdef_deformer_create(character, style, &options, NULL, NULL, &deformer, &error));
  SdefStyle other = {0};
  FAILS(SDEF_STATUS_BAD_STYLE, sdef_style_from_text("sd9", 3, &other, &error));
  CHECK(deformer.id == 0 && other.id == 0);
  end();
}

static void characters_that_lack_something(void) {
  begin();
  SdefCharacter empty;
  SdefDeformer deformer = {0};
  OK(sdef_character_create(NULL, NULL, &empty, &error));
  FAILS(SDEF_STATUS_NO_GEOMETRY, sdef_character_rig(empty, NULL, NULL, NULL, &error));
  FAILS(SDEF_STATUS_NO_HUMANOID, sdef_deformer_create(empty, style, NULL, NULL, NULL, &deformer, &error));
  CHECK(deformer.id == 0);
  OK(sdef_destroy(empty.id, &error));
  end();
}

static int32_t stop(void *user, float fraction) {
  (void)user;
  return fraction >= 0;
}

static int32_t meddle(void *user, float fraction) {
  (void)fraction;
  FAILS(SDEF_STATUS_BUSY, sdef_deformer_set_options(*(SdefDeformer *)user, NULL, NULL, NULL, &error));
  return 0;
}

static void callbacks_that_stop_or_meddle(void) {
  begin();
  SdefDeformer deformer = {0};
  FAILS(SDEF_STATUS_CANCELLED, sdef_deformer_create(character, style, NULL, stop, NULL, &deformer, &error));
  CHECK(deformer.id == 0);
  OK(sdef_deformer_create(character, style, NULL, NULL, NULL, &deformer, &error));
  static float positions[FIGURE_VERTICES][3];
  SdefMeshResult result = {0};
  result.struct_size = sizeof result;
  result.vertex_capacity = FIGURE_VERTICES;
  result.positions = positions[0];
  OK(sdef_deformer_apply(deformer, &result, 1, meddle, &deformer, NULL));
  OK(sdef_destroy(deformer.id, &error));
  end();
}

#if defined(LITTLE_MEMORY)
// Zeros that the system has promised and not yet given; then it promises no more.
static void memory_that_cannot_be_had(void) {
  const size_t count = 60000000;
  float *positions = (float *)calloc(3 * count, sizeof *positions);
  CHECK(positions != NULL);
  if (positions == NULL) return;
  begin();
  struct rlimit before, little;
  CHECK(getrlimit(RLIMIT_AS, &before) == 0);
  little = before;
  little.rlim_cur = 3 * count * sizeof *positions + ((rlim_t)512 << 20);
  CHECK(setrlimit(RLIMIT_AS, &little) == 0);
  SdefMesh mesh = {0};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = count;
  mesh.positions = positions;
  FAILS(SDEF_STATUS_OUT_OF_MEMORY, sdef_character_add_mesh(character, &mesh, NULL, &error));
  // The host goes on with what there is.
  OK(sdef_character_add_mesh(character, &figure.mesh, NULL, &error));
  CHECK(setrlimit(RLIMIT_AS, &before) == 0);
  end();
  free(positions);
}
#endif

int main(void) {
  figure_make(&figure);
  RUN(mistakes_of_the_caller);
  RUN(numbers_that_cannot_be);
  RUN(characters_that_lack_something);
  RUN(callbacks_that_stop_or_meddle);
#if defined(LITTLE_MEMORY)
  RUN(memory_that_cannot_be_had);
#else
  printf("skipped memory_that_cannot_be_had: not under sanitizers or another runner, nor without setrlimit\n");
#endif
  for (uint32_t status = 0; status <= SDEF_STATUS_INTERNAL; status++) {
    const char *sentence = sentences[status];
    if (status == SDEF_STATUS_INTERNAL) {
      // No input is known that does it; the library's own tests let a call panic.
      CHECK(sentence == NULL);
      sentence = "(a fault of the library: no host can ask for one)";
    }
#if !defined(LITTLE_MEMORY)
    if (status == SDEF_STATUS_OUT_OF_MEMORY) sentence = "(skipped)";
#endif
    CHECK(sentence != NULL);
    printf("%-30s %s\n", sdef_status_name(status), sentence ? sentence : "NEVER SEEN");
  }
  return REPORT();
}
