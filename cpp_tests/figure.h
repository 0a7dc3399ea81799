// A figure of tapered boxes with joints, in arms-out pose, about 1.75 high: what tests deform. C99 and C++.
#ifndef FIGURE_H
#define FIGURE_H

#include "superdeform.h"
#include <string.h>

enum {
  FIGURE_PARTS = 15,
  FIGURE_RINGS = 7,
  FIGURE_SIDES = 12,
  FIGURE_PART_VERTICES = FIGURE_RINGS * FIGURE_SIDES + 2,
  FIGURE_VERTICES = FIGURE_PARTS * FIGURE_PART_VERTICES,
  FIGURE_PART_INDICES = 6 * FIGURE_SIDES * FIGURE_RINGS,
  FIGURE_INDICES = FIGURE_PARTS * FIGURE_PART_INDICES
};

// An interleaved vertex, as hosts have them: nothing is packed.
typedef struct FigureVertex {
  float position[3];
  uint8_t joint;
  uint8_t padding[3];
  float normal[3];
  float tangent[4];
  float weight;
} FigureVertex;

typedef struct Figure {
  FigureVertex vertices[FIGURE_VERTICES];
  float smile[FIGURE_VERTICES][3]; // a morph target
  uint16_t indices[FIGURE_INDICES];
  const char *names[FIGURE_PARTS];
  int32_t parents[FIGURE_PARTS];
  double rest[FIGURE_PARTS][16];
  int32_t role_joints[SDEF_ROLE_COUNT];
  SdefSkeleton skeleton;
  SdefMesh mesh;
  SdefMorphTarget target;
} Figure;

typedef struct FigurePart {
  uint32_t role;
  int32_t parent;
  const char *name;
  float from[3], to[3]; // a tube between two points
  float radius;
} FigurePart;

static const FigurePart figure_parts[FIGURE_PARTS] = {
    {SDEF_ROLE_HIPS, -1, "hips", {0, 0.85f, 0}, {0, 1.1f, 0}, 0.15f},
    {SDEF_ROLE_SPINE, 0, "spine", {0, 1.1f, 0}, {0, 1.42f, 0}, 0.16f},
    {SDEF_ROLE_NECK, 1, "neck", {0, 1.42f, 0}, {0, 1.5f, 0}, 0.05f},
    {SDEF_ROLE_HEAD, 2, "head", {0, 1.5f, 0}, {0, 1.75f, 0}, 0.11f},
    {SDEF_ROLE_LEFT_UPPER_ARM, 1, "leftUpperArm", {0.18f, 1.38f, 0}, {0.45f, 1.38f, 0}, 0.05f},
    {SDEF_ROLE_LEFT_LOWER_ARM, 4, "leftLowerArm", {0.45f, 1.38f, 0}, {0.7f, 1.38f, 0}, 0.04f},
    {SDEF_ROLE_LEFT_HAND, 5, "leftHand", {0.7f, 1.38f, 0}, {0.86f, 1.38f, 0}, 0.04f},
    {SDEF_ROLE_RIGHT_UPPER_ARM, 1, "rightUpperArm", {-0.18f, 1.38f, 0}, {-0.45f, 1.38f, 0}, 0.05f},
    {SDEF_ROLE_RIGHT_LOWER_ARM, 7, "rightLowerArm", {-0.45f, 1.38f, 0}, {-0.7f, 1.38f, 0}, 0.04f},
    {SDEF_ROLE_RIGHT_HAND, 8, "rightHand", {-0.7f, 1.38f, 0}, {-0.86f, 1.38f, 0}, 0.04f},
    {SDEF_ROLE_LEFT_UPPER_LEG, 0, "leftUpperLeg", {0.1f, 0.85f, 0}, {0.1f, 0.46f, 0}, 0.08f},
    {SDEF_ROLE_LEFT_LOWER_LEG, 10, "leftLowerLeg", {0.1f, 0.46f, 0}, {0.1f, 0.08f, 0}, 0.06f},
    {SDEF_ROLE_LEFT_FOOT, 11, "leftFoot", {0.1f, 0.06f, -0.04f}, {0.1f, 0.04f, 0.18f}, 0.04f},
    {SDEF_ROLE_RIGHT_UPPER_LEG, 0, "rightUpperLeg", {-0.1f, 0.85f, 0}, {-0.1f, 0.46f, 0}, 0.08f},
    // The right foot belongs to the lower leg, so that not every role is there.
    {SDEF_ROLE_RIGHT_LOWER_LEG, 13, "rightLowerLeg", {-0.1f, 0.46f, 0}, {-0.1f, 0.04f, 0.02f}, 0.06f},
};

static const float figure_circle[FIGURE_SIDES][2] = {
    {1, 0}, {0.866f, 0.5f}, {0.5f, 0.866f}, {0, 1}, {-0.5f, 0.866f}, {-0.866f, 0.5f},
    {-1, 0}, {-0.866f, -0.5f}, {-0.5f, -0.866f}, {0, -1}, {0.5f, -0.866f}, {0.866f, -0.5f}};

static inline void figure_part(Figure *figure, int part) {
  const FigurePart *from = &figure_parts[part];
  const int first = part * FIGURE_PART_VERTICES;
  // The tube's axis is the one along which it is longest.
  int axis = 0;
  for (int other = 1; other < 3; other++) {
    float length = from->to[other] - from->from[other], longest = from->to[axis] - from->from[axis];
    if (length * length > longest * longest) axis = other;
  }
  const int across = (axis + 1) % 3, along = (axis + 2) % 3;
  const float sign = from->to[axis] > from->from[axis] ? 1.0f : -1.0f;
  for (int vertex = 0; vertex < FIGURE_PART_VERTICES; vertex++) {
    FigureVertex *out = &figure->vertices[first + vertex];
    const int cap = vertex >= FIGURE_RINGS * FIGURE_SIDES;
    const int ring = cap ? (vertex == FIGURE_PART_VERTICES - 1 ? FIGURE_RINGS - 1 : 0) : vertex / FIGURE_SIDES;
    const float share = (float)ring / (FIGURE_RINGS - 1);
    const float *circle = figure_circle[vertex % FIGURE_SIDES];
    for (int i = 0; i < 3; i++) out->position[i] = from->from[i] + share * (from->to[i] - from->from[i]);
    if (cap) {
      out->normal[axis] = ring == 0 ? -sign : sign;
      out->tangent[across] = 1;
    } else {
      out->position[across] += from->radius * circle[0];
      out->position[along] += from->radius * circle[1];
      out->normal[across] = circle[0];
      out->normal[along] = circle[1];
      out->tangent[axis] = 1;
    }
    out->tangent[3] = 1;
    out->joint = (uint8_t)part;
    out->weight = 1;
    if (part == 3) figure->smile[first + vertex][2] = 0.01f * share;
  }
  uint16_t *index = &figure->indices[part * FIGURE_PART_INDICES];
  for (int ring = -1; ring < FIGURE_RINGS; ring++) {
    for (int side = 0; side < FIGURE_SIDES; side++) {
      const int next = (side + 1) % FIGURE_SIDES;
      const int low = first + ring * FIGURE_SIDES, high = low + FIGURE_SIDES;
      const int bottom = first + FIGURE_RINGS * FIGURE_SIDES, top = bottom + 1;
      int corners[6], count = 0;
      if (ring == -1) {
        corners[count++] = bottom, corners[count++] = high + next, corners[count++] = high + side;
      } else if (ring == FIGURE_RINGS - 1) {
        corners[count++] = top, corners[count++] = low + side, corners[count++] = low + next;
      } else {
        corners[count++] = low + side, corners[count++] = low + next, corners[count++] = high + next;
        corners[count++] = low + side, corners[count++] = high + next, corners[count++] = high + side;
      }
      for (int i = 0; i < count; i += 3) {
        // Outward whichever way the tube runs.
        *index++ = (uint16_t)corners[i];
        *index++ = (uint16_t)corners[sign > 0 ? i + 1 : i + 2];
        *index++ = (uint16_t)corners[sign > 0 ? i + 2 : i + 1];
      }
    }
  }
}

static inline void figure_make(Figure *figure) {
  memset(figure, 0, sizeof *figure);
  for (int role = 0; role < SDEF_ROLE_COUNT; role++) figure->role_joints[role] = -1;
  for (int part = 0; part < FIGURE_PARTS; part++) {
    figure->names[part] = figure_parts[part].name;
    figure->parents[part] = figure_parts[part].parent;
    figure->role_joints[figure_parts[part].role] = part;
    for (int i = 0; i < 3; i++) {
      figure->rest[part][5 * i] = 1;
      figure->rest[part][12 + i] = figure_parts[part].from[i];
    }
    figure->rest[part][15] = 1;
    figure_part(figure, part);
  }
  figure->skeleton.struct_size = sizeof figure->skeleton;
  figure->skeleton.role_count = SDEF_ROLE_COUNT;
  figure->skeleton.names = figure->names;
  figure->skeleton.joint_count = FIGURE_PARTS;
  figure->skeleton.parents = figure->parents;
  figure->skeleton.rest_matrices = figure->rest[0];
  figure->skeleton.role_joints = figure->role_joints;
  SdefMesh *mesh = &figure->mesh;
  mesh->struct_size = sizeof *mesh;
  mesh->kind = SDEF_MESH_BODY;
  mesh->name = "figure";
  mesh->vertex_count = FIGURE_VERTICES;
  mesh->positions = figure->vertices[0].position;
  mesh->normals = figure->vertices[0].normal;
  mesh->tangents = figure->vertices[0].tangent;
  mesh->joints = &figure->vertices[0].joint;
  mesh->weights = &figure->vertices[0].weight;
  mesh->position_stride = mesh->normal_stride = mesh->tangent_stride = sizeof(FigureVertex);
  mesh->joint_stride = mesh->weight_stride = sizeof(FigureVertex);
  mesh->influence_count = 1;
  mesh->joint_type = SDEF_TYPE_U8;
  mesh->indices = figure->indices;
  mesh->index_count = FIGURE_INDICES;
  mesh->index_type = SDEF_TYPE_U16;
  figure->target.struct_size = sizeof figure->target;
  figure->target.name = "smile";
  figure->target.positions = figure->smile[0];
}

#endif
