// What the rain visibly strikes: things that stand apart, so that their outlines show against what is behind.
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "content/city/parts.hpp"

namespace petrichor::city {

void mark_rain_catchers(Scene& scene) {
  constexpr std::array<std::string_view, 13> names{
      "parked_car", "lane_car",   "waiting_taxi",  "coming_car", "bollard",     "litter_bin",   "bench",
      "planter",    "pillar_box", "telephone_box", "news_kiosk", "bus_shelter", "traffic_light"};
  for (Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    for (const std::string_view name : names) {
      if (!node.name.starts_with(name)) continue;
      nlohmann::json extras =
          node.extras_json.empty() ? nlohmann::json::object() : nlohmann::json::parse(node.extras_json);
      extras["rain_catcher"] = nlohmann::json::object();
      node.extras_json = extras.dump();
      break;
    }
  }
}

}  // namespace petrichor::city
