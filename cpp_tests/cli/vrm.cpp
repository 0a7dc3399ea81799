#include "vrm.hpp"

#include <cmath>
#include <optional>

namespace {

using tinygltf::Value;

// The member `key` of an object, or NULL.
Value *member(Value *value, const char *key) {
  if (value == nullptr || !value->IsObject()) return nullptr;
  auto &members = value->Get<Value::Object>();
  const auto found = members.find(key);
  return found == members.end() ? nullptr : &found->second;
}

// Calls `visit` with each entry of an array.
template <class Visit> void each(Value *array, Visit visit) {
  if (array == nullptr || !array->IsArray()) return;
  for (Value &entry : array->Get<Value::Array>()) visit(entry);
}

int index_of(Value *value) { return value != nullptr && value->IsNumber() ? value->GetNumberAsInt() : -1; }

void multiply(Value *holder, const char *key, double factor, double otherwise = 0) {
  if (holder == nullptr || !holder->IsObject()) return;
  Value *number = member(holder, key);
  const double before = number != nullptr && number->IsNumber() ? number->GetNumberAsDouble() : otherwise;
  if (before != 0) holder->Get<Value::Object>()[key] = Value(before * factor);
}

// A vector as an array (VRM 1.0) or as x, y, z (VRM 0.x, whose z is negated against the node's own).
std::optional<Vector> vector_of(const Value *value) {
  Vector made{};
  const char *const keys[] = {"x", "y", "z"};
  if (value == nullptr) return std::nullopt;
  for (int i = 0; i < 3; i++) {
    const Value &number = value->IsArray() ? value->Get(i) : value->Get(keys[i]);
    if (!number.IsNumber()) return std::nullopt;
    made[i] = number.GetNumberAsDouble();
  }
  if (value->IsObject()) made[2] = -made[2];
  return made;
}

void set_vector(Value &value, Vector to) {
  if (value.IsArray()) {
    value = Value(Value::Array{Value(to[0]), Value(to[1]), Value(to[2])});
  } else {
    auto &members = value.Get<Value::Object>();
    members["x"] = Value(to[0]), members["y"] = Value(to[1]), members["z"] = Value(-to[2]);
  }
}

class Field {
public:
  Field(Loaded &loaded, const superdeform::Deformer &deformer, const std::vector<Matrix> &rest)
      : loaded_(loaded), deformer_(deformer), rest_(rest) {}

  // Where a point of a node's space goes, in the moved node's space, and by how much what is there grows.
  std::optional<std::pair<Vector, double>> at(int node, const Vector &local) const {
    if (node < 0 || node >= static_cast<int>(rest_.size()) || loaded_.joint_of_node[node] < 0) return std::nullopt;
    const auto joint = static_cast<std::uint32_t>(loaded_.joint_of_node[node]);
    const Vector point = loaded_.rest[node].move(local);
    Vector moved{};
    double scale = 1;
    deformer_.map_points({&joint, 1}, point, moved, {&scale, 1});
    return std::make_pair(rest_[node].inverse().move(moved), scale);
  }
  double scale(int node) const {
    const auto found = at(node, {});
    return found ? found->second : 1;
  }
  // Moves the vector there; gives the scale.
  double move(Value *vector, int node) const {
    const auto local = vector_of(vector);
    const auto moved = at(node, local.value_or(Vector{}));
    if (local && moved) set_vector(*vector, moved->first);
    return moved ? moved->second : 1;
  }

private:
  Loaded &loaded_;
  const superdeform::Deformer &deformer_;
  const std::vector<Matrix> &rest_;
};

int head_of(const Loaded &loaded) {
  const std::vector<std::uint32_t> roles = loaded.character.joints().roles;
  for (std::size_t joint = 0; joint < loaded.node_of_joint.size(); joint++)
    if (roles[joint] == SDEF_ROLE_HEAD) return loaded.node_of_joint[joint];
  return -1;
}

// VRM 1.0
void move_springs(Value &springs, const Field &field) {
  each(member(&springs, "colliders"), [&](Value &collider) {
    const int node = index_of(member(&collider, "node"));
    Value *shape = member(&collider, "shape");
    if (Value *sphere = member(shape, "sphere"))
      multiply(sphere, "radius", field.move(member(sphere, "offset"), node));
    if (Value *capsule = member(shape, "capsule")) {
      const double one = field.move(member(capsule, "offset"), node), other = field.move(member(capsule, "tail"), node);
      multiply(capsule, "radius", std::sqrt(one * other));
    }
  });
  each(member(&springs, "springs"), [&](Value &spring) {
    each(member(&spring, "joints"), [&](Value &joint) {
      const double scale = field.scale(index_of(member(&joint, "node")));
      multiply(&joint, "hitRadius", scale);
      // The step of a spring is stiffness and gravity in model units: only scaled does it swing the same.
      multiply(&joint, "stiffness", scale, 1);
      multiply(&joint, "gravityPower", scale);
    });
  });
}

// VRM 0.x
void move_secondary(const Loaded &loaded, Value *animation, const Field &field) {
  each(member(animation, "colliderGroups"), [&](Value &group) {
    const int node = index_of(member(&group, "node"));
    each(member(&group, "colliders"), [&](Value &collider) {
      multiply(&collider, "radius", field.move(member(&collider, "offset"), node));
    });
  });
  each(member(animation, "boneGroups"), [&](Value &group) {
    // One set of numbers for several chains: the mean scale of all their joints.
    std::vector<bool> moved(loaded.rest.size());
    each(member(&group, "bones"), [&](Value &bone) {
      const int node = index_of(&bone);
      if (node >= 0 && node < static_cast<int>(moved.size())) moved[node] = true;
    });
    double sum = 0;
    int count = 0;
    for (const int node : loaded.nodes.order) {
      const int parent = loaded.nodes.parents[node];
      if (parent >= 0 && moved[parent]) moved[node] = true;
      if (moved[node]) sum += field.scale(node), count++;
    }
    if (count == 0) return;
    // VRM 0.x spells it so.
    for (const char *key : {"hitRadius", "stiffiness", "gravityPower"}) multiply(&group, key, sum / count);
  });
}

} // namespace

void move_points(Loaded &loaded, const superdeform::Deformer &deformer, const std::vector<Matrix> &rest) {
  const Field field(loaded, deformer, rest);
  auto &extensions = loaded.model.extensions;
  const auto extension = [&](const char *name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
  };
  if (Value *vrm = extension("VRMC_vrm")) field.move(member(member(vrm, "lookAt"), "offsetFromHeadBone"), head_of(loaded));
  if (Value *springs = extension("VRMC_springBone")) move_springs(*springs, field);
  if (Value *vrm = extension("VRM")) {
    Value *view = member(vrm, "firstPerson");
    const int bone = index_of(member(view, "firstPersonBone"));
    field.move(member(view, "firstPersonBoneOffset"), bone >= 0 ? bone : head_of(loaded));
    move_secondary(loaded, member(vrm, "secondaryAnimation"), field);
  }
}
