// The generated town: what the issue asks of it, counted in the scene and in the file that was built.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "components/components.hpp"
#include "content/city/parts.hpp"
#include "content/city/plan.hpp"
#include "content/city/write_glb.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/ecs/schema.hpp"

namespace petrichor::city {
namespace {

const Scene& town() {
  static const Scene scene = make_city();
  return scene;
}

int count_extras(const Scene& scene, const std::string& schema) {
  int count = 0;
  for (const Node& node : scene.nodes) {
    if (!node.extras_json.empty() && nlohmann::json::parse(node.extras_json).contains(schema)) ++count;
  }
  return count;
}

// A node's frame in the world: nodes carry no scale.
glm::mat4 world_of(const Scene& scene, int index) {
  glm::mat4 m(1.0f);
  while (index >= 0) {
    const Node& node = scene.nodes[static_cast<std::size_t>(index)];
    glm::mat4 local = glm::mat4_cast(node.rotation);
    local[3] = glm::vec4(node.translation_m, 1.0f);
    m = local * m;
    index = node.parent;
  }
  return m;
}

TEST(City, DrawsBetween100And300ThousandTriangles) {
  EXPECT_GE(triangle_count(town()), 100000u);
  EXPECT_LE(triangle_count(town()), 300000u);
}

TEST(City, SameGeometryEveryTime) {
  const WriteOptions bare{false};
  const auto first = glb_bytes(town(), bare);
  const auto second = glb_bytes(make_city(), bare);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
}

TEST(City, SameBytesAsTheFileOfTheBuild) {
  const std::filesystem::path path = std::filesystem::path(PETRICHOR_BINARY_DIR) / "content" / "city.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not built: build the target petrichor_content";
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> built{std::istreambuf_iterator<char>(file), {}};
  const auto made = glb_bytes(town(), {});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->size(), built.size());
  EXPECT_TRUE(*made == built) << "the generator changed, or is not deterministic";
  EXPECT_LE(built.size(), 40u * 1000 * 1000) << "it must travel";
}

TEST(City, VerticesAreFiniteAndNormalsAreUnit) {
  for (const Mesh& mesh : town().meshes) {
    for (const auto& [mat, primitive] : mesh.primitives) {
      ASSERT_FALSE(primitive.indices.empty()) << mesh.name;
      ASSERT_EQ(primitive.indices.size() % 3, 0u);
      for (std::uint32_t i : primitive.indices) ASSERT_LT(i, primitive.vertices.size()) << mesh.name;
      for (const Vertex& v : primitive.vertices) {
        ASSERT_TRUE(std::isfinite(v.position_m.x + v.position_m.y + v.position_m.z + v.uv.x + v.uv.y)) << mesh.name;
        ASSERT_NEAR(glm::length(v.normal), 1.0f, 1e-4f) << mesh.name;
        ASSERT_GE(std::min(v.colour.x, std::min(v.colour.y, v.colour.z)), 0.0f) << mesh.name;
        ASSERT_LE(std::max(v.colour.x, std::max(v.colour.y, v.colour.z)), 1.0f) << mesh.name << ": albedo above one";
      }
    }
  }
}

// A shading normal that looks away from its triangle would light the back of a wall.
TEST(City, NormalsAgreeWithTheWinding) {
  std::size_t wrong = 0;
  std::size_t all = 0;
  std::map<std::string, int> where;
  for (const Mesh& mesh : town().meshes) {
    for (const auto& [mat, primitive] : mesh.primitives) {
      for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        const Vertex& a = primitive.vertices[primitive.indices[i]];
        const Vertex& b = primitive.vertices[primitive.indices[i + 1]];
        const Vertex& c = primitive.vertices[primitive.indices[i + 2]];
        const glm::vec3 n = glm::cross(b.position_m - a.position_m, c.position_m - a.position_m);
        ++all;
        if (glm::dot(n, a.normal + b.normal + c.normal) <= 0.0f) {
          ++wrong;
          ++where[mesh.name];
        }
      }
    }
  }
  std::string list;
  for (const auto& [name, count] : where) list += name + " " + std::to_string(count) + ", ";
  EXPECT_LE(wrong, all / 500) << list;
}

TEST(City, EveryExtraIsASchemaField) {
  for (const Node& node : town().nodes) {
    if (node.extras_json.empty()) continue;
    const nlohmann::json extras = nlohmann::json::parse(node.extras_json);
    for (const auto& [name, fields] : extras.items()) {
      const Schema* schema = find_schema(component_schemas(), name);
      ASSERT_NE(schema, nullptr) << node.name << ": no component is called " << name;
      Registry registry;
      const Entity entity = registry.create();
      const Result<void> written = write_fields(*schema, schema->emplace(registry, entity), fields);
      EXPECT_TRUE(written) << node.name << ": " << (written ? "" : written.error().message);
    }
  }
}

TEST(City, MarksWaterGlassAndLight) {
  EXPECT_GE(count_extras(town(), "drip_source"), 50);
  EXPECT_GE(count_extras(town(), "puddle"), 12);
  EXPECT_GE(count_extras(town(), "glass_pane"), 15);
  EXPECT_GE(town().lights.size(), 40u);
  EXPECT_LE(town().lights.size(), 80u);
  int shadows = 0;
  int lamps = 0;
  for (const Node& node : town().nodes) {
    if (node.light < 0) continue;
    shadows += nlohmann::json::parse(node.extras_json).at("light").at("casts_shadow").get<bool>() ? 1 : 0;
    lamps += node.name.starts_with("lamp_") || node.name.starts_with("wall_lamp_") ? 1 : 0;
  }
  EXPECT_GE(shadows, 8);
  EXPECT_LE(shadows, 16);
  EXPECT_GE(lamps, 14);
}

TEST(City, HasItsPlaces) {
  std::set<std::string> cameras;
  for (const Camera& camera : town().cameras) cameras.insert(camera.name);
  for (const char* name : {"view_crossing", "view_toyshop", "view_under_awning", "view_roof", "view_lane"}) {
    EXPECT_TRUE(cameras.contains(name)) << name;
  }
  std::set<std::string> names;
  for (const Node& node : town().nodes) names.insert(node.name);
  for (const char* name :
       {"toy_shop_front", "toy_shop_room", "bus_shelter", "overhead_wires", "neon_signs", "walker_start", "church"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  int cars = 0;
  for (const Node& node : town().nodes) cars += node.name.find("car_") != std::string::npos && node.mesh >= 0 ? 1 : 0;
  EXPECT_GE(cars, 8);
}

TEST(City, StreetsAreAboutOneHundredAndTwentyMetresLong) {
  glm::vec3 low(1e9f);
  glm::vec3 high(-1e9f);
  for (std::size_t i = 0; i < town().nodes.size(); ++i) {
    const Node& node = town().nodes[i];
    if (node.mesh < 0) continue;
    const Mesh& mesh = town().meshes[static_cast<std::size_t>(node.mesh)];
    if (!mesh.name.starts_with("lamplighter_street") && !mesh.name.starts_with("weathercock_lane")) continue;
    const glm::mat4 world = world_of(town(), static_cast<int>(i));
    for (const auto& [mat, primitive] : mesh.primitives) {
      for (const Vertex& v : primitive.vertices) {
        const glm::vec3 p(world * glm::vec4(v.position_m, 1.0f));
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    }
  }
  EXPECT_NEAR(high.z - low.z, 120.0f, 6.0f);
  EXPECT_NEAR(high.x - low.x, 120.0f, 6.0f);
  EXPECT_LT(high.y, 0.25f);
  EXPECT_GT(low.y, -0.15f);
}

// Hollows hold one to five centimetres, level at their brim, and run off where a gully takes it.
TEST(City, HollowsHoldWaterUpToTheirBrim) {
  const StandingWater water = flood_streets();
  ASSERT_GE(water.basins.size(), 12u);
  float deepest = 0.0f;
  for (const Basin& basin : water.basins) {
    deepest = std::max(deepest, basin.maximum_depth_m);
    EXPECT_GE(basin.catchment_m2, basin.area_m2 * 0.999f) << "rain that falls into it stays";
    EXPECT_LT(basin.volume_m3, basin.area_m2 * basin.maximum_depth_m);
    EXPECT_GT(basin.volume_m3, 0.1f * basin.area_m2 * basin.maximum_depth_m);
  }
  EXPECT_GT(deepest, 0.010f);
  EXPECT_LT(deepest, 0.080f);
  double covered_m2 = 0.0;
  double street_m2 = 0.0;
  for (std::size_t k = 0; k < water.ground_m.size(); ++k) {
    if (!std::isfinite(water.ground_m[k])) continue;
    ASSERT_GE(water.level_m[k], water.ground_m[k]);
    street_m2 += water_cell_m * water_cell_m;
    if (water.level_m[k] - water.ground_m[k] > 0.001f) covered_m2 += water_cell_m * water_cell_m;
    if (water.depth_m[k] > 0.0f) {
      ASSERT_NEAR(water.depth_m[k], water.level_m[k] - water.ground_m[k], 1e-6f);
    }
  }
  EXPECT_GT(covered_m2 / street_m2, 0.01);
  EXPECT_LT(covered_m2 / street_m2, 0.25);
  double caught_m2 = 0.0;
  for (const Basin& basin : water.basins) caught_m2 += basin.catchment_m2;
  EXPECT_LE(caught_m2, street_m2) << "no rain runs into two basins";
  for (const glm::vec2& gully : water.gullies) EXPECT_LT(water.depth_at(gully.x, gully.y), 0.02f);
  // Wet cells have no lower way out: every neighbour of standing water stands at least as high.
  const int n = water.size;
  for (int j = 1; j + 1 < n; ++j) {
    for (int i = 1; i + 1 < n; ++i) {
      const auto at = [n](int a, int b) {
        return static_cast<std::size_t>(b) * static_cast<std::size_t>(n) + static_cast<std::size_t>(a);
      };
      const std::size_t k = at(i, j);
      if (!std::isfinite(water.ground_m[k]) || water.level_m[k] - water.ground_m[k] <= 0.003f) continue;
      int lower = 0;
      for (int b = -1; b <= 1; ++b) {
        for (int a = -1; a <= 1; ++a) {
          const std::size_t m = at(i + a, j + b);
          if (!std::isfinite(water.level_m[m]) || water.level_m[m] >= water.level_m[k] - 1e-4f) continue;
          ++lower;
        }
      }
      ASSERT_EQ(lower, 0) << "water at " << i << ", " << j << " stands above its neighbour";
    }
  }
}

// Two ruts in each lane lie deeper than the ground beside them, and before the crossing, where buses brake, they hold
// water that the crown between them does not.
TEST(City, TyreTracksFillFirst) {
  const StandingWater water = flood_streets();
  int ruts = 0, between = 0, all = 0;
  for (float z = 6.0f; z < 40.0f; z += 0.25f) {
    for (const float side : {-1.0f, 1.0f}) {
      for (const float end : {-1.0f, 1.0f}) {
        ruts += water.depth_at(side * 0.75f, end * z) > 0.0f;
        ruts += water.depth_at(side * 2.25f, end * z) > 0.0f;
        between += water.depth_at(side * 1.5f, end * z) > 0.0f;
        between += water.depth_at(side * 0.05f, end * z) > 0.0f;
        all += 2;
      }
    }
  }
  EXPECT_GT(ruts, 2 * between) << "of " << all;
}

// The mask of the ground is the depth below the brim: where a puddle's rectangle lies, some vertex has it at its
// deepest.
TEST(City, GroundCarriesTheDepthOfItsHollows) {
  const StandingWater water = flood_streets();
  for (const Basin& basin : water.basins) {
    float deepest = 0.0f;
    for (const Mesh& mesh : town().meshes) {
      for (const auto& [mat, primitive] : mesh.primitives) {
        if (mat != Mat::asphalt && mat != Mat::setts) continue;
        for (const Vertex& v : primitive.vertices) {
          if (v.position_m.x >= basin.minimum_m.x && v.position_m.x <= basin.maximum_m.x &&
              v.position_m.z >= basin.minimum_m.y && v.position_m.z <= basin.maximum_m.y)
            deepest = std::max(deepest, v.puddle_depth_m);
        }
      }
    }
    EXPECT_GT(deepest, 0.3f * basin.maximum_depth_m) << basin.minimum_m.x << ", " << basin.minimum_m.y;
  }
}

}  // namespace
}  // namespace petrichor::city
