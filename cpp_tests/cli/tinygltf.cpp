// tinygltf itself, where it is a plain header: built once.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
