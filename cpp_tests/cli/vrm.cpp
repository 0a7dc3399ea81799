#include "vrm.hpp"

#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

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
  // Moves the vector there.
  void move(Value *vector, int node) const {
    const auto local = vector_of(vector);
    const auto moved = at(node, local.value_or(Vector{}));
    if (local && moved) set_vector(*vector, moved->first);
  }

  std::optional<std::uint32_t> joint(int node) const {
    if (node < 0 || node >= static_cast<int>(rest_.size()) || loaded_.joint_of_node[node] < 0) return std::nullopt;
    return static_cast<std::uint32_t>(loaded_.joint_of_node[node]);
  }

  // The end of a bone, with the radius that the bone's own node says.
  std::optional<SdefSpringBall> ball(int node, double radius) const {
    const auto owner = joint(node);
    if (!owner) return std::nullopt;
    auto made = superdeform::make<SdefSpringBall>();
    const Vector at = loaded_.rest[node].translation();
    made.joint = *owner, made.x = at[0], made.y = at[1], made.z = at[2], made.radius = radius * unit(node);
    return made;
  }

  // Moves a collider's points, its normal and its radius; `springs` are those that it is for.
  void move_collider(std::uint32_t kind, Value &body, int node, const std::vector<SdefSpringBall> &springs) const {
    const auto owner = joint(node);
    if (!owner || !body.IsObject()) return;
    const bool plane = kind == SDEF_COLLIDER_PLANE;
    Value *offset = member(&body, "offset"), *end = member(&body, plane ? "normal" : "tail");
    const Matrix &old = loaded_.rest[node], &now = rest_[node];
    const Vector first = old.move(vector_of(offset).value_or(Vector{}));
    const Vector normal = vector_of(end).value_or(Vector{0, 0, 1});
    const Vector second = plane ? old.inverse().turn_transposed(normal) : old.move(vector_of(end).value_or(Vector{}));
    Value *radius = member(&body, "radius");
    std::vector<std::uint32_t> named(springs.size());
    std::iota(named.begin(), named.end(), 0u);
    std::vector<SdefCollider> colliders(1, superdeform::make<SdefCollider>());
    SdefCollider &collider = colliders[0];
    collider.kind = kind, collider.joint = *owner;
    collider.springs = named.data(), collider.spring_count = static_cast<std::uint32_t>(named.size());
    collider.x = first[0], collider.y = first[1], collider.z = first[2];
    collider.end_x = second[0], collider.end_y = second[1], collider.end_z = second[2];
    collider.radius = radius != nullptr && radius->IsNumber() ? radius->GetNumberAsDouble() * unit(node) : 0;
    const double before = collider.radius;
    deformer_.map_colliders(colliders, springs);
    if (offset != nullptr) set_vector(*offset, now.inverse().move({collider.x, collider.y, collider.z}));
    const Vector moved{collider.end_x, collider.end_y, collider.end_z};
    if (kind == SDEF_COLLIDER_CAPSULE || kind == SDEF_COLLIDER_INSIDE_CAPSULE) {
      if (end != nullptr) set_vector(*end, now.inverse().move(moved));
    } else if (plane && end != nullptr) {
      const Vector turned = now.turn_transposed(moved);
      set_vector(*end, turned * (length(normal) / length(turned)));
    }
    if (before > 0) multiply(&body, "radius", collider.radius / before);
  }

private:
  // By how much lengths of a node's space are longer in model space.
  double unit(int node) const { return std::cbrt(std::fabs(loaded_.rest[node].determinant())); }

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
  // The springs of each collider, by way of groups.
  std::map<int, std::vector<SdefSpringBall>> guarded;
  each(member(&springs, "springs"), [&](Value &spring) {
    std::vector<SdefSpringBall> balls;
    Value *last = nullptr;
    each(member(&spring, "joints"), [&](Value &joint) {
      const Value *radius = last != nullptr ? member(last, "hitRadius") : nullptr;
      const double length = radius != nullptr && radius->IsNumber() ? radius->GetNumberAsDouble() : 0;
      const auto ball = field.ball(index_of(member(&joint, "node")), length);
      if (last != nullptr && ball) balls.push_back(*ball);
      last = &joint;
    });
    std::set<int> colliders;
    each(member(&spring, "colliderGroups"), [&](Value &index) {
      Value *groups = member(&springs, "colliderGroups");
      const int group = index_of(&index);
      if (groups == nullptr || group < 0 || group >= static_cast<int>(groups->ArrayLen())) return;
      each(member(&groups->Get<Value::Array>()[group], "colliders"), [&](Value &one) { colliders.insert(index_of(&one)); });
    });
    for (const int collider : colliders)
      guarded[collider].insert(guarded[collider].end(), balls.begin(), balls.end());
  });
  int index = 0;
  each(member(&springs, "colliders"), [&](Value &collider) {
    const int node = index_of(member(&collider, "node"));
    const std::vector<SdefSpringBall> &balls = guarded[index++];
    Value *extended = member(member(&collider, "extensions"), "VRMC_springBone_extended_collider");
    for (Value *shape : {member(&collider, "shape"), member(extended, "shape")}) {
      const auto move = [&](const char *name, std::uint32_t out, std::uint32_t in) {
        Value *body = member(shape, name);
        if (body == nullptr) return;
        const Value *inside = member(body, "inside");
        field.move_collider(inside != nullptr && inside->IsBool() && inside->Get<bool>() ? in : out, *body, node, balls);
      };
      move("sphere", SDEF_COLLIDER_SPHERE, SDEF_COLLIDER_INSIDE_SPHERE);
      move("capsule", SDEF_COLLIDER_CAPSULE, SDEF_COLLIDER_INSIDE_CAPSULE);
      move("plane", SDEF_COLLIDER_PLANE, SDEF_COLLIDER_PLANE);
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
  // The springs of each group of colliders.
  std::map<int, std::vector<SdefSpringBall>> guarded;
  each(member(animation, "boneGroups"), [&](Value &group) {
    // One set of numbers for several chains: the mean scale of all their joints.
    std::vector<bool> moved(loaded.rest.size());
    each(member(&group, "bones"), [&](Value &bone) {
      const int node = index_of(&bone);
      if (node >= 0 && node < static_cast<int>(moved.size())) moved[node] = true;
    });
    // A chain's first joint is the end of no bone.
    const std::vector<bool> roots = moved;
    const Value *radius = member(&group, "hitRadius");
    std::vector<SdefSpringBall> balls;
    double sum = 0;
    int count = 0;
    for (const int node : loaded.nodes.order) {
      const int parent = loaded.nodes.parents[node];
      if (parent >= 0 && moved[parent]) moved[node] = true;
      if (!moved[node]) continue;
      sum += field.scale(node), count++;
      const auto ball = field.ball(node, radius != nullptr && radius->IsNumber() ? radius->GetNumberAsDouble() : 0);
      if (ball && !roots[node]) balls.push_back(*ball);
    }
    each(member(&group, "colliderGroups"), [&](Value &index) {
      std::vector<SdefSpringBall> &all = guarded[index_of(&index)];
      all.insert(all.end(), balls.begin(), balls.end());
    });
    if (count == 0) return;
    // VRM 0.x spells it so.
    for (const char *key : {"hitRadius", "stiffiness", "gravityPower"}) multiply(&group, key, sum / count);
  });
  int index = 0;
  each(member(animation, "colliderGroups"), [&](Value &group) {
    const int node = index_of(member(&group, "node"));
    const std::vector<SdefSpringBall> &balls = guarded[index++];
    each(member(&group, "colliders"),
         [&](Value &collider) { field.move_collider(SDEF_COLLIDER_SPHERE, collider, node, balls); });
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
