// What the tests in C++ share: the figure as a character, and expected errors.
#ifndef HOSTS_HPP
#define HOSTS_HPP

#include "superdeform.hpp"

#include "check.h"
#include "figure.h"
#include <cstring>
#include <string>
#include <vector>

inline const Figure &figure() {
  static const Figure *made = [] {
    static Figure figure;
    figure_make(&figure);
    return &figure;
  }();
  return *made;
}

inline superdeform::Character character() {
  superdeform::Character character = superdeform::Character::create();
  character.set_skeleton(figure().skeleton);
  character.add_mesh(figure().mesh);
  character.add_morph_target(0, figure().target);
  return character;
}

// Packed positions with the struct that asks for them.
struct Positions {
  std::vector<float> numbers = std::vector<float>(3 * FIGURE_VERTICES);
  SdefMeshResult result = superdeform::make<SdefMeshResult>();

  Positions() {
    result.vertex_capacity = FIGURE_VERTICES;
    result.positions = numbers.data();
  }
  Positions(const Positions &) = delete;
};

inline std::vector<float> deformed(const superdeform::Deformer &deformer) {
  Positions positions;
  deformer.apply({&positions.result, 1});
  return positions.numbers;
}

// The error that a call throws; status OK where it throws none.
template <class Call> superdeform::Error thrown(Call call) {
  try {
    call();
  } catch (const superdeform::Error &error) {
    return error;
  }
  return superdeform::Error(SDEF_STATUS_OK, "");
}

#endif
