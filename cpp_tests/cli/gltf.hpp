// GLB and VRM by tinygltf: files, and numbers out of accessors.
#ifndef GLTF_HPP
#define GLTF_HPP

#include "linear.hpp"

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Reads a file; images stay as they are. Throws std::runtime_error with one sentence.
tinygltf::Model read_gltf(const std::string &path);

// Writes a binary file.
void write_gltf(const std::string &path, tinygltf::Model &model);

// Where an accessor's elements lie; data is NULL where they are all 0 but for sparse ones.
struct Elements {
  const unsigned char *data = nullptr;
  std::size_t count = 0, stride = 0;
  int components = 0, type = 0;
  bool normalized = false, sparse = false;

  // True where the elements can be read where they lie.
  bool plain() const { return data != nullptr && !sparse; }
};

Elements elements(const tinygltf::Model &model, int accessor);

// All numbers of an accessor; normalised whole numbers as fractions.
std::vector<float> floats(const tinygltf::Model &model, int accessor, int components);

// All numbers of an accessor of whole numbers.
std::vector<std::uint32_t> integers(const tinygltf::Model &model, int accessor);

// Puts numbers where the accessor has them if it holds plain floats, else into a new one at the end of the file; gives
// the accessor that holds them. `share` forbids the first way: another use of it must keep what it has.
int store(tinygltf::Model &model, int accessor, int components, const std::vector<float> &numbers, bool share);

// A new accessor at the end of the file.
int append(tinygltf::Model &model, const void *bytes, std::size_t size, std::size_t count, int component_type, int type,
           int target);

// The nodes as a tree.
struct Nodes {
  std::vector<int> parents;        // or -1
  std::vector<int> order;          // nodes of the scene and joints, parents first
  std::vector<Matrix> local, world; // as the file poses them
};

Nodes read_nodes(const tinygltf::Model &model);

// Inverse bind matrices of a skin, one a joint.
std::vector<Matrix> inverse_binds(const tinygltf::Model &model, const tinygltf::Skin &skin);

// The brightness of an image, row by row; empty where it cannot be decoded.
struct Grey {
  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

Grey grey(const tinygltf::Model &model, int image);

// The accessor of an attribute, or -1.
int attribute(const std::map<std::string, int> &attributes, const std::string &name);

#endif
