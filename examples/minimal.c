// A made-up figure of boxes becomes 2.5 heads tall.
// cc examples/minimal.c -Iinclude -Ltarget/release -lsuperdeform -o minimal && LD_LIBRARY_PATH=target/release ./minimal
#include "superdeform.h"
#include <stdio.h>

#define TRY(call) if ((call) != SDEF_STATUS_OK) return fprintf(stderr, "%s\n", error.message), 1

// Joint, parent and the box that hangs from it: lowest and highest corner.
static const struct { uint32_t role; int32_t parent; float joint[3], low[3], high[3]; } parts[] = {
  {SDEF_ROLE_HIPS,            -1, {0, 1, 0},       {-0.15f, 0.8f, -0.1f},   {0.15f, 1.45f, 0.1f}},
  {SDEF_ROLE_HEAD,             0, {0, 1.55f, 0},   {-0.1f, 1.5f, -0.1f},    {0.1f, 1.75f, 0.1f}},
  {SDEF_ROLE_LEFT_UPPER_ARM,   0, {0.2f, 1.4f, 0}, {0.15f, 1.35f, -0.05f},  {0.7f, 1.45f, 0.05f}},
  {SDEF_ROLE_RIGHT_UPPER_ARM,  0, {-0.2f, 1.4f, 0},{-0.7f, 1.35f, -0.05f},  {-0.15f, 1.45f, 0.05f}},
  {SDEF_ROLE_LEFT_UPPER_LEG,   0, {0.1f, 0.8f, 0}, {0.04f, 0, -0.07f},      {0.15f, 0.8f, 0.07f}},
  {SDEF_ROLE_RIGHT_UPPER_LEG,  0, {-0.1f, 0.8f, 0},{-0.15f, 0, -0.07f},     {-0.04f, 0.8f, 0.07f}},
};
enum { PARTS = 6, VERTICES = 8 * PARTS, INDICES = 36 * PARTS };
static const uint16_t box[36] = {0,2,3, 0,3,1, 4,5,7, 4,7,6, 0,1,5, 0,5,4, 2,6,7, 2,7,3, 0,4,6, 0,6,2, 1,3,7, 1,7,5};

int main(void) {
  float positions[VERTICES][3], weights[VERTICES];
  uint16_t indices[INDICES];
  uint8_t joints[VERTICES];
  int32_t parents[PARTS], role_joints[SDEF_ROLE_COUNT];
  double rest[PARTS][16] = {{0}};
  for (int role = 0; role < SDEF_ROLE_COUNT; role++) role_joints[role] = -1;
  for (int part = 0; part < PARTS; part++) {
    parents[part] = parts[part].parent;
    role_joints[parts[part].role] = part;
    for (int axis = 0; axis < 3; axis++) {
      rest[part][5 * axis] = 1;
      rest[part][12 + axis] = parts[part].joint[axis];
      for (int corner = 0; corner < 8; corner++)
        positions[8 * part + corner][axis] = (corner >> axis & 1 ? parts[part].high : parts[part].low)[axis];
    }
    rest[part][15] = 1;
    for (int corner = 0; corner < 8; corner++) joints[8 * part + corner] = (uint8_t)part, weights[8 * part + corner] = 1;
    for (int index = 0; index < 36; index++) indices[36 * part + index] = (uint16_t)(8 * part + box[index]);
  }

  SdefError error = SDEF_ERROR_INIT;
  SdefSkeleton skeleton = {0};
  skeleton.struct_size = sizeof skeleton;
  skeleton.joint_count = PARTS;
  skeleton.parents = parents;
  skeleton.rest_matrices = &rest[0][0];
  skeleton.role_joints = role_joints;
  skeleton.role_count = SDEF_ROLE_COUNT;
  SdefMesh mesh = {0};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = VERTICES;
  mesh.positions = &positions[0][0];
  mesh.indices = indices;
  mesh.index_type = SDEF_TYPE_U16;
  mesh.index_count = INDICES;
  mesh.influence_count = 1;
  mesh.joints = joints;
  mesh.joint_type = SDEF_TYPE_U8;
  mesh.weights = weights;

  SdefCharacter character;
  SdefStyle style, none = {0};
  SdefDeformer deformer;
  TRY(sdef_character_create(NULL, NULL, &character, &error));
  TRY(sdef_character_set_skeleton(character, &skeleton, &error));
  TRY(sdef_character_add_mesh(character, &mesh, NULL, &error));
  TRY(sdef_style_from_heads(2.5, none, &style, &error));
  TRY(sdef_deformer_create(character, style, NULL, NULL, NULL, &deformer, &error));

  SdefMeshResult result = {0};
  result.struct_size = sizeof result;
  result.vertex_capacity = VERTICES;
  result.positions = &positions[0][0];
  SdefReport report = {0};
  report.struct_size = sizeof report;
  TRY(sdef_deformer_apply(deformer, &result, 1, NULL, NULL, &error));
  TRY(sdef_deformer_get_report(deformer, &report, NULL, 0, NULL, &error));
  printf("%.2f heads before, %.2f after\n", report.target.heads, report.result.heads);
  TRY(sdef_destroy(deformer.id, &error));
  TRY(sdef_destroy(style.id, &error));
  TRY(sdef_destroy(character.id, &error));
  return sdef_live_handles() == 0 ? 0 : 1;
}
