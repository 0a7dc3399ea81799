#include "gltf.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace {

// Images are bytes in a buffer view, or bytes of a data URI; neither is decoded.
bool keep_image(tinygltf::Image *image, const int, std::string *, std::string *, int, int, const unsigned char *bytes,
                int size, void *) {
  image->as_is = true;
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

// What does not lie in a buffer view moves into one before writing, so there is nothing to write beside the file.
bool keep_uri(const std::string *, const std::string *, const tinygltf::Image *image, bool, std::string *uri, void *) {
  *uri = image->uri;
  return true;
}

std::size_t pad(std::vector<unsigned char> &bytes) {
  while (bytes.size() % 4 != 0) bytes.push_back(0);
  return bytes.size();
}

double number(const unsigned char *at, int type, bool normalized) {
  const auto read = [&](auto sample) {
    std::memcpy(&sample, at, sizeof sample);
    return static_cast<double>(sample);
  };
  const auto fraction = [&](double value, double largest) {
    return normalized ? std::max(value / largest, -1.0) : value;
  };
  switch (type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE: return fraction(read(std::int8_t()), 127);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return fraction(read(std::uint8_t()), 255);
  case TINYGLTF_COMPONENT_TYPE_SHORT: return fraction(read(std::int16_t()), 32767);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return fraction(read(std::uint16_t()), 65535);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read(std::uint32_t());
  default: return read(float());
  }
}

// The first byte of elements in a view; throws where they run past it.
const unsigned char *within(const tinygltf::Model &model, int view, std::size_t offset, std::size_t count,
                            std::size_t stride, std::size_t size) {
  const tinygltf::BufferView &in = model.bufferViews.at(view);
  const std::vector<unsigned char> &bytes = model.buffers.at(in.buffer).data;
  const bool fits = in.byteOffset <= bytes.size() && in.byteLength <= bytes.size() - in.byteOffset &&
                    (count == 0 || (offset <= in.byteLength && size <= in.byteLength - offset &&
                                    count - 1 <= (in.byteLength - offset - size) / stride));
  if (!fits) throw std::runtime_error("an accessor runs past its buffer view: export the file anew");
  return bytes.data() + in.byteOffset + offset;
}

template <class Put> void each_number(const tinygltf::Model &model, int index, int components, Put put) {
  const Elements all = elements(model, index);
  if (components != 0 && all.components != components)
    throw std::runtime_error("accessor " + std::to_string(index) + " has " + std::to_string(all.components) +
                             " numbers an element where " + std::to_string(components) + " are needed");
  const std::size_t size = tinygltf::GetComponentSizeInBytes(all.type);
  const auto take = [&](std::size_t element, const unsigned char *at) {
    for (int i = 0; i < all.components; i++) put(element * all.components + i, number(at + i * size, all.type, all.normalized));
  };
  if (all.data != nullptr)
    for (std::size_t element = 0; element < all.count; element++) take(element, all.data + element * all.stride);
  const tinygltf::Accessor &accessor = model.accessors[index];
  if (!all.sparse) return;
  const auto &sparse = accessor.sparse;
  const std::size_t count = sparse.count, width = size * all.components;
  const std::size_t index_size = tinygltf::GetComponentSizeInBytes(sparse.indices.componentType);
  const unsigned char *at = within(model, sparse.indices.bufferView, sparse.indices.byteOffset, count, index_size, index_size);
  const unsigned char *value = within(model, sparse.values.bufferView, sparse.values.byteOffset, count, width, width);
  for (std::size_t i = 0; i < count; i++) {
    const double element = number(at + i * index_size, sparse.indices.componentType, false);
    if (element >= static_cast<double>(all.count)) throw std::runtime_error("a sparse accessor replaces what it has not");
    take(static_cast<std::size_t>(element), value + i * width);
  }
}

} // namespace

tinygltf::Model read_gltf(const std::string &path) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_image, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  if (!loader.LoadBinaryFromFile(&model, &error, &warning, path))
    throw std::runtime_error(path + " cannot be read: " + (error.empty() ? "no GLB or VRM" : error));
  for (const std::string &extension : model.extensionsRequired)
    if (extension.find("compression") != std::string::npos)
      throw std::runtime_error(path + " is compressed with " + extension + ": export it without");
  return model;
}

void write_gltf(const std::string &path, tinygltf::Model &model) {
  for (tinygltf::Image &image : model.images) {
    if (image.bufferView >= 0 || image.image.empty()) continue;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = pad(model.buffers.at(0).data);
    view.byteLength = image.image.size();
    model.buffers[0].data.insert(model.buffers[0].data.end(), image.image.begin(), image.image.end());
    image.bufferView = static_cast<int>(model.bufferViews.size());
    model.bufferViews.push_back(view);
    image.uri.clear();
  }
  if (!model.buffers.empty()) pad(model.buffers[0].data);
  tinygltf::TinyGLTF writer;
  writer.SetImageWriter(keep_uri, nullptr);
  // By a stream of our own: tinygltf's does not tell whether the file could be opened.
  std::ofstream file(path, std::ios::binary);
  if (!file || !writer.WriteGltfSceneToStream(&model, file, false, true) || !file.flush())
    throw std::runtime_error(path + " cannot be written");
}

Elements elements(const tinygltf::Model &model, int index) {
  const tinygltf::Accessor &accessor = model.accessors.at(index);
  Elements found;
  found.count = accessor.count;
  found.components = tinygltf::GetNumComponentsInType(accessor.type);
  found.type = accessor.componentType;
  found.normalized = accessor.normalized;
  found.sparse = accessor.sparse.isSparse;
  const std::size_t size = tinygltf::GetComponentSizeInBytes(accessor.componentType) * found.components;
  found.stride = size;
  if (accessor.bufferView < 0) return found;
  const std::size_t stride = model.bufferViews.at(accessor.bufferView).byteStride;
  if (stride != 0) found.stride = stride;
  if (found.stride < size) throw std::runtime_error("elements of accessor " + std::to_string(index) + " overlap");
  found.data = within(model, accessor.bufferView, accessor.byteOffset, found.count, found.stride, size);
  return found;
}

std::vector<float> floats(const tinygltf::Model &model, int accessor, int components) {
  const Elements all = elements(model, accessor);
  std::vector<float> numbers(all.count * all.components);
  each_number(model, accessor, components, [&](std::size_t at, double value) { numbers[at] = static_cast<float>(value); });
  return numbers;
}

std::vector<std::uint32_t> integers(const tinygltf::Model &model, int accessor) {
  const Elements all = elements(model, accessor);
  std::vector<std::uint32_t> numbers(all.count * all.components);
  each_number(model, accessor, 0, [&](std::size_t at, double value) { numbers[at] = static_cast<std::uint32_t>(value); });
  return numbers;
}

int append(tinygltf::Model &model, const void *bytes, std::size_t size, std::size_t count, int component_type, int type,
           int target) {
  if (model.buffers.empty()) model.buffers.emplace_back();
  std::vector<unsigned char> &data = model.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = pad(data);
  view.byteLength = size;
  view.target = target;
  const unsigned char *first = static_cast<const unsigned char *>(bytes);
  data.insert(data.end(), first, first + size);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size());
  accessor.componentType = component_type;
  accessor.type = type;
  accessor.count = count;
  model.bufferViews.push_back(view);
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

int store(tinygltf::Model &model, int index, int components, const std::vector<float> &numbers, bool share) {
  const int types[] = {0, TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4};
  const std::size_t count = numbers.size() / components;
  const Elements there = index < 0 ? Elements() : elements(model, index);
  const bool over = index >= 0 && !share && there.plain() && there.type == TINYGLTF_COMPONENT_TYPE_FLOAT;
  if (over) {
    unsigned char *data = const_cast<unsigned char *>(there.data);
    for (std::size_t element = 0; element < count; element++)
      std::memcpy(data + element * there.stride, &numbers[element * components], sizeof(float) * components);
  } else {
    const tinygltf::Accessor old = index < 0 ? tinygltf::Accessor() : model.accessors[index];
    index = append(model, numbers.data(), sizeof(float) * numbers.size(), count, TINYGLTF_COMPONENT_TYPE_FLOAT,
                   components == 16 ? TINYGLTF_TYPE_MAT4 : types[components],
                   components == 16 ? 0 : TINYGLTF_TARGET_ARRAY_BUFFER);
    model.accessors[index].name = old.name;
    model.accessors[index].minValues = old.minValues;
  }
  tinygltf::Accessor &accessor = model.accessors[index];
  if (!accessor.minValues.empty() && count > 0) {
    accessor.minValues.assign(components, std::numeric_limits<double>::infinity());
    accessor.maxValues.assign(components, -std::numeric_limits<double>::infinity());
    for (std::size_t at = 0; at < numbers.size(); at++) {
      double &low = accessor.minValues[at % components], &high = accessor.maxValues[at % components];
      low = std::min(low, static_cast<double>(numbers[at]));
      high = std::max(high, static_cast<double>(numbers[at]));
    }
  }
  return index;
}

Nodes read_nodes(const tinygltf::Model &model) {
  const int count = static_cast<int>(model.nodes.size());
  Nodes nodes;
  nodes.parents.assign(count, -1);
  for (int node = 0; node < count; node++)
    for (const int child : model.nodes[node].children) {
      if (child < 0 || child >= count || nodes.parents[child] >= 0)
        throw std::runtime_error("node " + std::to_string(child) + " has two parents or is not there: export the file anew");
      nodes.parents[child] = node;
    }
  std::vector<bool> shown(count, model.scenes.empty());
  const int scene = std::max(model.defaultScene, 0);
  if (scene < static_cast<int>(model.scenes.size()))
    for (const int root : model.scenes[scene].nodes) shown.at(root) = true;
  for (const tinygltf::Skin &skin : model.skins)
    for (int node : skin.joints)
      for (; node >= 0 && !shown.at(node); node = nodes.parents[node]) shown[node] = true;
  std::vector<int> stack;
  for (int node = count - 1; node >= 0; node--)
    if (nodes.parents[node] < 0) stack.push_back(node);
  nodes.local.resize(count);
  nodes.world.resize(count);
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    const tinygltf::Node &from = model.nodes[node];
    if (from.matrix.size() == 16) {
      std::copy(from.matrix.begin(), from.matrix.end(), nodes.local[node].n.begin());
    } else {
      Vector translation{0, 0, 0}, scale{1, 1, 1};
      std::array<double, 4> rotation{0, 0, 0, 1};
      if (from.translation.size() == 3) std::copy(from.translation.begin(), from.translation.end(), translation.begin());
      if (from.rotation.size() == 4) std::copy(from.rotation.begin(), from.rotation.end(), rotation.begin());
      if (from.scale.size() == 3) std::copy(from.scale.begin(), from.scale.end(), scale.begin());
      nodes.local[node] = from_parts(translation, rotation, scale);
    }
    const int parent = nodes.parents[node];
    nodes.world[node] = parent < 0 ? nodes.local[node] : nodes.world[parent] * nodes.local[node];
    if (parent >= 0 && shown[parent]) shown[node] = true;
    if (shown[node]) nodes.order.push_back(node);
    for (auto child = from.children.rbegin(); child != from.children.rend(); ++child) stack.push_back(*child);
  }
  return nodes;
}

std::vector<Matrix> inverse_binds(const tinygltf::Model &model, const tinygltf::Skin &skin) {
  std::vector<Matrix> binds(skin.joints.size());
  if (skin.inverseBindMatrices < 0) return binds;
  const std::vector<float> numbers = floats(model, skin.inverseBindMatrices, 16);
  for (std::size_t joint = 0; joint < binds.size(); joint++)
    for (std::size_t i = 0; i < 16; i++) binds[joint].n[i] = numbers.at(16 * joint + i);
  return binds;
}

Grey grey(const tinygltf::Model &model, int index) {
  Grey found;
#ifdef TINYGLTF_DECODES_IMAGES
  const tinygltf::Image &source = model.images.at(index);
  const unsigned char *bytes = source.image.data();
  std::size_t size = source.image.size();
  if (source.bufferView >= 0) {
    size = model.bufferViews.at(source.bufferView).byteLength;
    bytes = within(model, source.bufferView, 0, 1, size, size);
  }
  tinygltf::Image decoded;
  std::string error, warning;
  if (!tinygltf::LoadImageData(&decoded, index, &error, &warning, 0, 0, bytes, static_cast<int>(size), nullptr)) return found;
  found.width = decoded.width;
  found.height = decoded.height;
  // Four bytes a pixel, or twice as many, of which the first of two is the lower half.
  const std::size_t wide = decoded.bits == 16 ? 2 : 1;
  for (std::size_t at = 0; at + 4 * wide <= decoded.image.size(); at += 4 * wide) {
    const unsigned char *pixel = decoded.image.data() + at + wide - 1;
    found.pixels.push_back(static_cast<unsigned char>((54 * pixel[0] + 183 * pixel[wide] + 19 * pixel[2 * wide]) / 256));
  }
#else
  (void)model, (void)index;
#endif
  return found;
}

int attribute(const std::map<std::string, int> &attributes, const std::string &name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}
