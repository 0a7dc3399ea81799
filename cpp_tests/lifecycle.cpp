// Handles, capacities, struct sizes and statuses: what a host can get wrong ends in a status and nothing worse.
#include "hosts.hpp"

#include <cmath>
#include <limits>
#include <random>

static SdefError error = SDEF_ERROR_INIT;

static std::uint64_t new_character() {
  SdefCharacter made{0};
  OK(sdef_character_create(nullptr, nullptr, &made, &error));
  return made.id;
}

static void a_handle_is_destroyed_once() {
  const std::uint64_t id = new_character();
  OK(sdef_destroy(id, &error));
  GIVES(SDEF_STATUS_BAD_HANDLE, sdef_destroy(id, &error));
  GIVES(SDEF_STATUS_BAD_HANDLE, sdef_destroy(id, nullptr));
  CHECK(std::strlen(error.message) > 10 && error.status == SDEF_STATUS_BAD_HANDLE);
  // The place may be taken again, the handle is not.
  for (int i = 0; i < 100; i++) {
    const std::uint64_t other = new_character();
    CHECK(other != id);
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_destroy(id, &error));
    SdefCharacterInfo info = superdeform::make<SdefCharacterInfo>();
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_character_get_info(SdefCharacter{id}, &info, &error));
    OK(sdef_destroy(other, &error));
  }
}

static void made_up_handles_are_refused() {
  const superdeform::Character kept = character();
  std::mt19937_64 random(1);
  std::vector<std::uint64_t> ids{1, 2, ~std::uint64_t(0), std::uint64_t(1) << 63, kept.id() + 1, kept.id() ^ 1};
  for (int i = 0; i < 10000; i++) ids.push_back(random());
  for (int bit = 0; bit < 64; bit++) ids.push_back(kept.id() ^ (std::uint64_t(1) << bit));
  for (const std::uint64_t id : ids) {
    if (id == kept.id()) continue;
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_destroy(id, &error));
  }
  CHECK(kept.info().mesh_count == 1);
}

static void handles_of_another_kind_are_refused() {
  const superdeform::Character made = character();
  const superdeform::Style style = superdeform::Style::from_heads(2.5);
  const superdeform::Deformer deformer(made, style);
  Positions positions;
  SdefDeformer out{0};
  SdefStyle out_style{0};
  size_t size = 0;
  for (const std::uint64_t id : {style.id(), deformer.id(), std::uint64_t(0)}) {
    const SdefCharacter wrong{id};
    SdefCharacterInfo info = superdeform::make<SdefCharacterInfo>();
    std::uint32_t joint = 0;
    float weight = 0;
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_character_set_skeleton(wrong, &figure().skeleton, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_character_add_mesh(wrong, &figure().mesh, nullptr, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_character_add_morph_target(wrong, 0, &figure().target, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_character_get_info(wrong, &info, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE,
          sdef_character_get_joints(wrong, nullptr, nullptr, nullptr, nullptr, 0, &size, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_character_get_weights(wrong, 0, 1, &joint, &weight, 1, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_character_rig(wrong, nullptr, nullptr, nullptr, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_style_measure(wrong, nullptr, nullptr, &out_style, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_create(wrong, style.get(), nullptr, nullptr, nullptr, &out, &error));
  }
  for (const std::uint64_t id : {made.id(), deformer.id(), std::uint64_t(0)}) {
    const SdefStyle wrong{id};
    if (id != 0) GIVES(SDEF_STATUS_BAD_HANDLE, sdef_style_from_heads(2, wrong, &out_style, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_style_blend(style.get(), wrong, 0.5, &out_style, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_style_get_numbers(wrong, nullptr, nullptr, 0, &size, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_style_to_json(wrong, nullptr, 0, &size, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_create(made.get(), wrong, nullptr, nullptr, nullptr, &out, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_super_deform(nullptr, nullptr, &figure().skeleton, &figure().mesh, 1, wrong,
                                                    nullptr, &positions.result, nullptr, nullptr, &error));
  }
  for (const std::uint64_t id : {made.id(), style.id(), std::uint64_t(0)}) {
    const SdefDeformer wrong{id};
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_set_options(wrong, nullptr, nullptr, nullptr, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_set_style(wrong, style.get(), nullptr, nullptr, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_apply(wrong, &positions.result, 1, nullptr, nullptr, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_get_joints(wrong, nullptr, nullptr, 0, &size, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE,
          sdef_deformer_map_points(wrong, nullptr, nullptr, 0, nullptr, nullptr, nullptr, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_get_groups(wrong, nullptr, 0, &size, &error));
    GIVES(SDEF_STATUS_BAD_HANDLE, sdef_deformer_get_report(wrong, nullptr, nullptr, 0, &size, &error));
  }
  GIVES(SDEF_STATUS_BAD_HANDLE, sdef_get_warnings(style.id(), nullptr, 0, &size, &error));
  GIVES(SDEF_STATUS_BAD_HANDLE, sdef_get_warnings(0, nullptr, 0, &size, &error));
  CHECK(out.id == 0 && out_style.id == 0);
}

static void what_a_deformer_needs_outlives_its_makers() {
  superdeform::Character made = character();
  superdeform::Style style = superdeform::Style::from_heads(2.5);
  const superdeform::Deformer deformer(made, style);
  const std::vector<float> before = deformed(deformer);
  made.add_mesh(figure().mesh);
  CHECK(deformed(deformer) == before);
  made.reset();
  style.reset();
  CHECK(deformed(deformer) == before);
  CHECK(deformer.figure(SDEF_FIGURE_TARGET).heads > 5);
}

static void arrays_that_are_too_small_are_not_written() {
  const superdeform::Character made = character();
  const superdeform::Deformer deformer(made, superdeform::Style::from_text("sd2"));
  std::vector<std::int32_t> parents(FIGURE_PARTS, 77);
  size_t count = 0;
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL, sdef_character_get_joints(made.get(), parents.data(), nullptr, nullptr, nullptr,
                                                                FIGURE_PARTS - 1, &count, &error));
  CHECK(count == FIGURE_PARTS && parents == std::vector<std::int32_t>(FIGURE_PARTS, 77));
  OK(sdef_character_get_joints(made.get(), nullptr, nullptr, nullptr, nullptr, 0, &count, &error));

  std::vector<std::uint32_t> joints(FIGURE_VERTICES, 77);
  std::vector<float> weights(FIGURE_VERTICES, 77);
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL, sdef_character_get_weights(made.get(), 0, 1, joints.data(), weights.data(),
                                                                 FIGURE_VERTICES - 1, &error));
  CHECK(joints[0] == 77 && weights[0] == 77);
  CHECK(std::string(error.message).find(std::to_string(FIGURE_VERTICES)) != std::string::npos);

  Positions positions;
  positions.result.vertex_capacity = FIGURE_VERTICES - 1;
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL,
        sdef_deformer_apply(deformer.get(), &positions.result, 1, nullptr, nullptr, &error));
  CHECK(error.mesh == 0 && positions.numbers == std::vector<float>(3 * FIGURE_VERTICES));
  positions.result.vertex_capacity = FIGURE_VERTICES;
  std::vector<float> morph(3 * FIGURE_VERTICES, 77);
  positions.result.morph_positions = morph.data();
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL,
        sdef_deformer_apply(deformer.get(), &positions.result, 1, nullptr, nullptr, &error));
  positions.result.morph_target_capacity = 1;
  OK(sdef_deformer_apply(deformer.get(), &positions.result, 1, nullptr, nullptr, &error));
  CHECK(morph[0] == 0);

  std::vector<double> places(3 * FIGURE_PARTS, 77);
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL,
        sdef_deformer_get_joints(deformer.get(), places.data(), nullptr, FIGURE_PARTS - 1, &count, &error));
  CHECK(places[0] == 77);
  SdefGroup group = superdeform::make<SdefGroup>();
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL, sdef_deformer_get_groups(deformer.get(), &group, 1, &count, &error));
  CHECK(count > 1 && group.name[0] == 0);
  char text[8] = "before";
  size_t size = 0;
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL,
        sdef_deformer_get_report(deformer.get(), nullptr, text, sizeof text, &size, &error));
  CHECK(size > sizeof text && std::string(text) == "before");
  const superdeform::Style style = superdeform::Style::from_text("sd2");
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL, sdef_style_to_json(style.get(), text, sizeof text, &size, &error));
  CHECK(size > sizeof text && std::string(text) == "before");
  SdefBone bone = superdeform::make<SdefBone>();
  GIVES(SDEF_STATUS_BUFFER_TOO_SMALL, sdef_style_get_numbers(style.get(), nullptr, &bone, 1, &count, &error));
  CHECK(count > 1 && bone.length == 0);
}

// A struct as a newer host has it: with fields that this library does not know.
template <class T> struct Newer {
  T known;
  unsigned char more[48];
};

static void structs_may_be_older_or_newer() {
  const superdeform::Character made = character();
  const superdeform::Style style = superdeform::Style::from_heads(2.5);
  const superdeform::Deformer plain(made, style);

  Newer<SdefOptions> newer;
  std::memset(&newer, 0, sizeof newer);
  OK(sdef_options_init(&newer.known, sizeof newer, &error));
  CHECK(newer.known.struct_size == sizeof newer);
  superdeform::Deformer of_newer(made, style, newer.known);
  CHECK(deformed(of_newer) == deformed(plain));

  // Errors: 0 stands for the size of the first version; a smaller one has no room for a sentence.
  SdefError zeroed = {};
  GIVES(SDEF_STATUS_BAD_HANDLE, sdef_destroy(99, &zeroed));
  CHECK(zeroed.status == SDEF_STATUS_BAD_HANDLE && std::strlen(zeroed.message) > 0);
  SdefError small = SDEF_ERROR_INIT;
  small.struct_size = offsetof(SdefError, message) + 16;
  GIVES(SDEF_STATUS_BAD_ARGUMENT, sdef_destroy(99, &small));
  Newer<SdefError> large{};
  large.known.struct_size = sizeof large;
  std::memset(large.more, 0x5A, sizeof large.more);
  GIVES(SDEF_STATUS_BAD_HANDLE, sdef_destroy(99, &large.known));
  CHECK(std::strlen(large.known.message) > 0);

  // Results
  Newer<SdefReport> wide{};
  wide.known.struct_size = sizeof wide;
  OK(sdef_deformer_get_report(plain.get(), &wide.known, nullptr, 0, nullptr, &error));
  CHECK(wide.known.head_ratio == plain.report().head_ratio);

  // Arrays of structs go by the host's size.
  Newer<SdefMeshResult> results[2] = {};
  superdeform::Character two = character();
  two.add_mesh(figure().mesh);
  const superdeform::Deformer of_two(two, style);
  std::vector<float> positions[2];
  for (int mesh = 0; mesh < 2; mesh++) {
    positions[mesh].resize(3 * FIGURE_VERTICES);
    results[mesh].known.struct_size = sizeof results[mesh];
    results[mesh].known.vertex_capacity = FIGURE_VERTICES;
    results[mesh].known.positions = positions[mesh].data();
  }
  OK(sdef_deformer_apply(of_two.get(), &results[0].known, 2, nullptr, nullptr, &error));
  CHECK(positions[0] == positions[1] && positions[1] != std::vector<float>(3 * FIGURE_VERTICES));

  // Sizes that cannot be.
  for (const std::uint32_t size : {0u, 3u, unsigned(sizeof(void *)), 80u, 1u << 20}) {
    SdefMesh mesh = figure().mesh;
    mesh.struct_size = size;
    GIVES(SDEF_STATUS_BAD_ARGUMENT, sdef_character_add_mesh(two.get(), &mesh, nullptr, &error));
    SdefOptions options;
    GIVES(SDEF_STATUS_BAD_ARGUMENT, sdef_options_init(&options, size, &error));
  }
  // Arrays in which not all have the size of the first.
  superdeform::GroupSettings groups[2] = {superdeform::GroupSettings("foot"), superdeform::GroupSettings("hand")};
  superdeform::Options options;
  options.groups = groups;
  options.group_count = 2;
  superdeform::Deformer of_groups(made, style, options);
  groups[1].struct_size += 8;
  SdefDeformer refused{};
  GIVES(SDEF_STATUS_BAD_ARGUMENT,
        sdef_deformer_create(made.get(), style.get(), &options, nullptr, nullptr, &refused, &error));
  CHECK(std::string(error.message).find("groups[1]") != std::string::npos);
  // A struct that was only zeroed changes nothing, and says so.
  groups[1] = superdeform::GroupSettings("hand");
  static_cast<SdefGroupSettings &>(groups[0]) = SdefGroupSettings{};
  GIVES(SDEF_STATUS_BAD_ARGUMENT,
        sdef_deformer_create(made.get(), style.get(), &options, nullptr, nullptr, &refused, &error));
}

static void statuses() {
  superdeform::Character made = character();
  const superdeform::Style style = superdeform::Style::from_heads(2.5);
  SdefDeformer deformer{0};
  SdefStyle other{0};
  superdeform::Options options;

  GIVES(SDEF_STATUS_BAD_ARGUMENT, sdef_character_create(nullptr, nullptr, nullptr, &error));
  SdefMesh mesh = figure().mesh;
  mesh.positions = nullptr;
  GIVES(SDEF_STATUS_BAD_ARGUMENT, sdef_character_add_mesh(made.get(), &mesh, nullptr, &error));

  std::vector<FigureVertex> vertices(figure().vertices, figure().vertices + FIGURE_VERTICES);
  vertices[12].position[1] = std::numeric_limits<float>::quiet_NaN();
  mesh.positions = vertices[0].position;
  GIVES(SDEF_STATUS_BAD_INPUT, sdef_character_add_mesh(made.get(), &mesh, nullptr, &error));
  CHECK(error.mesh == 1 && error.element == 12 && std::strstr(error.message, "12") != nullptr);

  options.amount = std::numeric_limits<double>::infinity();
  GIVES(SDEF_STATUS_BAD_OPTION,
        sdef_deformer_create(made.get(), style.get(), &options, nullptr, nullptr, &deformer, &error));
  GIVES(SDEF_STATUS_BAD_STYLE, sdef_style_from_text("{", 1, &other, &error));

  const auto empty = superdeform::Character::create();
  GIVES(SDEF_STATUS_NO_HUMANOID,
        sdef_deformer_create(empty.get(), style.get(), nullptr, nullptr, nullptr, &deformer, &error));
  GIVES(SDEF_STATUS_NO_GEOMETRY, sdef_character_rig(empty.get(), nullptr, nullptr, nullptr, &error));

  // The message of one call does not stay for the next.
  OK(sdef_destroy(0, &error));
  CHECK(error.status == SDEF_STATUS_OK && error.message[0] == 0 && error.mesh == SDEF_NONE);
  CHECK(deformer.id == 0 && other.id == 0);
}

int main() {
  RUN(a_handle_is_destroyed_once);
  RUN(made_up_handles_are_refused);
  RUN(handles_of_another_kind_are_refused);
  RUN(what_a_deformer_needs_outlives_its_makers);
  RUN(arrays_that_are_too_small_are_not_written);
  RUN(structs_may_be_older_or_newer);
  RUN(statuses);
  return REPORT();
}
