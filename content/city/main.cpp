// petrichor_city: writes the city as one .glb. Deterministic: the same program writes the same bytes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "content/city/parts.hpp"
#include "content/city/write_glb.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Makes the city of Petrichor as a binary glTF file"};
  std::string out = "city.glb";
  bool bare = false;
  app.add_option("out", out, "the .glb to write");
  app.add_flag("--bare", bare, "no textures, for a quick look at the geometry");
  CLI11_PARSE(app, argc, argv);

  const petrichor::city::Scene scene = petrichor::city::make_city();
  const auto written = petrichor::city::glb_bytes(scene, {!bare}).and_then([&](const auto& bytes) {
    fmt::print("{}: {:.1f} MB, {} triangles, {} lights, {} nodes\n", out, static_cast<double>(bytes.size()) / 1e6,
               petrichor::city::triangle_count(scene), scene.lights.size(), scene.nodes.size());
    return petrichor::city::write_file(out, bytes);
  });
  if (!written) {
    fmt::print(stderr, "{}\n", written.error().message);
    return 1;
  }
  return 0;
}
