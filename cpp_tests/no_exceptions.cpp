// superdeform.hpp without exceptions and without run-time types, as engines and consoles build.
#include "figure.h"
#include "superdeform.hpp"
#include <cstdio>
#include <cstring>

static Figure figure;
static int failures = 0;
static void check(bool holds, int line) {
  if (holds) return;
  std::printf("no_exceptions.cpp:%d does not hold; %s\n", line, superdeform::last_error().what());
  failures++;
}
#define CHECK(...) check((__VA_ARGS__), __LINE__)

// What an engine's component has: empty until it is set up.
struct Component {
  superdeform::Character character;
  superdeform::Style style;
  superdeform::Deformer deformer;
};

int main() {
  figure_make(&figure);
  {
    Component component;
    CHECK(!component.character && !component.style && !component.deformer && superdeform::live_handles() == 0);
    component.character = superdeform::Character::create();
    component.character.set_skeleton(figure.skeleton);
    CHECK(component.character.add_mesh(figure.mesh) == 0);
    component.style = superdeform::Style::from_heads(2.5);
    int calls = 0;
    component.deformer = superdeform::Deformer(component.character, component.style, superdeform::Options(),
                                               [&](float) { calls++; });
    CHECK(component.deformer && calls > 1 && superdeform::last_error().status() == SDEF_STATUS_OK);
    CHECK(component.deformer.figure(SDEF_FIGURE_RESULT).heads < 3 && component.deformer.warnings().size() < 2000);

    // What fails gives an empty handle and says why.
    const superdeform::Style none = superdeform::Style::from_heads(99);
    CHECK(!none && superdeform::last_error().status() == SDEF_STATUS_BAD_OPTION);
    CHECK(std::strlen(superdeform::last_error().what()) > 10);
    const superdeform::Deformer of_none(component.character, none);
    CHECK(!of_none && none.to_json().empty() && of_none.warnings().empty() && of_none.report_json().empty());
    CHECK(superdeform::last_error().status() == SDEF_STATUS_BAD_OPTION);
    const superdeform::Deformer stopped(component.character, component.style, superdeform::Options(),
                                        [](float) { return true; });
    CHECK(!stopped && superdeform::last_error().status() == SDEF_STATUS_CANCELLED);
    // A call on what is empty leaves the reason.
    CHECK(stopped.joints().positions.empty() && superdeform::last_error().status() == SDEF_STATUS_CANCELLED);
    const superdeform::Deformer made_up(SdefDeformer{42});
    CHECK(made_up.joints().positions.empty() && superdeform::last_error().status() == SDEF_STATUS_BAD_HANDLE);
    CHECK(made_up.report_json().empty());
  }
  CHECK(superdeform::live_handles() == 0);
  std::printf("%d failures\n", failures);
  return failures == 0 ? 0 : 1;
}
