// compare ONE OTHER [TOLERANCE]: the greatest distance between vertices of two files that show the same meshes, as the
// files pose them, in parts of the height. Exit code 1 above the tolerance (0.000001).
#include "gltf.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <map>

namespace {

struct Shape {
  // By mesh, primitive, and how often the mesh was shown before.
  std::map<std::array<int, 3>, std::vector<std::vector<Vector>>> parts; // the mesh, then with each morph target
  std::map<std::array<int, 3>, std::vector<Vector>> normals;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t vertices = 0;
};

Shape shape(const std::string &path) {
  const tinygltf::Model model = read_gltf(path);
  const Nodes nodes = read_nodes(model);
  Shape made;
  std::map<int, int> shown;
  std::vector<int> order = nodes.order;
  std::sort(order.begin(), order.end());
  for (const int node : order) {
    const int mesh = model.nodes[node].mesh;
    if (mesh < 0) continue;
    const int time = shown[mesh]++;
    const int skin = model.nodes[node].skin;
    std::vector<Matrix> joints;
    if (skin >= 0) {
      joints = inverse_binds(model, model.skins.at(skin));
      for (std::size_t i = 0; i < joints.size(); i++) joints[i] = nodes.world[model.skins[skin].joints[i]] * joints[i];
    }
    for (std::size_t index = 0; index < model.meshes[mesh].primitives.size(); index++) {
      const tinygltf::Primitive &primitive = model.meshes[mesh].primitives[index];
      const int accessor = attribute(primitive.attributes, "POSITION");
      if (accessor < 0) continue;
      const std::vector<float> base = floats(model, accessor, 3);
      const std::size_t count = base.size() / 3;
      std::vector<Matrix> frames(count, nodes.world[node]);
      if (skin >= 0 && attribute(primitive.attributes, "JOINTS_0") >= 0) {
        for (Matrix &frame : frames) frame.n.fill(0);
        for (int set = 0; attribute(primitive.attributes, "JOINTS_" + std::to_string(set)) >= 0; set++) {
          const auto slots = integers(model, attribute(primitive.attributes, "JOINTS_" + std::to_string(set)));
          const auto weights = floats(model, attribute(primitive.attributes, "WEIGHTS_" + std::to_string(set)), 4);
          for (std::size_t at = 0; at < weights.size(); at++)
            for (int i = 0; i < 16; i++) frames[at / 4].n[i] += weights[at] * joints.at(slots[at]).n[i];
        }
        for (Matrix &frame : frames) {
          const double sum = frame.n[15];
          for (double &n : frame.n) n /= sum == 0 ? 1 : sum;
        }
      }
      const std::array<int, 3> key{mesh, static_cast<int>(index), time};
      std::vector<std::vector<Vector>> &versions = made.parts[key];
      std::vector<std::vector<float>> deltas{{}};
      for (const auto &target : primitive.targets) {
        const int morph = attribute(target, "POSITION");
        deltas.push_back(morph < 0 ? std::vector<float>() : floats(model, morph, 3));
      }
      for (const std::vector<float> &delta : deltas) {
        std::vector<Vector> places(count);
        for (std::size_t vertex = 0; vertex < count; vertex++) {
          Vector place{};
          for (int i = 0; i < 3; i++)
            place[i] = base[3 * vertex + i] + (delta.empty() ? 0.0 : static_cast<double>(delta[3 * vertex + i]));
          places[vertex] = frames[vertex].move(place);
          made.low = std::min(made.low, places[vertex][1]);
          made.high = std::max(made.high, places[vertex][1]);
        }
        made.vertices += count;
        versions.push_back(places);
      }
      const int normal = attribute(primitive.attributes, "NORMAL");
      if (normal >= 0) {
        const std::vector<float> from = floats(model, normal, 3);
        for (std::size_t vertex = 0; vertex < count; vertex++) {
          Vector turned = frames[vertex].of_normals().turn({from[3 * vertex], from[3 * vertex + 1], from[3 * vertex + 2]});
          const double size = length(turned);
          made.normals[key].push_back(turned * (size > 0 ? 1 / size : 0));
        }
      }
    }
  }
  return made;
}

} // namespace

int main(int argc, char **argv) try {
  if (argc < 3) return std::fprintf(stderr, "compare ONE OTHER [TOLERANCE]\n"), 2;
  const double tolerance = argc > 3 ? std::atof(argv[3]) : 1e-6;
  const Shape one = shape(argv[1]), other = shape(argv[2]);
  if (one.parts.size() != other.parts.size() || one.vertices != other.vertices || one.vertices == 0)
    return std::printf("%zu meshes with %zu vertices, but %zu with %zu\n", one.parts.size(), one.vertices,
                       other.parts.size(), other.vertices), 1;
  const double height = one.high - one.low;
  double farthest = 0, normal_farthest = 0;
  std::array<int, 3> where{};
  for (const auto &[key, versions] : one.parts) {
    const auto found = other.parts.find(key);
    if (found == other.parts.end() || found->second.size() != versions.size())
      return std::printf("mesh %d, primitive %d: not in both\n", key[0], key[1]), 1;
    for (std::size_t version = 0; version < versions.size(); version++)
      for (std::size_t vertex = 0; vertex < versions[version].size(); vertex++) {
        const double apart = length(versions[version][vertex] - found->second[version].at(vertex)) / height;
        if (!(apart <= farthest)) farthest = apart, where = {key[0], key[1], static_cast<int>(version)};
      }
  }
  // Normals by their median and worst: one where a triangle has no extent may be anything.
  std::vector<double> turned;
  for (const auto &[key, normals] : one.normals)
    for (std::size_t vertex = 0; vertex < normals.size(); vertex++)
      turned.push_back(length(normals[vertex] - other.normals.at(key).at(vertex)));
  std::sort(turned.begin(), turned.end());
  if (!turned.empty()) normal_farthest = turned[turned.size() - 1 - turned.size() / 1000];
  std::printf("%zu vertices: %.2e of the height apart (mesh %d, primitive %d, version %d), normals %.2e\n", one.vertices,
              farthest, where[0], where[1], where[2], normal_farthest);
  return farthest <= tolerance && normal_farthest <= 1e-3 ? 0 : 1;
} catch (const std::exception &error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
