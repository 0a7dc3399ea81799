// minimal_check BEFORE.obj AFTER.obj: AFTER is BEFORE, made about 2.5 heads tall by examples/minimal.c: the same
// vertices in other places, the same triangles. Both are rigged and measured anew.
#include "superdeform.hpp"

#include "check.h"
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

struct Figure {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
};

static Figure read(const std::string &path) {
  Figure read;
  std::ifstream file(path);
  for (std::string kind; file >> kind;) {
    for (int i = 0; i < 3; i++) {
      if (kind == "v") file >> read.positions.emplace_back();
      if (kind == "f") file >> read.indices.emplace_back();
    }
    CHECK(file && (kind == "v" || kind == "f"));
  }
  for (std::uint32_t &index : read.indices) index--;
  return read;
}

static double heads(const Figure &figure) {
  auto character = superdeform::Character::create();
  SdefMesh mesh = superdeform::make<SdefMesh>();
  mesh.vertex_count = figure.positions.size() / 3;
  mesh.positions = figure.positions.data();
  mesh.indices = figure.indices.data();
  mesh.index_count = figure.indices.size();
  character.add_mesh(mesh);
  character.rig();
  return superdeform::Style::measure(character).numbers().heads;
}

static Figure before, after;

static void the_same_vertices_and_triangles_come_out() {
  CHECK(before.positions.size() > 3000 && before.indices.size() > 3000);
  CHECK(after.positions.size() == before.positions.size() && after.indices == before.indices);
}

static void the_figure_has_fewer_heads() {
  const double was = heads(before), is = heads(after);
  std::printf("%.2f heads before, %.2f after\n", was, is);
  CHECK(was > 3.5 && std::fabs(is - 2.5) < 0.4);
}

int main(int argc, char **argv) {
  if (argc != 3) return std::fprintf(stderr, "minimal_check BEFORE.obj AFTER.obj\n"), 2;
  before = read(argv[1]);
  after = read(argv[2]);
  RUN(the_same_vertices_and_triangles_come_out);
  RUN(the_figure_has_fewer_heads);
  return REPORT();
}
