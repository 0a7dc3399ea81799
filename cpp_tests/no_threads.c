// A system that starts no more threads (limits of containers, sandboxes): the work is done all the same, with the same
// bits. This program's pthread_create takes the place of the system's.
#include "check.h"
#include "figure.h"
#include "superdeform.h"
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static Figure figure;
static SdefError error = SDEF_ERROR_INIT;
static int refused = 0;

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *user) {
  (void)thread, (void)attributes, (void)start, (void)user;
  refused++;
  return EAGAIN;
}

// Enough vertices that the library asks for threads: many figures side by side.
enum { COPIES = 8, VERTICES = COPIES * FIGURE_VERTICES };

static void deform(uint32_t thread_count, float *positions) {
  SdefCharacter character = {0};
  SdefStyle style = {0}, none = {0};
  SdefDeformer deformer = {0};
  SdefOptions options;
  OK(sdef_options_init(&options, sizeof options, &error));
  options.thread_count = thread_count;
  options.rig_voxel_resolution = 48;
  OK(sdef_character_create(NULL, NULL, &character, &error));
  SdefMeshResult results[COPIES];
  memset(results, 0, sizeof results);
  SdefMesh mesh = figure.mesh;
  mesh.influence_count = 0;
  mesh.joints = mesh.weights = NULL;
  mesh.joint_stride = mesh.weight_stride = 0;
  for (int i = 0; i < COPIES; i++) {
    OK(sdef_character_add_mesh(character, &mesh, NULL, &error));
    results[i].struct_size = sizeof *results;
    results[i].vertex_capacity = FIGURE_VERTICES;
    results[i].positions = positions + 3 * FIGURE_VERTICES * i;
  }
  OK(sdef_character_rig(character, &options, NULL, NULL, &error));
  OK(sdef_style_from_heads(2.5, none, &style, &error));
  OK(sdef_deformer_create(character, style, &options, NULL, NULL, &deformer, &error));
  OK(sdef_deformer_apply(deformer, results, COPIES, NULL, NULL, &error));
  OK(sdef_destroy(deformer.id, &error));
  OK(sdef_destroy(style.id, &error));
  OK(sdef_destroy(character.id, &error));
}

static void without_threads_the_bits_are_the_same(void) {
  float *alone = (float *)calloc(3 * VERTICES, sizeof *alone), *refusing = (float *)calloc(3 * VERTICES, sizeof *alone);
  deform(1, alone);
  CHECK(refused == 0);
  deform(4, refusing);
  CHECK(refused > 0);
  CHECK(memcmp(alone, refusing, 3 * VERTICES * sizeof *alone) == 0);
  free(alone);
  free(refusing);
}

// A job system of one thread, which does what it is given last first.
static int tasks = 0;

static void run_backwards(void *user, SdefTask task, void *data, uint32_t count) {
  CHECK(user == &tasks && count > 1);
  for (uint32_t index = count; index > 0; index--) task(data, index - 1), tasks++;
}

static void a_job_system_does_the_work_in_place_of_threads(void) {
  float *alone = (float *)calloc(3 * VERTICES, sizeof *alone), *jobs = (float *)calloc(3 * VERTICES, sizeof *alone);
  deform(1, alone);
  refused = 0;
  OK(sdef_set_jobs(run_backwards, &tasks, &error));
  deform(4, jobs);
  CHECK(refused == 0 && tasks > 20);
  CHECK(memcmp(alone, jobs, 3 * VERTICES * sizeof *alone) == 0);
  OK(sdef_set_jobs(NULL, NULL, &error));
  deform(4, jobs);
  CHECK(refused > 0);
  free(alone);
  free(jobs);
}

int main(void) {
  figure_make(&figure);
  RUN(without_threads_the_bits_are_the_same);
  RUN(a_job_system_does_the_work_in_place_of_threads);
  return REPORT();
}
