// Too little memory is a status and never the end of the host: every call in a process of its own, which is allowed some
// more address space than it has, in steps. Prints how the calls ended.
#define _DEFAULT_SOURCE
#include "check.h"
#include "figure.h"
#include "superdeform.h"
#include <malloc.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

// Copies: enough vertices that threads are asked for.
enum { COPIES = 13, STEP_KB = 1536, STEPS = 27, ENDS = SDEF_STATUS_INTERNAL + 2, KILLED = ENDS - 1 };
static Figure figure;
static SdefError error = SDEF_ERROR_INIT;
static SdefCharacter rigged, bare;
static SdefStyle style;
static SdefDeformer deformer;
static SdefOptions options;
static float positions[COPIES][FIGURE_VERTICES][3], normals[COPIES][FIGURE_VERTICES][3];

static SdefStatus add_mesh(void) { return sdef_character_add_mesh(rigged, &figure.mesh, NULL, &error); }
static SdefStatus rig(void) { return sdef_character_rig(bare, &options, NULL, NULL, &error); }
static SdefStatus measure(void) {
  SdefStyle measured;
  return sdef_style_measure(rigged, "it", &options, &measured, &error);
}
static SdefStatus create(void) {
  SdefDeformer made;
  return sdef_deformer_create(rigged, style, &options, NULL, NULL, &made, &error);
}
static SdefStatus set_options(void) {
  SdefOptions other = options;
  other.head_scale = 1.2;
  return sdef_deformer_set_options(deformer, &other, NULL, NULL, &error);
}
static SdefStatus apply(void) {
  SdefMeshResult results[COPIES];
  memset(results, 0, sizeof results);
  for (int i = 0; i < COPIES; i++) {
    results[i].struct_size = sizeof *results;
    results[i].vertex_capacity = FIGURE_VERTICES;
    results[i].positions = positions[i][0];
    results[i].normals = normals[i][0];
  }
  return sdef_deformer_apply(deformer, results, COPIES, NULL, NULL, &error);
}
static SdefStatus get_report(void) {
  return sdef_deformer_get_report(deformer, NULL, NULL, 0, NULL, &error);
}

static long present(void) {
  long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (file == NULL || fscanf(file, "%ld", &pages) != 1) pages = 0;
  if (file != NULL) fclose(file);
  return pages * sysconf(_SC_PAGESIZE);
}

// How `call` ends with `more` bytes beside what is there now.
static int ends(SdefStatus (*call)(void), long more) {
  fflush(NULL);
  const pid_t child = fork();
  if (child == 0) {
    malloc_trim(0);
    struct rlimit limit = {0, 0};
    limit.rlim_cur = limit.rlim_max = (rlim_t)(present() + more);
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(KILLED);
    _exit((int)call());
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return KILLED;
  return WIFEXITED(status) && WEXITSTATUS(status) < ENDS ? WEXITSTATUS(status) : KILLED;
}

static void count_ends(void) {
  const struct {
    const char *name;
    SdefStatus (*call)(void);
  } calls[] = {{"add_mesh", add_mesh},       {"rig", rig},     {"style_measure", measure}, {"deformer_create", create},
               {"set_options", set_options}, {"apply", apply}, {"get_report", get_report}};
  printf("%-16s %8s %5s %14s %6s %6s\n", "call", "threads", "OK", "OUT_OF_MEMORY", "other", "killed");
  for (uint32_t threads = 1; threads <= 4; threads += 3) {
    options.thread_count = threads;
    // Starts none: it is about the calls that follow.
    OK(sdef_deformer_set_options(deformer, &options, NULL, NULL, &error));
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
      int counts[ENDS] = {0};
      for (int step = 1; step <= STEPS; step++) counts[ends(calls[i].call, (1024L + (step - 1) * STEP_KB) * 1024L)]++;
      const int ok = counts[SDEF_STATUS_OK], little = counts[SDEF_STATUS_OUT_OF_MEMORY], killed = counts[KILLED];
      printf("%-16s %8u %5d %14d %6d %6d\n", calls[i].name, threads, ok, little, STEPS - ok - little - killed, killed);
      CHECK(killed == 0 && ok + little == STEPS);
      // A GiB is enough for all.
      CHECK(ends(calls[i].call, 1L << 30) == SDEF_STATUS_OK);
    }
  }
}

static void too_little_memory_is_a_status(void) {
  OK(sdef_options_init(&options, sizeof options, &error));
  options.rig_voxel_resolution = 48;
  // Threads leave behind what the allocator reserved for them; the children have nothing of the kind.
  options.thread_count = 1;
  SdefStyle none = {0};
  OK(sdef_style_from_heads(2.5, none, &style, &error));
  OK(sdef_character_create(NULL, NULL, &rigged, &error));
  OK(sdef_character_create(NULL, NULL, &bare, &error));
  OK(sdef_character_set_skeleton(rigged, &figure.skeleton, &error));
  SdefMesh mesh = figure.mesh;
  mesh.influence_count = 0;
  mesh.joints = mesh.weights = NULL;
  mesh.joint_stride = mesh.weight_stride = 0;
  for (int i = 0; i < COPIES; i++) {
    OK(sdef_character_add_mesh(rigged, &figure.mesh, NULL, &error));
    OK(sdef_character_add_mesh(bare, &mesh, NULL, &error));
  }
  OK(sdef_deformer_create(rigged, style, &options, NULL, NULL, &deformer, &error));
  count_ends();
  const uint64_t ids[] = {deformer.id, style.id, rigged.id, bare.id};
  for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) OK(sdef_destroy(ids[i], &error));
}

int main(void) {
  // The allocator keeps nothing of what is given back, so that a step is what there is.
  mallopt(M_MMAP_THRESHOLD, 1 << 15);
  mallopt(M_TRIM_THRESHOLD, 1 << 15);
  figure_make(&figure);
  RUN(too_little_memory_is_a_status);
  return REPORT();
}
