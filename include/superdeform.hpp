// superdeform for C++17: superdeform.h with handles that destroy themselves, exceptions, views and lambdas.
//
//     auto character = superdeform::Character::create();
//     character.set_skeleton(skeleton);                     // SdefSkeleton, see superdeform.h
//     character.add_mesh(mesh);
//     superdeform::Deformer deformer(character, superdeform::Style::from_heads(2.5));
//     deformer.apply(results, [&](float fraction) { return window.closed(); });   // a vector of SdefMeshResult
//
// What each call does, takes and refuses stands in superdeform.h. Every status but SDEF_STATUS_OK is thrown as an Error. A
// progress function may return nothing, or true to cancel; what it throws comes out of the call that it was given to.
//
// Without exceptions (-fno-exceptions) nothing is thrown: a call that fails gives an empty handle, zeros or nothing, and
// superdeform::last_error() says why.
//
// A Character, Style or Deformer that is made of nothing is empty: it can be a member of a class and be given another later.
// The names of this file are not those of macros that engines and systems are known for (check, verify, near, min).

#ifndef SUPERDEFORM_HPP
#define SUPERDEFORM_HPP

#include "superdeform.h"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define SUPERDEFORM_EXCEPTIONS 1
#include <exception>
#include <stdexcept>
#else
#define SUPERDEFORM_EXCEPTIONS 0
#endif

namespace superdeform {

#if SUPERDEFORM_EXCEPTIONS
using ErrorBase = std::runtime_error;
#else
class ErrorBase {
public:
  explicit ErrorBase(std::string message) : message_(std::move(message)) {}
  const char *what() const noexcept { return message_.c_str(); }

private:
  std::string message_;
};
#endif

// What a call that failed says.
class Error : public ErrorBase {
public:
  Error(SdefStatus status, const std::string &message, std::uint32_t mesh = SDEF_NONE,
        std::uint32_t element = SDEF_NONE, std::uint32_t element_kind = SDEF_ELEMENT_NONE)
      : ErrorBase(message), status_(status), mesh_(mesh), element_(element), element_kind_(element_kind) {}

  SdefStatus status() const noexcept { return status_; }      // SDEF_STATUS_*
  std::uint32_t mesh() const noexcept { return mesh_; }       // the mesh concerned, or SDEF_NONE
  std::uint32_t element() const noexcept { return element_; } // its vertex, triangle or another element, or SDEF_NONE
  std::uint32_t element_kind() const noexcept { return element_kind_; } // SDEF_ELEMENT_*

private:
  SdefStatus status_;
  std::uint32_t mesh_, element_, element_kind_;
};

// Elements of somebody else's: std::span as far as it is needed here. Made from a pointer and a count, from an array,
// or from a container such as std::vector; empty stands for an array that is left out.
template <class T> class View {
public:
  View() noexcept = default;
  View(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
  template <class Container,
            class = std::enable_if_t<std::is_convertible_v<
                std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))> (*)[], T (*)[]>>>
  View(Container &&container) : data_(std::data(container)), size_(std::size(container)) {}

  T *data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  T *begin() const noexcept { return data_; }
  T *end() const noexcept { return data_ + size_; }
  T &operator[](std::size_t index) const { return data_[index]; }

private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

#if !SUPERDEFORM_EXCEPTIONS
// Why the last call of this thread that failed did so; SDEF_STATUS_OK before there is one, or after it was taken back:
// last_error() = {SDEF_STATUS_OK, ""}. Calls on an empty handle leave the reason why it is empty, so a chain of calls is
// checked once, at its end.
inline Error &last_error() {
  static thread_local Error error(SDEF_STATUS_OK, "");
  return error;
}
#endif

namespace detail {

inline void fail(Error error) {
#if SUPERDEFORM_EXCEPTIONS
  throw error;
#else
  last_error() = std::move(error);
#endif
}

inline void expect_ok(SdefStatus status, const SdefError &error) {
  if (status != SDEF_STATUS_OK) fail({status, error.message, error.mesh, error.element, error.element_kind});
}

// Refuses a library of another ABI.
inline bool check_version() {
  static const std::uint32_t version = sdef_abi_version();
  if (version == SDEF_ABI_VERSION) return true;
  fail({SDEF_STATUS_BAD_ARGUMENT, "superdeform.hpp is for version " + std::to_string(SDEF_ABI_VERSION) +
                                      " of the ABI, but the library has version " + std::to_string(version) +
                                      ": take both from one release"});
  return false;
}

// Is there a reason why this handle is empty? Then a call on it has nothing to add.
template <class Argument> bool is_empty_since([[maybe_unused]] const Argument &argument) {
#if !SUPERDEFORM_EXCEPTIONS
  if constexpr (std::is_same_v<Argument, SdefCharacter> || std::is_same_v<Argument, SdefStyle> ||
                std::is_same_v<Argument, SdefDeformer>)
    return argument.id == 0 && last_error().status() != SDEF_STATUS_OK;
#endif
  return false;
}

// Calls a function of the ABI, which gets `arguments` and the error.
template <class Function, class... Arguments> void call(Function function, Arguments... arguments) {
  if (!check_version()) return;
  SdefError error = SDEF_ERROR_INIT;
  const SdefStatus status = function(arguments..., &error);
  if (status == SDEF_STATUS_BAD_HANDLE && (is_empty_since(arguments) || ...)) return;
  expect_ok(status, error);
}

// What a progress function returns, as the library reads it.
template <class Progress> std::int32_t asks_to_stop(Progress &progress, float fraction) {
  if constexpr (std::is_void_v<std::invoke_result_t<Progress &, float>>) {
    progress(fraction);
    return 0;
  } else {
    return progress(fraction) ? 1 : 0;
  }
}

// The same with a progress function: no exception may cross the library, so it waits until the call is over.
template <class Progress, class Function, class... Arguments>
void call_with_progress(Progress &&progress, Function function, Arguments... arguments) {
  if constexpr (std::is_null_pointer_v<std::decay_t<Progress>>) {
    call(function, arguments..., SdefProgress(nullptr), static_cast<void *>(nullptr));
  } else {
#if SUPERDEFORM_EXCEPTIONS
    struct State {
      std::remove_reference_t<Progress> &progress;
      std::exception_ptr thrown;
    } state{progress, nullptr};
    const auto trampoline = [](void *user, float fraction) -> std::int32_t {
      State &called = *static_cast<State *>(user);
      try {
        return asks_to_stop(called.progress, fraction);
      } catch (...) {
        called.thrown = std::current_exception();
        return 1;
      }
    };
    check_version();
    SdefError error = SDEF_ERROR_INIT;
    const SdefStatus status = function(arguments..., SdefProgress(trampoline), static_cast<void *>(&state), &error);
    if (state.thrown) std::rethrow_exception(state.thrown);
    expect_ok(status, error);
#else
    using Called = std::remove_reference_t<Progress>;
    const auto trampoline = [](void *user, float fraction) -> std::int32_t {
      return asks_to_stop(*static_cast<Called *>(user), fraction);
    };
    call(function, arguments..., SdefProgress(trampoline), static_cast<void *>(&progress));
#endif
  }
}

// Text of a function that tells how much room it needs. What it writes of may change in between.
template <class Raw, class Function> std::string text(Raw of, Function function) {
  std::string text;
  std::size_t size = 0;
  call([&](Raw, SdefError *error) { return function(static_cast<char *>(nullptr), std::size_t(0), &size, error); }, of);
  if (of.id == 0) return text;
  for (;;) {
    text.resize(size);
    SdefError error = SDEF_ERROR_INIT;
    const SdefStatus status = function(text.data(), text.size(), &size, &error);
    if (status == SDEF_STATUS_BUFFER_TOO_SMALL && size > text.size()) continue;
    expect_ok(status, error);
    text.resize(size == 0 ? 0 : size - 1);
    return text;
  }
}

inline bool check_size(const char *name, std::size_t size, std::size_t needed) {
  if (size == needed) return true;
  fail({SDEF_STATUS_BAD_ARGUMENT,
        std::string(name) + " has " + std::to_string(size) + " numbers: give " + std::to_string(needed)});
  return false;
}

// The owner of a handle.
template <class Raw> class Handle {
public:
  Handle() noexcept = default;
  explicit Handle(Raw raw) noexcept : raw_(raw) {}
  Handle(Handle &&other) noexcept : raw_(other.release()) {}
  Handle &operator=(Handle &&other) noexcept {
    if (this != &other) reset(other.release());
    return *this;
  }
  ~Handle() { reset(); }

  Raw get() const noexcept { return raw_; }
  std::uint64_t id() const noexcept { return raw_.id; }
  explicit operator bool() const noexcept { return raw_.id != 0; }

  // Gives the handle away: who calls sdef_destroy is the caller's business from then on.
  Raw release() noexcept { return std::exchange(raw_, Raw{0}); }

  // Destroys what it holds and holds another.
  void reset(Raw raw = Raw{0}) noexcept {
    if (raw_.id != 0) sdef_destroy(raw_.id, nullptr);
    raw_ = raw;
  }

protected:
  Raw raw_{0};
};

} // namespace detail

// A struct with everything 0 but its struct_size: make<SdefMesh>().
template <class T> T make() {
  T made{};
  made.struct_size = static_cast<std::uint32_t>(sizeof(T));
  return made;
}

// The options with their defaults.
struct Options : SdefOptions {
  Options() : SdefOptions() {
    detail::call(sdef_options_init, static_cast<SdefOptions *>(this), static_cast<std::uint32_t>(sizeof(SdefOptions)));
  }
};

// Settings of a bone group of which none is set yet.
struct GroupSettings : SdefGroupSettings {
  explicit GroupSettings(const char *name) : SdefGroupSettings(SDEF_GROUP_SETTINGS_INIT) { group = name; }
};

// The library's release, such as "1.0.0-rc.1".
inline const char *version() {
  detail::check_version();
  return sdef_version();
}

// How many handles there are that nobody has destroyed.
inline std::uint64_t live_handles() {
  detail::check_version();
  return sdef_live_handles();
}

// The name of a status.
inline const char *status_name(SdefStatus status) {
  detail::check_version();
  return sdef_status_name(status);
}

// Whether the library wants a morph target of this name with the character, as it does blinks; nullptr is none.
inline bool morph_target_is_read(const char *name) {
  detail::check_version();
  return sdef_morph_target_is_read(name) != 0;
}

// The warnings about the rig and the roles of a character, or about a deformer and all before it.
template <class Raw> std::string warnings(const detail::Handle<Raw> &handle) {
  return detail::text(handle.get(), [&](char *text, std::size_t capacity, std::size_t *size, SdefError *error) {
    return sdef_get_warnings(handle.id(), text, capacity, size, error);
  });
}

// A character: meshes, joints, weights.
class Character : public detail::Handle<SdefCharacter> {
public:
  // Joints as arrays: own ones first, then those of a made rig.
  struct Joints {
    std::vector<std::int32_t> parents;
    std::vector<std::uint32_t> roles;
    std::vector<double> rest_matrices; // 16 a joint
    std::vector<double> confidence;
  };

  Character() noexcept = default;
  // Takes a handle over.
  explicit Character(SdefCharacter raw) noexcept : Handle(raw) {}

  // One without meshes and joints. up, forward: 3 floats each; NULL as in sdef_character_create.
  static Character create(const float *up = nullptr, const float *forward = nullptr) {
    Character character;
    detail::call(sdef_character_create, up, forward, &character.raw_);
    return character;
  }

  void set_skeleton(const SdefSkeleton &skeleton) { detail::call(sdef_character_set_skeleton, raw_, &skeleton); }

  std::uint32_t add_mesh(const SdefMesh &mesh) {
    std::uint32_t index = SDEF_NONE;
    detail::call(sdef_character_add_mesh, raw_, &mesh, &index);
    return index;
  }

  // Gives the number that SdefMesh's image names it by.
  std::uint32_t add_image(const SdefImage &image) {
    std::uint32_t number = 0;
    detail::call(sdef_character_add_image, raw_, &image, &number);
    return number;
  }

  void set_face_hints(const SdefFaceHints &hints) { detail::call(sdef_character_set_face_hints, raw_, &hints); }

  void add_morph_target(std::uint32_t mesh, const SdefMorphTarget &target) {
    detail::call(sdef_character_add_morph_target, raw_, mesh, &target);
  }

  // Finds joints and weights.
  template <class Progress = std::nullptr_t>
  void rig(const SdefOptions &options = Options(), Progress &&progress = Progress()) {
    detail::call_with_progress(std::forward<Progress>(progress), sdef_character_rig, raw_, &options);
  }

  SdefCharacterInfo info() const {
    SdefCharacterInfo info = make<SdefCharacterInfo>();
    detail::call(sdef_character_get_info, raw_, &info);
    return info;
  }

  Joints joints() const {
    std::size_t count = info().joint_count;
    Joints joints{std::vector<std::int32_t>(count), std::vector<std::uint32_t>(count), std::vector<double>(16 * count),
                  std::vector<double>(count)};
    detail::call(sdef_character_get_joints, raw_, joints.parents.data(), joints.roles.data(),
                 joints.rest_matrices.data(), joints.confidence.data(), count, &count);
    return joints;
  }

  // The weights that animate a mesh: influence_count numbers a vertex in each array.
  void weights(std::uint32_t mesh, std::uint32_t influence_count, View<std::uint32_t> joints,
               View<float> weights) const {
    if (!detail::check_size("joints", joints.size(), weights.size())) return;
    const std::size_t capacity = influence_count == 0 ? 0 : weights.size() / influence_count;
    detail::call(sdef_character_get_weights, raw_, mesh, influence_count, joints.data(), weights.data(), capacity);
  }

  std::string warnings() const { return superdeform::warnings(*this); }
};

// What a character should become.
class Style : public detail::Handle<SdefStyle> {
public:
  Style() noexcept = default;
  // Takes a handle over.
  explicit Style(SdefStyle raw) noexcept : Handle(raw) {}

  static Style from_heads(double heads) { return from_heads_like(heads, SdefStyle{0}); }
  static Style from_heads(double heads, const Style &like) { return from_heads_like(heads, like.get()); }

  static Style from_text(std::string_view text) {
    Style style;
    detail::call(sdef_style_from_text, text.data(), text.size(), &style.raw_);
    return style;
  }

  // name: may be NULL
  static Style measure(const Character &character, const char *name = nullptr,
                       const SdefOptions &options = Options()) {
    Style style;
    detail::call(sdef_style_measure, character.get(), name, &options, &style.raw_);
    return style;
  }

  static Style from_numbers(const SdefStyleNumbers &numbers, View<const SdefBone> bones, const char *name = nullptr) {
    Style style;
    detail::call(sdef_style_from_numbers, name, &numbers, bones.data(), bones.size(), &style.raw_);
    return style;
  }

  static Style blend(const Style &first, const Style &second, double amount) {
    Style style;
    detail::call(sdef_style_blend, first.raw_, second.raw_, amount, &style.raw_);
    return style;
  }

  SdefStyleNumbers numbers() const {
    SdefStyleNumbers numbers = make<SdefStyleNumbers>();
    detail::call(sdef_style_get_numbers, raw_, &numbers, static_cast<SdefBone *>(nullptr), std::size_t(0),
                 static_cast<std::size_t *>(nullptr));
    return numbers;
  }

  std::vector<SdefBone> bones() const {
    std::size_t count = 0;
    detail::call(sdef_style_get_numbers, raw_, static_cast<SdefStyleNumbers *>(nullptr),
                 static_cast<SdefBone *>(nullptr), std::size_t(0), &count);
    std::vector<SdefBone> bones(count, make<SdefBone>());
    detail::call(sdef_style_get_numbers, raw_, static_cast<SdefStyleNumbers *>(nullptr), bones.data(), bones.size(),
                 &count);
    return bones;
  }

  std::string to_json() const {
    return detail::text(raw_, [&](char *text, std::size_t capacity, std::size_t *size, SdefError *error) {
      return sdef_style_to_json(raw_, text, capacity, size, error);
    });
  }

private:
  static Style from_heads_like(double heads, SdefStyle like) {
    Style style;
    detail::call(sdef_style_from_heads, heads, like, &style.raw_);
    return style;
  }
};

// A character together with the deformation that gives it a style.
class Deformer : public detail::Handle<SdefDeformer> {
public:
  // Joints after the deformation.
  struct Joints {
    std::vector<double> positions;     // 3 a joint
    std::vector<double> inverse_binds; // 16 a joint
  };

  Deformer() noexcept = default;
  template <class Progress = std::nullptr_t>
  Deformer(const Character &character, const Style &style, const SdefOptions &options = Options(),
           Progress &&progress = Progress()) {
    detail::call_with_progress(
        std::forward<Progress>(progress),
        [&](SdefCharacter of, SdefStyle as, SdefProgress callback, void *user, SdefError *error) {
          return sdef_deformer_create(of, as, &options, callback, user, &raw_, error);
        },
        character.get(), style.get());
  }
  // Takes a handle over.
  explicit Deformer(SdefDeformer raw) noexcept : Handle(raw) {}

  template <class Progress = std::nullptr_t>
  void set_options(const SdefOptions &options, Progress &&progress = Progress()) {
    detail::call_with_progress(std::forward<Progress>(progress), sdef_deformer_set_options, raw_, &options);
  }

  template <class Progress = std::nullptr_t>
  void set_style(const Style &style, Progress &&progress = Progress()) {
    detail::call_with_progress(std::forward<Progress>(progress), sdef_deformer_set_style, raw_, style.get());
  }

  // results: one for each mesh of the character
  template <class Progress = std::nullptr_t>
  void apply(View<const SdefMeshResult> results, Progress &&progress = Progress()) const {
    detail::call_with_progress(std::forward<Progress>(progress), sdef_deformer_apply, raw_, results.data(),
                               results.size());
  }

  Joints joints() const {
    std::size_t count = 0;
    detail::call(sdef_deformer_get_joints, raw_, static_cast<double *>(nullptr), static_cast<double *>(nullptr),
                 std::size_t(0), &count);
    Joints joints{std::vector<double>(3 * count), std::vector<double>(16 * count)};
    detail::call(sdef_deformer_get_joints, raw_, joints.positions.data(), joints.inverse_binds.data(), count, &count);
    return joints;
  }

  // joints: one a point; points, positions: 3 numbers a point; scales: one; jacobians: 9. What is empty is left out.
  void map_points(View<const std::uint32_t> joints, View<const double> points, View<double> positions,
                  View<double> scales = {}, View<double> jacobians = {}) const {
    const std::size_t count = joints.size();
    const bool fits = detail::check_size("points", points.size(), 3 * count) &&
                      (positions.empty() || detail::check_size("positions", positions.size(), 3 * count)) &&
                      (scales.empty() || detail::check_size("scales", scales.size(), count)) &&
                      (jacobians.empty() || detail::check_size("jacobians", jacobians.size(), 9 * count));
    if (!fits) return;
    detail::call(sdef_deformer_map_points, raw_, joints.data(), points.data(), count, positions.data(), scales.data(),
                 jacobians.data());
  }

  // In place: each collider becomes what it is after the deformation. springs: what their springs name; may be empty.
  void map_colliders(std::vector<SdefCollider> &colliders, const std::vector<SdefSpringBall> &springs = {}) const {
    detail::call(sdef_deformer_map_colliders, raw_, colliders.data(), colliders.size(), springs.data(), springs.size(),
                 colliders.data());
  }

  // In place: how many vertices each target changes, these vertices, and 3 numbers for each of them.
  void map_morph_targets(std::uint32_t mesh, View<const std::uint32_t> vertex_counts,
                         View<const std::uint32_t> vertices, View<float> positions, View<float> normals = {},
                         View<float> tangents = {}) const {
    std::size_t changes = 0;
    for (std::size_t target = 0; target < vertex_counts.size(); ++target) changes += vertex_counts.data()[target];
    const bool fits = detail::check_size("vertices", vertices.size(), changes) &&
                      detail::check_size("positions", positions.size(), 3 * changes) &&
                      (normals.empty() || detail::check_size("normals", normals.size(), 3 * changes)) &&
                      (tangents.empty() || detail::check_size("tangents", tangents.size(), 3 * changes));
    if (!fits) return;
    detail::call(sdef_deformer_map_morph_targets, raw_, mesh, vertex_counts.data(), vertex_counts.size(),
                 vertices.data(), positions.data(), normals.data(), tangents.data());
  }

  std::vector<SdefGroup> groups() const {
    std::size_t count = 0;
    detail::call(sdef_deformer_get_groups, raw_, static_cast<SdefGroup *>(nullptr), std::size_t(0), &count);
    std::vector<SdefGroup> groups(count, make<SdefGroup>());
    detail::call(sdef_deformer_get_groups, raw_, groups.data(), groups.size(), &count);
    return groups;
  }

  // Measures the result, with progress: figure, report and report_json would do so without.
  template <class Progress = std::nullptr_t> void measure(Progress &&progress = Progress()) const {
    detail::call_with_progress(std::forward<Progress>(progress), sdef_deformer_measure, raw_);
  }

  // which: SDEF_FIGURE_*
  SdefFigure figure(std::uint32_t which) const {
    SdefFigure figure = make<SdefFigure>();
    detail::call(sdef_deformer_get_figure, raw_, which, &figure);
    return figure;
  }

  SdefReport report() const {
    SdefReport report = make<SdefReport>();
    detail::call(sdef_deformer_get_report, raw_, &report, static_cast<char *>(nullptr), std::size_t(0),
                 static_cast<std::size_t *>(nullptr));
    return report;
  }

  std::string report_json() const {
    return detail::text(raw_, [&](char *text, std::size_t capacity, std::size_t *size, SdefError *error) {
      return sdef_deformer_get_report(raw_, nullptr, text, capacity, size, error);
    });
  }

  std::string warnings() const { return superdeform::warnings(*this); }
};

// Has jobs do the work of all calls that this thread makes from now on; a null pointer: threads of the library's own again.
// It must not throw.
inline void set_jobs(SdefJobs jobs, void *user = nullptr) { detail::call(sdef_set_jobs, jobs, user); }

// Deforms meshes in one call. skeleton: NULL makes a rig. up, forward: NULL as in sdef_character_create.
template <class Progress = std::nullptr_t>
void super_deform(const SdefSkeleton *skeleton, View<const SdefMesh> meshes, const Style &style,
                  View<const SdefMeshResult> results, const SdefOptions &options = Options(),
                  Progress &&progress = Progress(), const float *up = nullptr, const float *forward = nullptr) {
  if (!detail::check_size("results", results.size(), meshes.size())) return;
  detail::call_with_progress(std::forward<Progress>(progress), sdef_super_deform, up, forward, skeleton, meshes.data(),
                             meshes.size(), style.get(), &options, results.data());
}

} // namespace superdeform

#endif // SUPERDEFORM_HPP
