// What both bindings share: one mesh that becomes super-deformed, as an engine's resource holds it.
#ifndef DEFORMED_H
#define DEFORMED_H
#include "superdeform.h"
#include <stdlib.h>
#include <string.h>

typedef struct {
  SdefDeformer deformer;
  uint32_t vertex_count;
  // Of the last apply: three numbers a vertex. normals: NULL where the figure came without.
  float *positions, *normals;
} Deformed;

static void deformed_close(Deformed *deformed) {
  sdef_destroy(deformed->deformer.id, NULL);
  free(deformed->positions);
  free(deformed->normals);
  *deformed = (Deformed){{0}, 0, NULL, NULL};
}

// Takes a figure of triangles that stands along +Y, gives it a rig, and measures it. normals: one a vertex, or NULL.
// style_text: "sd2.5", or a saved style. Another figure that was open is closed; on an error none is open, and the
// sentence stands in error.
static SdefStatus deformed_open(Deformed *deformed, const float *positions, const float *normals, uint32_t vertex_count,
                                const int32_t *indices, size_t index_count, const char *style_text, SdefError *error) {
  SdefCharacter character = {0};
  SdefStyle style = {0};
  SdefMesh mesh = {0};
  deformed_close(deformed);
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = vertex_count;
  mesh.positions = positions;
  mesh.normals = normals;
  // A negative number of Godot's is far beyond the vertices: it is refused by its place.
  mesh.indices = (const uint32_t *)indices;
  mesh.index_count = index_count;
  SdefStatus status = sdef_style_from_text(style_text, strlen(style_text), &style, error);
  if (status == SDEF_STATUS_OK) status = sdef_character_create(NULL, NULL, &character, error);
  if (status == SDEF_STATUS_OK) status = sdef_character_add_mesh(character, &mesh, NULL, error);
  if (status == SDEF_STATUS_OK) status = sdef_character_rig(character, NULL, NULL, NULL, error);
  if (status == SDEF_STATUS_OK)
    status = sdef_deformer_create(character, style, NULL, NULL, NULL, &deformed->deformer, error);
  sdef_destroy(style.id, NULL);
  sdef_destroy(character.id, NULL);
  if (status != SDEF_STATUS_OK) return status;
  deformed->vertex_count = vertex_count;
  deformed->positions = (float *)calloc(vertex_count, 3 * sizeof(float));
  if (normals) deformed->normals = (float *)calloc(vertex_count, 3 * sizeof(float));
  if (deformed->positions && (deformed->normals || !normals)) return SDEF_STATUS_OK;
  deformed_close(deformed);
  return SDEF_STATUS_OUT_OF_MEMORY;
}

// amount: 0 is the figure as it was, 1 the style.
static SdefStatus deformed_apply(Deformed *deformed, double amount, SdefError *error) {
  SdefOptions options;
  SdefMeshResult result = {0};
  result.struct_size = sizeof result;
  result.vertex_capacity = deformed->vertex_count;
  result.positions = deformed->positions;
  result.normals = deformed->normals;
  SdefStatus status = sdef_options_init(&options, sizeof options, error);
  options.amount = amount;
  if (status == SDEF_STATUS_OK) status = sdef_deformer_set_options(deformed->deformer, &options, NULL, NULL, error);
  if (status == SDEF_STATUS_OK) status = sdef_deformer_apply(deformed->deformer, &result, 1, NULL, NULL, error);
  return status;
}
#endif
