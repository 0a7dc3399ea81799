// Makes a character of triangles super-deformed, 2.5 heads tall: minimal <IN.obj >OUT.obj
// IN stands along +Y with its arms out; of its lines "v x y z" and "f a b c" are read. A rig is made for it.
#include "superdeform.h"
#include <stdio.h>

#define TRY(call) if ((call) != SDEF_STATUS_OK) return fprintf(stderr, "%s\n", error.message), 1
enum { MOST = 200000 };

int main(void) {
  static float points[MOST][3];
  static uint32_t triangles[MOST][3];
  uint32_t vertex_count = 0, triangle_count = 0;
  for (char line[256]; fgets(line, sizeof line, stdin);) {
    float *p = points[vertex_count];
    uint32_t *t = triangles[triangle_count];
    if (sscanf(line, "v %f %f %f", &p[0], &p[1], &p[2]) == 3) vertex_count++;
    if (sscanf(line, "f %u %u %u", &t[0], &t[1], &t[2]) == 3) t[0]--, t[1]--, t[2]--, triangle_count++;
    if (vertex_count == MOST || triangle_count == MOST) return fprintf(stderr, "too large: raise MOST\n"), 1;
  }
  SdefMesh mesh = {.struct_size = sizeof mesh, .vertex_count = vertex_count, .positions = points[0],
                   .indices = triangles[0], .index_count = 3 * (size_t)triangle_count};
  SdefMeshResult result = {.struct_size = sizeof result, .vertex_capacity = vertex_count, .positions = points[0]};
  SdefStyle style;
  SdefError error = SDEF_ERROR_INIT;
  TRY(sdef_style_from_text("sd2.5", 5, &style, &error));
  TRY(sdef_super_deform(NULL, NULL, NULL, &mesh, 1, style, NULL, &result, NULL, NULL, &error));
  TRY(sdef_destroy(style.id, &error));
  for (uint32_t i = 0; i < vertex_count; i++) printf("v %.9g %.9g %.9g\n", points[i][0], points[i][1], points[i][2]);
  for (uint32_t i = 0; i < triangle_count; i++)
    printf("f %u %u %u\n", triangles[i][0] + 1, triangles[i][1] + 1, triangles[i][2] + 1);
  return sdef_live_handles() == 0 ? 0 : 1;
}
