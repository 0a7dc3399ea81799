// From a file to the arrays that superdeform takes: a character in rest pose.
#ifndef LOAD_HPP
#define LOAD_HPP

#include "gltf.hpp"
#include "superdeform.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

// One primitive as it is shown by a node.
struct Part {
  int node = 0, mesh = 0, primitive = 0;
  int skin = -1;                  // -1: it hangs from its node
  std::vector<Matrix> placements; // the file's vertices to model space: one for all, or one a vertex
  std::string name;
  SdefMesh arrays{};              // points into the file's buffers wherever those are what superdeform takes
  std::vector<SdefMorphTarget> targets;

  const Matrix &placement(std::size_t vertex) const { return placements[placements.size() == 1 ? 0 : vertex]; }
};

struct LoadedSkin {
  std::vector<Matrix> inverse_binds;
  std::vector<Matrix> by_joint; // J_j B_j at rest
  Matrix common;                // what they are but for rounding
  bool uniform = true;
};

struct Loaded {
  std::string path;
  tinygltf::Model model;
  Nodes nodes;
  std::vector<Matrix> rest; // node space to model space at rest, by node
  std::vector<LoadedSkin> skins;
  std::vector<Part> parts;
  std::vector<int> joint_of_node, node_of_joint;
  bool rigged = false; // whether the file's own joints are the character's

  // With a rig that was made where the file has none that can be used.
  superdeform::Character character = superdeform::Character::create();

  std::map<int, std::uint32_t> images; // the file's images to the character's

  // What had to be converted.
  std::deque<std::vector<float>> floats;
  std::deque<std::vector<std::uint32_t>> integers;
};

// Reads a character. Throws superdeform::Error or std::runtime_error.
void load(const std::string &path, Loaded &loaded);

#endif
