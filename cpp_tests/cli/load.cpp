#include "load.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

namespace {

// A box around a skin's vertices and joints, by its corners.
using Corners = std::array<Vector, 8>;

bool invertible(const Matrix &matrix) {
  const double determinant = matrix.determinant();
  return std::isfinite(determinant) && std::fabs(determinant) > 1e-30;
}

bool agree(const Matrix &one, const Matrix &other, const Corners &corners, double tolerance) {
  const double size = length(other.turn(corners[7] - corners[0]));
  return std::all_of(corners.begin(), corners.end(), [&](const Vector &corner) {
    return length(one.move(corner) - other.move(corner)) <= tolerance * size;
  });
}

// Exporters pose the nodes as they like; inverse bind matrices tell the rest pose. J_j B_j is the same matrix for all
// joints that stand at rest: the one that most have, number by number its median.
std::optional<Matrix> elected(const std::vector<Matrix> &matrices, const Corners &corners) {
  std::size_t most = 0;
  const Matrix *winner = nullptr;
  for (const Matrix &candidate : matrices) {
    const auto votes = static_cast<std::size_t>(std::count_if(matrices.begin(), matrices.end(), [&](const Matrix &m) {
      return agree(m, candidate, corners, 1e-3);
    }));
    if (votes > most) most = votes, winner = &candidate;
  }
  if (winner == nullptr || 2 * most <= matrices.size()) return std::nullopt;
  Matrix median;
  for (int i = 0; i < 16; i++) {
    std::vector<double> values;
    for (const Matrix &m : matrices)
      if (agree(m, *winner, corners, 1e-3)) values.push_back(m.n[i]);
    std::sort(values.begin(), values.end());
    median.n[i] = values[values.size() / 2];
  }
  return median;
}

Corners corners_of(const std::vector<Vector> &points) {
  Vector low{0, 0, 0}, high{1, 1, 1};
  if (!points.empty()) low = high = points[0];
  for (const Vector &point : points)
    for (int i = 0; i < 3; i++) low[i] = std::min(low[i], point[i]), high[i] = std::max(high[i], point[i]);
  if (low == high) high = low + Vector{1, 1, 1};
  Corners corners;
  for (int corner = 0; corner < 8; corner++)
    for (int i = 0; i < 3; i++) corners[corner][i] = corner >> i & 1 ? high[i] : low[i];
  return corners;
}

// The rest pose of all nodes, and what takes each skin's vertices to model space.
void find_rest_pose(Loaded &loaded) {
  const tinygltf::Model &model = loaded.model;
  std::vector<std::optional<Matrix>> of_joint(model.nodes.size());
  std::vector<Corners> boxes;
  loaded.skins.resize(model.skins.size());
  for (std::size_t index = 0; index < model.skins.size(); index++) {
    const std::vector<int> &joints = model.skins[index].joints;
    LoadedSkin &skin = loaded.skins[index];
    skin.inverse_binds = inverse_binds(model, model.skins[index]);
    std::vector<Vector> points;
    std::vector<Matrix> posed, placed;
    for (std::size_t slot = 0; slot < joints.size(); slot++) {
      const Matrix &bind = skin.inverse_binds[slot];
      if (!invertible(bind)) continue;
      points.push_back(bind.inverse().translation());
      posed.push_back(loaded.nodes.world[joints[slot]] * bind);
      if (of_joint[joints[slot]]) placed.push_back(*of_joint[joints[slot]] * bind);
    }
    Matrix fallback;
    for (const Part &part : loaded.parts) {
      if (part.skin != static_cast<int>(index)) continue;
      fallback = loaded.nodes.world[part.node];
      const tinygltf::Primitive &primitive = model.meshes[part.mesh].primitives[part.primitive];
      const std::vector<float> numbers = floats(model, primitive.attributes.at("POSITION"), 3);
      for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    }
    boxes.push_back(corners_of(points));
    skin.common = elected(placed.empty() ? posed : placed, boxes.back()).value_or(fallback);
    // So that vertices keep their bits, and can be handed over where they lie.
    if (agree(skin.common, Matrix(), boxes.back(), 1e-6)) skin.common = Matrix();
    for (std::size_t slot = 0; slot < joints.size(); slot++)
      if (!of_joint[joints[slot]] && invertible(skin.inverse_binds[slot]))
        of_joint[joints[slot]] = skin.common * skin.inverse_binds[slot].inverse();
  }
  loaded.rest = loaded.nodes.world;
  for (const int node : loaded.nodes.order) {
    const int parent = loaded.nodes.parents[node];
    if (of_joint[node]) loaded.rest[node] = *of_joint[node];
    else if (parent >= 0) loaded.rest[node] = loaded.rest[parent] * loaded.nodes.local[node];
  }
  for (std::size_t index = 0; index < loaded.skins.size(); index++) {
    LoadedSkin &skin = loaded.skins[index];
    for (std::size_t slot = 0; slot < skin.inverse_binds.size(); slot++) {
      skin.by_joint.push_back(loaded.rest[model.skins[index].joints[slot]] * skin.inverse_binds[slot]);
      skin.uniform &= agree(skin.by_joint.back(), skin.common, boxes[index], 1e-6);
    }
    if (skin.uniform) skin.by_joint.assign(skin.by_joint.size(), skin.common);
  }
}

// The joints of the character: those of the first skin in its own order, so that its weights can be handed over where
// they lie; then all other nodes.
void order_joints(Loaded &loaded) {
  loaded.joint_of_node.assign(loaded.model.nodes.size(), -1);
  const auto add = [&](int node) {
    if (loaded.joint_of_node[node] >= 0) return;
    loaded.joint_of_node[node] = static_cast<int>(loaded.node_of_joint.size());
    loaded.node_of_joint.push_back(node);
  };
  if (!loaded.model.skins.empty())
    for (const int node : loaded.model.skins[0].joints) add(node);
  for (const int node : loaded.nodes.order) add(node);
}

// What the library guesses the mesh's kind from: "node/mesh/material".
std::string name_of(const tinygltf::Model &model, const Part &part) {
  const tinygltf::Mesh &mesh = model.meshes[part.mesh];
  const int material = mesh.primitives[part.primitive].material;
  std::string name;
  const auto add = [&](const std::string &text) {
    if (!text.empty()) name += (name.empty() ? "" : "/") + text;
  };
  add(model.nodes[part.node].name);
  add(mesh.name);
  if (material >= 0) add(model.materials.at(material).name);
  return name;
}

// Vectors of the file in model space: where they lie if they need no change.
const float *place(Loaded &loaded, const Part &part, int accessor, int components, std::size_t &stride, bool point,
                   bool normal, bool unit) {
  const Elements all = elements(loaded.model, accessor);
  if (all.count != part.arrays.vertex_count || all.components != components)
    throw std::runtime_error("accessor " + std::to_string(accessor) + " does not fit its mesh: export the file anew");
  const bool still = part.placements.size() == 1 && part.placements[0] == Matrix();
  if (still && all.plain() && all.type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
    stride = all.stride;
    return reinterpret_cast<const float *>(all.data);
  }
  std::vector<float> &numbers = loaded.floats.emplace_back(floats(loaded.model, accessor, components));
  stride = 0;
  if (still) return numbers.data();
  Matrix map = normal ? part.placements[0].of_normals() : part.placements[0];
  for (std::size_t vertex = 0; vertex < all.count; vertex++) {
    float *at = &numbers[components * vertex];
    if (part.placements.size() > 1) map = normal ? part.placements[vertex].of_normals() : part.placements[vertex];
    const Vector from{at[0], at[1], at[2]};
    Vector to = point ? map.move(from) : map.turn(from);
    if (unit && length(to) > 0) to = to * (1 / length(to));
    for (int i = 0; i < 3; i++) at[i] = static_cast<float>(to[i]);
  }
  return numbers.data();
}

// Triangles as glTF has them; strips and fans are taken apart.
void set_triangles(Loaded &loaded, Part &part, const tinygltf::Primitive &primitive) {
  SdefMesh &mesh = part.arrays;
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES) return;
  if (mode == TINYGLTF_MODE_TRIANGLES && primitive.indices >= 0) {
    const Elements all = elements(loaded.model, primitive.indices);
    if (all.plain() && all.stride == static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(all.type))) {
      mesh.indices = all.data;
      mesh.index_count = all.count / 3 * 3;
      mesh.index_type = all.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? SDEF_TYPE_U8
                        : all.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? SDEF_TYPE_U16
                                                                             : SDEF_TYPE_U32;
      return;
    }
  }
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) corners = integers(loaded.model, primitive.indices);
  else
    for (std::size_t vertex = 0; vertex < mesh.vertex_count; vertex++) corners.push_back(static_cast<std::uint32_t>(vertex));
  std::vector<std::uint32_t> &indices = loaded.integers.emplace_back();
  for (std::size_t i = 0; i + 2 < corners.size(); i += mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN, odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1;
    indices.push_back(corners[fan ? i + 1 : i]);
    indices.push_back(corners[fan || odd ? i + 2 : i + 1]);
    indices.push_back(corners[fan ? 0 : odd ? i + 1 : i + 2]);
  }
  mesh.indices = indices.data();
  mesh.index_count = indices.size();
  mesh.index_type = SDEF_TYPE_U32;
}

// Joints and weights: where they lie for one set of four and joints in the skin's order.
void set_weights(Loaded &loaded, Part &part, const tinygltf::Primitive &primitive) {
  SdefMesh &mesh = part.arrays;
  if (part.skin < 0) {
    const auto joint = static_cast<std::uint32_t>(loaded.joint_of_node[part.node]);
    mesh.influence_count = 1;
    mesh.joint_type = SDEF_TYPE_U32;
    mesh.joints = loaded.integers.emplace_back(mesh.vertex_count, joint).data();
    mesh.weights = loaded.floats.emplace_back(mesh.vertex_count, 1.0f).data();
    return;
  }
  const std::vector<int> &slots = loaded.model.skins[part.skin].joints;
  int sets = 0;
  while (attribute(primitive.attributes, "JOINTS_" + std::to_string(sets)) >= 0 &&
         attribute(primitive.attributes, "WEIGHTS_" + std::to_string(sets)) >= 0)
    sets++;
  bool same = sets == 1;
  for (std::size_t slot = 0; slot < slots.size(); slot++) same &= loaded.joint_of_node[slots[slot]] == static_cast<int>(slot);
  if (same) {
    const Elements joints = elements(loaded.model, primitive.attributes.at("JOINTS_0"));
    const Elements weights = elements(loaded.model, primitive.attributes.at("WEIGHTS_0"));
    same = joints.plain() && weights.plain() && joints.components == 4 && weights.components == 4 &&
           joints.count == mesh.vertex_count && weights.count == mesh.vertex_count;
    if (same) {
      mesh.influence_count = 4;
      mesh.joints = joints.data;
      mesh.joint_stride = joints.stride;
      mesh.joint_type = joints.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ? SDEF_TYPE_U8 : SDEF_TYPE_U16;
      mesh.weights = weights.data;
      mesh.weight_stride = weights.stride;
      mesh.weight_type = weights.type == TINYGLTF_COMPONENT_TYPE_FLOAT           ? SDEF_TYPE_F32
                         : weights.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ? SDEF_TYPE_U8
                                                                                 : SDEF_TYPE_U16;
      return;
    }
  }
  std::vector<std::uint32_t> &joints = loaded.integers.emplace_back(4 * sets * mesh.vertex_count);
  std::vector<float> &weights = loaded.floats.emplace_back(joints.size());
  for (int set = 0; set < sets; set++) {
    const auto from = integers(loaded.model, primitive.attributes.at("JOINTS_" + std::to_string(set)));
    const auto shares = floats(loaded.model, primitive.attributes.at("WEIGHTS_" + std::to_string(set)), 4);
    if (from.size() != 4 * mesh.vertex_count || shares.size() != from.size())
      throw std::runtime_error(part.name + ": its joints and weights do not fit its vertices: export the file anew");
    for (std::size_t at = 0; at < from.size(); at++) {
      const std::size_t to = at / 4 * 4 * sets + 4 * set + at % 4;
      weights[to] = shares[at];
      joints[to] = shares[at] == 0 ? 0 : static_cast<std::uint32_t>(loaded.joint_of_node.at(slots.at(from[at])));
    }
  }
  mesh.influence_count = 4 * static_cast<std::size_t>(sets);
  mesh.joints = joints.data();
  mesh.joint_type = SDEF_TYPE_U32;
  mesh.weights = weights.data();
}

// What takes a skinned mesh to rest: a matrix a vertex where its joints are bound in several poses.
void set_placements(Loaded &loaded, Part &part, const tinygltf::Primitive &primitive) {
  if (part.skin < 0) {
    part.placements = {loaded.rest[part.node]};
    return;
  }
  const LoadedSkin &skin = loaded.skins[part.skin];
  part.placements = {skin.common};
  if (skin.uniform) return;
  std::vector<Matrix> blended(part.arrays.vertex_count);
  for (Matrix &matrix : blended) matrix.n.fill(0);
  std::vector<double> sums(blended.size());
  for (int set = 0; attribute(primitive.attributes, "JOINTS_" + std::to_string(set)) >= 0; set++) {
    const auto slots = integers(loaded.model, primitive.attributes.at("JOINTS_" + std::to_string(set)));
    const auto weights = floats(loaded.model, primitive.attributes.at("WEIGHTS_" + std::to_string(set)), 4);
    for (std::size_t at = 0; at < weights.size() && at / 4 < blended.size(); at++) {
      if (weights[at] == 0) continue;
      for (int i = 0; i < 16; i++) blended[at / 4].n[i] += weights[at] * skin.by_joint.at(slots[at]).n[i];
      sums[at / 4] += weights[at];
    }
  }
  for (std::size_t vertex = 0; vertex < blended.size(); vertex++) {
    for (double &n : blended[vertex].n) n /= sums[vertex] > 0 ? sums[vertex] : 1;
    if (!(std::fabs(blended[vertex].determinant()) > 1e-30)) blended[vertex] = skin.common;
  }
  part.placements = blended;
}

// The image of the base colour, how its coordinates are called and moved; VRM 0.x may tell the image in a list of its own.
struct Painted {
  int image = -1, set = 0;
  std::array<double, 6> transform{1, 0, 0, 0, 1, 0};
};

Painted painted_of(const tinygltf::Model &model, int index) {
  Painted found;
  if (index < 0) return found;
  const tinygltf::Material &material = model.materials.at(index);
  const tinygltf::TextureInfo &info = material.pbrMetallicRoughness.baseColorTexture;
  int texture = info.index;
  found.set = info.texCoord;
  if (const auto moved = info.extensions.find("KHR_texture_transform"); moved != info.extensions.end()) {
    const auto pair = [&](const char *key, double otherwise, int i) {
      const tinygltf::Value &value = moved->second.Get(key);
      return value.ArrayLen() == 2 ? value.Get(i).GetNumberAsDouble() : otherwise;
    };
    const tinygltf::Value &turned = moved->second.Get("rotation"), &set = moved->second.Get("texCoord");
    const double angle = turned.IsNumber() ? turned.GetNumberAsDouble() : 0, sin = std::sin(angle), cos = std::cos(angle);
    const double u = pair("scale", 1, 0), v = pair("scale", 1, 1);
    found.transform = {cos * u, sin * v, pair("offset", 0, 0), -sin * u, cos * v, pair("offset", 0, 1)};
    if (set.IsNumber()) found.set = set.GetNumberAsInt();
  }
  const auto old = model.extensions.find("VRM");
  if (texture < 0 && old != model.extensions.end()) {
    const tinygltf::Value &main = old->second.Get("materialProperties").Get(index).Get("textureProperties").Get("_MainTex");
    if (main.IsNumber()) texture = main.GetNumberAsInt();
  }
  if (texture >= 0) found.image = model.textures.at(texture).source;
  return found;
}

// What the mesh shows: the number of its image, handed over once, and where its vertices lie on it.
void show(Loaded &loaded, const Part &part, SdefMesh &mesh) {
  const tinygltf::Primitive &primitive = loaded.model.meshes[part.mesh].primitives[part.primitive];
  const Painted painted = painted_of(loaded.model, primitive.material);
  const int uvs = attribute(primitive.attributes, "TEXCOORD_" + std::to_string(painted.set));
  if (painted.image < 0 || uvs < 0) return;
  if (loaded.images.count(painted.image) == 0) {
    const Grey from = grey(loaded.model, painted.image);
    SdefImage image = superdeform::make<SdefImage>();
    image.width = static_cast<std::uint32_t>(from.width);
    image.height = static_cast<std::uint32_t>(from.height);
    image.pixels = from.pixels.data();
    loaded.images[painted.image] = from.pixels.empty() ? 0 : loaded.character.add_image(image);
  }
  mesh.image = loaded.images[painted.image];
  if (mesh.image == 0) return;
  std::vector<float> &numbers = loaded.floats.emplace_back(floats(loaded.model, uvs, 2));
  std::array<float, 6> t;
  std::transform(painted.transform.begin(), painted.transform.end(), t.begin(), [](double n) { return static_cast<float>(n); });
  for (std::size_t at = 0; at + 1 < numbers.size(); at += 2) {
    const float u = numbers[at], v = numbers[at + 1];
    numbers[at] = t[0] * u + t[1] * v + t[2];
    numbers[at + 1] = t[3] * u + t[4] * v + t[5];
  }
  mesh.uvs = numbers.data();
}

void set_arrays(Loaded &loaded, Part &part) {
  const tinygltf::Primitive &primitive = loaded.model.meshes[part.mesh].primitives[part.primitive];
  SdefMesh &mesh = part.arrays;
  mesh = superdeform::make<SdefMesh>();
  mesh.name = part.name.c_str();
  const int position = primitive.attributes.at("POSITION"), normal = attribute(primitive.attributes, "NORMAL"),
            tangent = attribute(primitive.attributes, "TANGENT");
  mesh.vertex_count = elements(loaded.model, position).count;
  set_placements(loaded, part, primitive);
  mesh.positions = place(loaded, part, position, 3, mesh.position_stride, true, false, false);
  if (normal >= 0) mesh.normals = place(loaded, part, normal, 3, mesh.normal_stride, false, true, true);
  if (tangent >= 0) mesh.tangents = place(loaded, part, tangent, 4, mesh.tangent_stride, false, false, true);
  set_triangles(loaded, part, primitive);
  set_weights(loaded, part, primitive);
  for (const auto &from : primitive.targets) {
    SdefMorphTarget target = superdeform::make<SdefMorphTarget>();
    const int positions = attribute(from, "POSITION"), normals = attribute(from, "NORMAL"),
              tangents = attribute(from, "TANGENT");
    if (positions >= 0) target.positions = place(loaded, part, positions, 3, target.position_stride, false, false, false);
    else target.positions = loaded.floats.emplace_back(3 * mesh.vertex_count).data();
    // What has no normals itself can have no changes of them.
    if (normals >= 0 && normal >= 0) target.normals = place(loaded, part, normals, 3, target.normal_stride, false, true, false);
    if (tangents >= 0 && tangent >= 0) target.tangents = place(loaded, part, tangents, 3, target.tangent_stride, false, false, false);
    part.targets.push_back(target);
  }
}

// VRM 1.0's names of the roles, in the order of SDEF_ROLE_*.
const char *const role_names[SDEF_ROLE_COUNT] = {
    "hips", "leftUpperLeg", "rightUpperLeg", "leftLowerLeg", "rightLowerLeg", "leftFoot", "rightFoot", "spine", "chest",
    "neck", "head", "leftShoulder", "rightShoulder", "leftUpperArm", "rightUpperArm", "leftLowerArm", "rightLowerArm",
    "leftHand", "rightHand", "leftToes", "rightToes", "leftEye", "rightEye", "jaw", "leftThumbMetacarpal",
    "leftThumbProximal", "leftThumbDistal", "leftIndexProximal", "leftIndexIntermediate", "leftIndexDistal",
    "leftMiddleProximal", "leftMiddleIntermediate", "leftMiddleDistal", "leftRingProximal", "leftRingIntermediate",
    "leftRingDistal", "leftLittleProximal", "leftLittleIntermediate", "leftLittleDistal", "rightThumbMetacarpal",
    "rightThumbProximal", "rightThumbDistal", "rightIndexProximal", "rightIndexIntermediate", "rightIndexDistal",
    "rightMiddleProximal", "rightMiddleIntermediate", "rightMiddleDistal", "rightRingProximal", "rightRingIntermediate",
    "rightRingDistal", "rightLittleProximal", "rightLittleIntermediate", "rightLittleDistal", "upperChest"};

// The roles that a VRM gives, by SDEF_ROLE_*: joints, or -1.
std::vector<std::int32_t> roles_of(const Loaded &loaded) {
  std::vector<std::int32_t> joints(SDEF_ROLE_COUNT, -1);
  const auto give = [&](std::string name, const tinygltf::Value &node, bool old) {
    // VRM 0.x, as Unity, calls the thumb's joints proximal, intermediate, distal.
    const auto replace = [&](const char *from, const char *to) {
      const std::size_t at = name.find(from);
      if (at == std::string::npos) return false;
      name.replace(at, std::strlen(from), to);
      return true;
    };
    if (old && !replace("ThumbProximal", "ThumbMetacarpal")) replace("ThumbIntermediate", "ThumbProximal");
    for (int role = 0; role < SDEF_ROLE_COUNT; role++) {
      const int at = node.IsNumber() ? node.GetNumberAsInt() : -1;
      if (name == role_names[role] && at >= 0 && at < static_cast<int>(loaded.joint_of_node.size()))
        joints[role] = loaded.joint_of_node[at];
    }
  };
  const auto &extensions = loaded.model.extensions;
  if (const auto vrm1 = extensions.find("VRMC_vrm"); vrm1 != extensions.end()) {
    const tinygltf::Value &bones = vrm1->second.Get("humanoid").Get("humanBones");
    for (const std::string &name : bones.Keys()) give(name, bones.Get(name).Get("node"), false);
  } else if (const auto vrm0 = extensions.find("VRM"); vrm0 != extensions.end()) {
    const tinygltf::Value &bones = vrm0->second.Get("humanoid").Get("humanBones");
    for (int bone = 0; bone < static_cast<int>(bones.ArrayLen()); bone++)
      if (bones.Get(bone).Get("bone").IsString())
        give(bones.Get(bone).Get("bone").Get<std::string>(), bones.Get(bone).Get("node"), true);
  }
  return joints;
}

void set_skeleton(Loaded &loaded) {
  std::vector<const char *> names;
  std::vector<std::int32_t> parents;
  std::vector<Matrix> rest;
  for (const int node : loaded.node_of_joint) {
    const int parent = loaded.nodes.parents[node];
    names.push_back(loaded.model.nodes[node].name.c_str());
    parents.push_back(parent < 0 ? -1 : loaded.joint_of_node[parent]);
    rest.push_back(loaded.rest[node]);
  }
  const std::vector<std::int32_t> roles = roles_of(loaded);
  SdefSkeleton skeleton = superdeform::make<SdefSkeleton>();
  skeleton.joint_count = names.size();
  skeleton.names = names.data();
  skeleton.parents = parents.data();
  skeleton.rest_matrices = rest.empty() ? nullptr : rest[0].n.data();
  skeleton.rest_stride = sizeof(Matrix);
  skeleton.role_joints = roles.data();
  skeleton.role_count = SDEF_ROLE_COUNT;
  loaded.character.set_skeleton(skeleton);
}

void add_meshes(Loaded &loaded) {
  loaded.images.clear();
  for (const Part &part : loaded.parts) {
    SdefMesh mesh = part.arrays;
    if (!loaded.rigged) {
      mesh.influence_count = 0;
      mesh.joints = mesh.weights = nullptr;
      mesh.joint_stride = mesh.weight_stride = 0;
    }
    show(loaded, part, mesh);
    const std::uint32_t index = loaded.character.add_mesh(mesh);
    for (const SdefMorphTarget &target : part.targets) loaded.character.add_morph_target(index, target);
  }
}

// Whether the joints that a deformation needs are known.
bool has_roles(const superdeform::Character &character) {
  const std::vector<std::uint32_t> roles = character.joints().roles;
  for (const std::uint32_t role : {SDEF_ROLE_HIPS, SDEF_ROLE_HEAD, SDEF_ROLE_LEFT_UPPER_LEG, SDEF_ROLE_RIGHT_UPPER_LEG,
                                   SDEF_ROLE_LEFT_UPPER_ARM, SDEF_ROLE_RIGHT_UPPER_ARM})
    if (std::find(roles.begin(), roles.end(), role) == roles.end()) return false;
  return true;
}

} // namespace

void load(const std::string &path, Loaded &loaded) {
  loaded.path = path;
  loaded.model = read_gltf(path);
  loaded.nodes = read_nodes(loaded.model);
  for (const int node : loaded.nodes.order) {
    const int mesh = loaded.model.nodes[node].mesh;
    if (mesh < 0) continue;
    const int skin = loaded.model.nodes[node].skin;
    const auto &primitives = loaded.model.meshes.at(mesh).primitives;
    for (int primitive = 0; primitive < static_cast<int>(primitives.size()); primitive++) {
      if (attribute(primitives[primitive].attributes, "POSITION") < 0) continue;
      Part part;
      part.node = node;
      part.mesh = mesh;
      part.primitive = primitive;
      part.skin = attribute(primitives[primitive].attributes, "JOINTS_0") < 0 ? -1 : skin;
      part.name = name_of(loaded.model, part);
      loaded.parts.push_back(part);
    }
  }
  find_rest_pose(loaded);
  order_joints(loaded);
  for (Part &part : loaded.parts) set_arrays(loaded, part);

  loaded.rigged = true;
  set_skeleton(loaded);
  add_meshes(loaded);
  if (has_roles(loaded.character)) return;
  const auto &extensions = loaded.model.extensions;
  if (loaded.model.skins.empty() && extensions.count("VRM") == 0 && extensions.count("VRMC_vrm") == 0) {
    // The nodes are nothing but places for meshes.
    loaded.rigged = false;
    loaded.character = superdeform::Character::create();
    add_meshes(loaded);
  }
  loaded.character.rig();
}
