// superdeform.hpp after the macros that engines and systems define: each stands for what compiles nowhere, or for what it
// stands for there. The standard library's headers come before them, as they do in those.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <iterator>
#include <math.h>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#define NOWHERE(...) static_assert(false, "a name of superdeform.hpp is a macro")
// Unreal.
#define check(...) NOWHERE(__VA_ARGS__)
#define checkf(...) NOWHERE(__VA_ARGS__)
#define checkSlow(...) NOWHERE(__VA_ARGS__)
#define ensure(...) NOWHERE(__VA_ARGS__)
#define ensureMsgf(...) NOWHERE(__VA_ARGS__)
#define verify(...) NOWHERE(__VA_ARGS__)
#define verifyf(...) NOWHERE(__VA_ARGS__)
#define unimplemented(...) NOWHERE(__VA_ARGS__)
#define TEXT(...) NOWHERE(__VA_ARGS__)
#define PI (3.1415926535897932f)
// AssertMacros.h of macOS.
#define require(...) NOWHERE(__VA_ARGS__)
#define require_noerr(...) NOWHERE(__VA_ARGS__)
#define check_noerr(...) NOWHERE(__VA_ARGS__)
#define check_string(...) NOWHERE(__VA_ARGS__)
// windows.h.
#define min(a, b) NOWHERE(a, b)
#define max(a, b) NOWHERE(a, b)
#define near
#define far
#define small char
#define hyper __int64
#define interface struct
#define IN
#define OUT
#define ERROR 0
#define CALLBACK
#define Yield()
#define GetObject GetObjectA
// Xlib.
#define None 0L
#define Status int
#define Bool int
#define True 1
#define False 0
#define Success 0
#define Always 2
// Qt.
#define signals public
#define slots
#define emit
#define foreach NOWHERE
#define forever for (;;)

#include "superdeform.hpp"

#include "check.h"
#include "figure.h"

static Figure figure;

static void the_layer_in_cpp_works_beside_them() {
  auto character = superdeform::Character::create();
  character.set_skeleton(figure.skeleton);
  character.add_mesh(figure.mesh);
  const superdeform::Style style = superdeform::Style::from_heads(2.5);
  int calls = 0;
  const superdeform::Deformer deformer(character, style, superdeform::Options(), [&](float) { calls++; });
  std::vector<float> positions(3 * FIGURE_VERTICES);
  std::vector<SdefMeshResult> results(1, superdeform::make<SdefMeshResult>());
  results[0].vertex_capacity = FIGURE_VERTICES;
  results[0].positions = positions.data();
  deformer.apply(results, [&](float) { return false; });
  CHECK(calls > 1 && deformer.figure(SDEF_FIGURE_RESULT).heads < 3 && !deformer.report_json().empty());
  CHECK(deformer.joints().positions.size() == 3 * FIGURE_PARTS && deformer.groups().size() > 5);
  CHECK(style.numbers().heads == 2.5 && superdeform::warnings(deformer) == deformer.warnings());
}

static void what_fails_is_thrown_beside_them() {
  bool thrown = false;
  try {
    superdeform::Style::from_heads(99);
  } catch (const superdeform::Error &error) {
    thrown = error.status() == SDEF_STATUS_BAD_OPTION;
  }
  CHECK(thrown);
}

int main() {
  figure_make(&figure);
  RUN(the_layer_in_cpp_works_beside_them);
  RUN(what_fails_is_thrown_beside_them);
  return REPORT();
}
