// Every function through superdeform.hpp.
#include "hosts.hpp"

#include <cmath>
#include <utility>

using superdeform::Character;
using superdeform::Deformer;
using superdeform::Options;
using superdeform::Style;
using superdeform::View;

static void made_of_nothing_is_empty() {
  const Character none;
  CHECK(!none && !Style() && !Deformer() && none.id() == 0 && superdeform::live_handles() == 0);
  CHECK(thrown([&] { none.info(); }).status() == SDEF_STATUS_BAD_HANDLE);
}

static void handles_are_destroyed_and_moved() {
  Character first = character();
  const std::uint64_t id = first.id();
  CHECK(superdeform::live_handles() == 1);
  Character second = std::move(first);
  CHECK(second.id() == id && !first && second);
  second = Character::create();
  CHECK(superdeform::live_handles() == 1 && second.id() != id);
  second = std::move(second);
  CHECK(second && superdeform::live_handles() == 1);
  const SdefCharacter released = second.release();
  CHECK(!second && superdeform::live_handles() == 1);
  second.reset(released);
  second.reset();
  CHECK(superdeform::live_handles() == 0);
}

static void views_are_made_of_what_holds_elements() {
  std::vector<int> numbers{1, 2, 3};
  const std::vector<int> constant{4, 5};
  int array[2] = {6, 7};
  View<int> changed(numbers);
  View<const int> read(numbers), of_constant(constant), of_array(array), none;
  changed[0] = 9;
  int sum = 0;
  for (int number : read) sum += number;
  CHECK(sum == 14 && read.size() == 3 && of_constant[1] == 5 && of_array.size() == 2 && none.empty());
  static_assert(!std::is_constructible_v<View<int>, const std::vector<int> &>);
  static_assert(!std::is_constructible_v<View<int>, std::vector<double> &>);
}

static void characters() {
  Character made = character();
  const SdefCharacterInfo info = made.info();
  CHECK(info.vertex_count == FIGURE_VERTICES && info.morph_target_count == 1);
  const Character::Joints joints = made.joints();
  CHECK(joints.parents.size() == FIGURE_PARTS && joints.rest_matrices[16 * 3 + 13] == 1.5);
  CHECK(joints.roles[3] == SDEF_ROLE_HEAD && joints.confidence[3] == 1);
  std::vector<std::uint32_t> of_vertex(FIGURE_VERTICES);
  std::vector<float> weights(FIGURE_VERTICES);
  made.weights(0, 1, of_vertex, weights);
  CHECK(of_vertex.back() == FIGURE_PARTS - 1 && weights.back() == 1);
  CHECK(made.warnings().find('\0') == std::string::npos);
  CHECK(std::string(superdeform::status_name(SDEF_STATUS_BUSY)) == "SDEF_STATUS_BUSY");
  CHECK(superdeform::version()[0] == char('0' + SDEF_VERSION_MAJOR));
  Options options;
  options.rig_voxel_resolution = 48;
  options.rig_weights = SDEF_WEIGHTS_VOLUME;
  options.thread_count = 2;
  float last = 0;
  int jobs = 0;
  superdeform::set_jobs(
      [](void *user, SdefTask task, void *data, std::uint32_t count) {
        for (std::uint32_t index = 0; index < count; index++) task(data, index);
        ++*static_cast<int *>(user);
      },
      &jobs);
  made.rig(options, [&](float fraction) { last = fraction; });
  superdeform::set_jobs(nullptr);
  CHECK(made.info().rig_made == 1 && last == 1 && jobs > 0);
  const std::uint8_t pixel = 200;
  SdefImage image = superdeform::make<SdefImage>();
  image.width = image.height = 1;
  image.pixels = &pixel;
  CHECK(made.add_image(image) == 1 && made.add_image(image) == 2);
  const double eye[3] = {0.03, 1.65, 0.1};
  SdefFaceHints hints = superdeform::make<SdefFaceHints>();
  hints.eye = eye;
  made.set_face_hints(hints);
  const float up[3] = {0, 0, 1}, forward[3] = {0, -1, 0};
  CHECK(Character::create(up, forward).info().mesh_count == 0);
}

static void styles() {
  const Style built_in = Style::from_text("sd2.5");
  const Style measured = Style::measure(character(), "figure");
  const Style again = Style::from_numbers(measured.numbers(), measured.bones(), "again");
  const Style between = Style::blend(built_in, again, 0.5);
  const Style read = Style::from_text(between.to_json());
  CHECK(read.numbers().leg == between.numbers().leg && read.bones().size() == between.bones().size());
  CHECK(read.to_json() == between.to_json());
  CHECK(Style::from_heads(3, built_in) && Style::from_heads(3));
}

static void deformers() {
  Deformer deformer = [] {
    const Character made = character();
    return Deformer(made, Style::from_heads(2.5));
  }();
  const std::vector<float> positions = deformed(deformer);
  CHECK(thrown([&] { deformer.measure([](float) { return true; }); }).status() == SDEF_STATUS_CANCELLED);
  float measured = 0;
  deformer.measure([&](float fraction) { measured = fraction; });
  CHECK(measured == 1);
  CHECK(std::fabs(deformer.figure(SDEF_FIGURE_RESULT).heads - 2.5) < 0.3);
  CHECK(deformer.report_json().front() == '{' && deformer.report_json().back() != '\0');
  const Deformer::Joints joints = deformer.joints();
  CHECK(joints.positions.size() == 3 * FIGURE_PARTS && joints.inverse_binds.size() == 16 * FIGURE_PARTS);
  const std::vector<std::uint32_t> owners{3};
  const std::vector<double> points{0, 1.6, 0.1};
  std::vector<double> moved(3), scales(1), jacobians(9);
  deformer.map_points(owners, points, moved, scales, jacobians);
  CHECK(moved[1] < 1.6 && scales[0] > 0 && jacobians[0] > 0);
  deformer.map_points(owners, points, {}, scales);
  std::vector<SdefCollider> colliders(1, superdeform::make<SdefCollider>());
  colliders[0].joint = 3, colliders[0].y = 1.6, colliders[0].z = 0.1, colliders[0].radius = 0.1;
  deformer.map_colliders(colliders);
  CHECK(std::fabs(colliders[0].y - moved[1]) < 1e-9 && std::fabs(colliders[0].radius - 0.1 * scales[0]) < 1e-9);
  CHECK(superdeform::morph_target_is_read("blink") && !superdeform::morph_target_is_read("smile"));
  const std::vector<std::uint32_t> one{1}, first{0};
  std::vector<float> change{0, 0.01f, 0};
  deformer.map_morph_targets(0, one, first, change);
  CHECK(change[1] > 0 && change[1] < 0.05f);
  CHECK(thrown([&] { deformer.map_morph_targets(0, one, first, std::vector<float>()); }).status() ==
        SDEF_STATUS_BAD_ARGUMENT);
  CHECK(deformer.groups().size() >= 6);
  deformer.warnings();
  Options options;
  options.face_squash = 1;
  options.face_curve = SDEF_FACE_CURVE_SPHERE;
  deformer.set_options(options);
  options.amount = 0;
  deformer.set_options(options);
  CHECK(deformed(deformer) != positions);
  deformer.set_options(Options());
  CHECK(deformed(deformer) == positions);
  deformer.set_style(Style::from_heads(4));
  CHECK(deformed(deformer) == deformed(Deformer(character(), Style::from_heads(4))));
  deformer.set_style(Style::from_heads(2.5));
  CHECK(deformed(deformer) == positions);

  Positions once;
  superdeform::super_deform(&figure().skeleton, {&figure().mesh, 1}, Style::from_heads(2.5), {&once.result, 1});
  CHECK(once.numbers == positions);
}

static void errors_are_exceptions() {
  Character made = character();
  SdefMesh mesh = figure().mesh;
  std::vector<std::uint16_t> indices(figure().indices, figure().indices + FIGURE_INDICES);
  indices[7] = 60000;
  mesh.indices = indices.data();
  const superdeform::Error error = thrown([&] { made.add_mesh(mesh); });
  CHECK(error.status() == SDEF_STATUS_BAD_INPUT && error.mesh() == 1 && error.element() == 2);
  CHECK(std::string(error.what()).find("60000") != std::string::npos);
  CHECK(thrown([&] { Style::from_text("sd9"); }).status() == SDEF_STATUS_BAD_STYLE);
  CHECK(thrown([&] { Style::from_heads(99); }).status() == SDEF_STATUS_BAD_OPTION);
  CHECK(thrown([&] { Deformer(SdefDeformer{42}).report(); }).status() == SDEF_STATUS_BAD_HANDLE);
  const Deformer deformer(made, Style::from_heads(2.5));
  const std::vector<std::uint32_t> owners{0, 1};
  const std::vector<double> points(3);
  CHECK(thrown([&] { deformer.map_points(owners, points, {}); }).status() == SDEF_STATUS_BAD_ARGUMENT);
}

struct Stop {
  int number;
};

static void progress_is_a_lambda() {
  const Character made = character();
  const Style style = Style::from_heads(2.5);
  std::vector<float> fractions;
  const Deformer deformer(made, style, Options(), [&](float fraction) { fractions.push_back(fraction); });
  CHECK(!fractions.empty() && fractions.back() == 1);
  for (std::size_t i = 1; i < fractions.size(); i++) CHECK(fractions[i - 1] <= fractions[i]);

  CHECK(thrown([&] { Deformer(made, style, Options(), [](float) { return true; }); }).status() ==
        SDEF_STATUS_CANCELLED);
  CHECK(superdeform::live_handles() == 3);
  int caught = 0;
  try {
    Deformer(made, style, Options(), [](float fraction) {
      if (fraction >= 0) throw Stop{17};
    });
  } catch (const Stop &stop) {
    caught = stop.number;
  }
  CHECK(caught == 17 && superdeform::live_handles() == 3);

  Positions untouched;
  const SdefMeshResult *result = &untouched.result;
  CHECK(thrown([&] { deformer.apply({result, 1}, [](float) { return true; }); }).status() == SDEF_STATUS_CANCELLED);
  CHECK(untouched.numbers == std::vector<float>(3 * FIGURE_VERTICES));
  struct Counter {
    int calls = 0;
    bool operator()(float) { return ++calls < 0; }
  } counter;
  deformer.apply({result, 1}, counter);
  CHECK(counter.calls > 0 && untouched.numbers == deformed(deformer));
}

int main() {
  RUN(made_of_nothing_is_empty);
  RUN(handles_are_destroyed_and_moved);
  RUN(views_are_made_of_what_holds_elements);
  RUN(characters);
  RUN(styles);
  RUN(deformers);
  RUN(errors_are_exceptions);
  RUN(progress_is_a_lambda);
  return REPORT();
}
