// The one place where tinygltf is compiled; CMakeLists.txt sets its options for the whole box (no stb, no
// file system: images go through OpenImageIO and files through source_file.hpp).
#include <fstream>  // missing in tiny_gltf.h 2.7 without its file system

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
