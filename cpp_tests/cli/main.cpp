// superdeform_cli TARGET REFERENCE OUT: makes TARGET (GLB or VRM) super-deformed and writes OUT.
// REFERENCE is a super-deformed character (GLB or VRM), a built-in style such as sd2.5, or a number of heads.
//
// What is not reshaped stays: materials, images (as bytes), texture coordinates, names, extras, extensions. Animations
// stay as they are too, so those that move joints, and not only turn them, move them as far as before. tinygltf's model
// has no place for empty lists and objects, nor for members of glTF that it does not know.
#include "load.hpp"
#include "write.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

superdeform::Style style_of(const std::string &reference) {
  char *end = nullptr;
  const double heads = std::strtod(reference.c_str(), &end);
  if (end != reference.c_str() && *end == 0) return superdeform::Style::from_heads(heads);
  if (reference.find('.') == std::string::npos || reference.compare(0, 2, "sd") == 0)
    try {
      return superdeform::Style::from_text(reference);
    } catch (const superdeform::Error &) {
      // A file then.
    }
  Loaded model;
  load(reference, model);
  return superdeform::Style::measure(model.character, reference.c_str());
}

void print_lines(const std::string &text) {
  if (!text.empty()) std::fputs(text.c_str(), stderr);
}

void run(const char *target_path, const char *reference, const char *out) {
  Loaded target;
  load(target_path, target);
  const superdeform::Style style = style_of(reference);
  superdeform::Options options;
#ifndef TINYGLTF_DECODES_IMAGES
  // The command line sees painted irises, which this host does not then: both leave the face's age as it is.
  options.youth = 0;
#endif
  const superdeform::Deformer deformer(target.character, style, options);
  print_lines(deformer.warnings());
  deform(target, deformer);
  write_gltf(out, target.model);
  const double after = deformer.figure(SDEF_FIGURE_RESULT).heads, before = deformer.figure(SDEF_FIGURE_TARGET).heads;
  std::printf("%s: %.2f heads, was %.2f\n", out, after, before);
}

} // namespace

int main(int argc, char **argv) {
  if (argc != 4) {
    std::fprintf(stderr, "superdeform_cli TARGET REFERENCE OUT\n");
    return 2;
  }
  int code = 0;
  try {
    run(argv[1], argv[2], argv[3]);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 1;
  }
  if (sdef_live_handles() == 0) return code;
  std::fprintf(stderr, "handles are left: a fault of this program\n");
  return 3;
}
