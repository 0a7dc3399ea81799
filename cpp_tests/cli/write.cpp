#include "write.hpp"
#include "vrm.hpp"

#include <algorithm>
#include <map>

namespace {

// The results of one part, in model space.
struct Result {
  std::vector<float> positions, normals, tangents, morph_positions, morph_normals, morph_tangents;
};

// Numbers in the file, and who put them there.
class Files {
public:
  explicit Files(tinygltf::Model &model) : model_(model) {}

  int put(int accessor, int components, const std::vector<float> &numbers) {
    const auto known = written_.find(accessor);
    if (known != written_.end() && known->second == numbers) return accessor;
    const int at = store(model_, accessor, components, numbers, known != written_.end());
    written_[at] = numbers;
    return at;
  }

private:
  tinygltf::Model &model_;
  std::map<int, std::vector<float>> written_;
};

// Vectors back to the file's space. `lengths` receives what unit vectors were multiplied by, or gives it for changes.
void bring_back(std::vector<float> &numbers, std::size_t components, const std::vector<Matrix> &ways, bool point,
                bool normal, std::vector<double> *unit, const std::vector<double> *scale, std::size_t first) {
  if (ways.size() == 1 && ways[0] == Matrix()) return;
  Matrix map = normal ? ways[0].of_normals() : ways[0];
  for (std::size_t vertex = 0; vertex < numbers.size() / components - first; vertex++) {
    float *at = &numbers[components * (first + vertex)];
    if (ways.size() > 1) map = normal ? ways[vertex].of_normals() : ways[vertex];
    const Vector from{at[0], at[1], at[2]};
    Vector to = point ? map.move(from) : map.turn(from);
    if (unit != nullptr && length(to) > 0) {
      (*unit)[vertex] = 1 / length(to);
      to = to * (*unit)[vertex];
    }
    if (scale != nullptr) to = to * (*scale)[vertex];
    for (int i = 0; i < 3; i++) at[i] = static_cast<float>(to[i]);
  }
}

void put_part(Loaded &loaded, Files &files, const Part &part, Result &result, const std::vector<Matrix> &rest, int mesh) {
  const std::size_t count = part.arrays.vertex_count;
  std::vector<Matrix> ways = part.placements;
  if (part.skin < 0) ways = {rest[part.node]};
  for (Matrix &way : ways)
    if (!(way == Matrix())) way = way.inverse();
  std::vector<double> normal_scale(count, 1), tangent_scale(count, 1);
  bring_back(result.positions, 3, ways, true, false, nullptr, nullptr, 0);
  bring_back(result.normals, 3, ways, false, true, &normal_scale, nullptr, 0);
  bring_back(result.tangents, 4, ways, false, false, &tangent_scale, nullptr, 0);
  const auto put = [&](std::map<std::string, int> &attributes, const char *name, int components,
                       const std::vector<float> &numbers) {
    attributes[name] = files.put(attribute(attributes, name), components, numbers);
  };
  auto &attributes = loaded.model.meshes[mesh].primitives[part.primitive].attributes;
  put(attributes, "POSITION", 3, result.positions);
  if (!result.normals.empty()) put(attributes, "NORMAL", 3, result.normals);
  if (!result.tangents.empty()) put(attributes, "TANGENT", 4, result.tangents);
  for (std::size_t target = 0; target < part.targets.size(); target++) {
    auto &changes = loaded.model.meshes[mesh].primitives[part.primitive].targets[target];
    const auto take = [&](const std::vector<float> &all) {
      return std::vector<float>(all.begin() + 3 * count * target, all.begin() + 3 * count * (target + 1));
    };
    const auto put_target = [&](const char *name, std::vector<float> numbers, bool normal, const std::vector<double> *scale) {
      const bool zero = std::all_of(numbers.begin(), numbers.end(), [](float n) { return n == 0; });
      if (zero && attribute(changes, name) < 0) return;
      bring_back(numbers, 3, ways, false, normal, nullptr, scale, 0);
      put(changes, name, 3, numbers);
    };
    put_target("POSITION", take(result.morph_positions), false, nullptr);
    if (part.targets[target].normals != nullptr) put_target("NORMAL", take(result.morph_normals), true, &normal_scale);
    if (part.targets[target].tangents != nullptr) put_target("TANGENT", take(result.morph_tangents), false, &tangent_scale);
  }
}

std::vector<Result> apply(const Loaded &loaded, const superdeform::Deformer &deformer) {
  std::vector<Result> results(loaded.parts.size());
  std::vector<SdefMeshResult> asked;
  for (std::size_t index = 0; index < results.size(); index++) {
    const Part &part = loaded.parts[index];
    Result &result = results[index];
    const std::size_t count = part.arrays.vertex_count, all = count * part.targets.size();
    SdefMeshResult ask = superdeform::make<SdefMeshResult>();
    ask.vertex_capacity = count;
    ask.morph_target_capacity = static_cast<std::uint32_t>(part.targets.size());
    const auto want = [](std::vector<float> &numbers, std::size_t size) {
      numbers.resize(size);
      return numbers.data();
    };
    ask.positions = want(result.positions, 3 * count);
    if (part.arrays.normals != nullptr) ask.normals = want(result.normals, 3 * count);
    if (part.arrays.tangents != nullptr) ask.tangents = want(result.tangents, 4 * count);
    if (all > 0) {
      ask.morph_positions = want(result.morph_positions, 3 * all);
      const auto any = [&](const float *SdefMorphTarget::*field) {
        return std::any_of(part.targets.begin(), part.targets.end(), [&](const SdefMorphTarget &t) { return t.*field != nullptr; });
      };
      if (any(&SdefMorphTarget::normals)) ask.morph_normals = want(result.morph_normals, 3 * all);
      if (any(&SdefMorphTarget::tangents)) ask.morph_tangents = want(result.morph_tangents, 3 * all);
    }
    asked.push_back(ask);
  }
  deformer.apply(asked);
  return results;
}

// Moves a node by what its joint moves against its parent at rest; a pose that it stands in stays.
void move_nodes(Loaded &loaded, const std::vector<Matrix> &rest) {
  for (const int node : loaded.node_of_joint) {
    const int parent = loaded.nodes.parents[node];
    const auto local = [&](const std::vector<Matrix> &of) {
      return parent < 0 ? of[node].translation() : of[parent].inverse().move(of[node].translation());
    };
    const Vector before = local(loaded.rest), change = local(rest) - before;
    if (!(length(change) > 1e-12 * length(before))) continue;
    const Vector to = loaded.nodes.local[node].translation() + change;
    tinygltf::Node &out = loaded.model.nodes[node];
    if (out.matrix.size() == 16) std::copy(to.begin(), to.end(), out.matrix.begin() + 12);
    else out.translation.assign(to.begin(), to.end());
  }
}

void put_matrices(Files &files, tinygltf::Skin &skin, const std::vector<Matrix> &binds) {
  std::vector<float> numbers;
  for (const Matrix &bind : binds)
    for (const double number : bind.n) numbers.push_back(static_cast<float>(number));
  skin.inverseBindMatrices = files.put(skin.inverseBindMatrices, 16, numbers);
}

// J'_j B'_j stays what J_j B_j was, so that weights keep their meaning.
void move_binds(Loaded &loaded, Files &files, const std::vector<Matrix> &rest) {
  for (std::size_t index = 0; index < loaded.skins.size(); index++) {
    tinygltf::Skin &skin = loaded.model.skins[index];
    std::vector<Matrix> binds = loaded.skins[index].inverse_binds;
    for (std::size_t slot = 0; slot < binds.size(); slot++) {
      const int node = skin.joints[slot];
      if (!(rest[node] == loaded.rest[node])) binds[slot] = rest[node].inverse() * loaded.skins[index].by_joint[slot];
    }
    put_matrices(files, skin, binds);
  }
}

// The joints of a made rig as nodes, a skin for each placement of a mesh, four influences a vertex.
void add_rig(Loaded &loaded, Files &files, const superdeform::Deformer::Joints &joints, const std::vector<int> &meshes) {
  tinygltf::Model &model = loaded.model;
  const superdeform::Character::Joints rig = loaded.character.joints();
  const std::size_t count = rig.parents.size();
  const int first = static_cast<int>(model.nodes.size());
  const auto at = [&](std::size_t joint) {
    return Vector{joints.positions[3 * joint], joints.positions[3 * joint + 1], joints.positions[3 * joint + 2]};
  };
  tinygltf::Node root;
  root.name = "rig";
  std::vector<int> nodes;
  for (std::size_t joint = 0; joint < count; joint++) {
    tinygltf::Node node;
    const int parent = rig.parents[joint];
    const Vector local = parent < 0 ? at(joint) : at(joint) - at(static_cast<std::size_t>(parent));
    node.name = rig.roles[joint] == SDEF_NONE ? "joint" + std::to_string(joint) : "role" + std::to_string(rig.roles[joint]);
    node.translation.assign(local.begin(), local.end());
    nodes.push_back(first + static_cast<int>(joint));
    model.nodes.push_back(node);
  }
  for (std::size_t joint = 0; joint < count; joint++)
    (rig.parents[joint] < 0 ? root : model.nodes[nodes[rig.parents[joint]]]).children.push_back(nodes[joint]);
  if (model.scenes.empty()) model.scenes.emplace_back();
  model.scenes[std::max(model.defaultScene, 0)].nodes.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(root);

  std::vector<std::pair<Matrix, int>> skins;
  for (std::size_t index = 0; index < loaded.parts.size(); index++) {
    const Part &part = loaded.parts[index];
    const Matrix &placement = part.placements[0];
    auto skin = std::find_if(skins.begin(), skins.end(), [&](const auto &known) { return known.first == placement; });
    if (skin == skins.end()) {
      std::vector<Matrix> binds(count);
      for (std::size_t joint = 0; joint < count; joint++) {
        std::copy_n(joints.inverse_binds.begin() + static_cast<std::ptrdiff_t>(16 * joint), 16, binds[joint].n.begin());
        binds[joint] = binds[joint] * placement;
      }
      tinygltf::Skin made;
      made.name = "rig";
      made.joints = nodes;
      put_matrices(files, made, binds);
      skin = skins.insert(skins.end(), {placement, static_cast<int>(model.skins.size())});
      model.skins.push_back(made);
    }
    const std::size_t vertices = part.arrays.vertex_count;
    std::vector<std::uint32_t> of_vertex(4 * vertices);
    std::vector<float> weights(4 * vertices);
    loaded.character.weights(static_cast<std::uint32_t>(index), 4, of_vertex, weights);
    const std::vector<std::uint16_t> narrow(of_vertex.begin(), of_vertex.end());
    auto &attributes = model.meshes[meshes[index]].primitives[part.primitive].attributes;
    attributes["JOINTS_0"] = append(model, narrow.data(), 2 * narrow.size(), vertices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                                    TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER);
    attributes["WEIGHTS_0"] = append(model, weights.data(), 4 * weights.size(), vertices, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                     TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER);
    model.nodes[part.node].skin = skin->second;
  }
}

} // namespace

void deform(Loaded &loaded, const superdeform::Deformer &deformer) {
  std::vector<Result> results = apply(loaded, deformer);
  const superdeform::Deformer::Joints joints = deformer.joints();
  std::vector<Matrix> rest = loaded.rest;
  if (loaded.rigged)
    for (std::size_t joint = 0; joint < loaded.node_of_joint.size(); joint++)
      rest[loaded.node_of_joint[joint]].set_translation(
          {joints.positions[3 * joint], joints.positions[3 * joint + 1], joints.positions[3 * joint + 2]});

  Files files(loaded.model);
  // A mesh that several nodes show is deformed differently by each.
  std::map<int, int> shown_by;
  std::vector<int> meshes;
  for (std::size_t index = 0; index < loaded.parts.size(); index++) {
    const Part &part = loaded.parts[index];
    const int owner = shown_by.emplace(part.mesh, part.node).first->second;
    if (owner != part.node && loaded.model.nodes[part.node].mesh == part.mesh) {
      const tinygltf::Mesh copy = loaded.model.meshes[part.mesh];
      loaded.model.nodes[part.node].mesh = static_cast<int>(loaded.model.meshes.size());
      loaded.model.meshes.push_back(copy);
    }
    meshes.push_back(loaded.model.nodes[part.node].mesh);
    put_part(loaded, files, part, results[index], rest, meshes.back());
  }
  if (!loaded.rigged) {
    add_rig(loaded, files, joints, meshes);
    return;
  }
  move_binds(loaded, files, rest);
  move_points(loaded, deformer, rest);
  move_nodes(loaded, rest);
}
