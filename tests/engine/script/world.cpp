// Entities and components as scripts see them, made from the schemas alone.

#include <unistd.h>

#include "tests/engine/script/fixture.hpp"

namespace petrichor {
namespace {

class World : public ScriptTest {};

// A component that only this test knows: the bindings need nothing but its schema.
struct Kettle {
  float water_l = 1.0f;
  bool whistles = false;
  std::uint64_t serial = 7;
  glm::vec2 spout_m{0.1f, 0.2f};
  std::string maker = "nobody";
};

TEST_F(World, AnySchemaIsBound) {
  const std::vector<Schema> schemas{schema<Kettle>(
      "kettle", "Boils.",
      {field<&Kettle::water_l>("water_l", "l", {0, 2}, "Water."),
       field<&Kettle::whistles>("whistles", "", {}, "Noise."),
       field<&Kettle::serial>("serial", "", {0, 1e15}, "Number."),
       field<&Kettle::spout_m>("spout_m", "m", {-1, 1}, "Tip."), field<&Kettle::maker>("maker", "", {}, "Who.")})};
  ScriptHost kitchen(registry, schemas, options);
  const auto result = kitchen.run_file(write("k.lua", R"(
local k = world.spawn{kettle={water_l=1.5, whistles=true, spout_m={x=0.5, y=-0.5}, maker="Ümit"}}
local seen = {}
for field, value in pairs(k.kettle) do seen[#seen + 1] = field .. "=" .. tostring(value) end
print(table.concat(seen, " "))
k.kettle.serial = 12345678901234
print(k.kettle.serial, math.type(k.kettle.serial), k.kettle.spout_m.y, k)
)"));
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(printed[0], "water_l=1.5 whistles=true serial=7 spout_m={0.5, -0.5} maker=Ümit");
  EXPECT_EQ(printed[1], "12345678901234\tinteger\t-0.5\tentity " + std::to_string(0));
  EXPECT_EQ(registry.size<Kettle>(), 1u);
}

TEST_F(World, EveryFieldOfEveryComponentReadsBackWhatWasWritten) {
  std::string text;
  for (const Schema& s : component_schemas()) {
    text += "do local e = world.spawn{} e:add('" + std::string(s.name) + "')\n";
    if (s.fields.size() == 1 && s.fields[0].type == FieldType::text) {
      text += "e." + std::string(s.name) + " = 'x' assert(e." + std::string(s.name) + " == 'x')";
    } else {
      text += "for field, value in pairs(e." + std::string(s.name) + ") do e." + std::string(s.name) +
              "[field] = value assert(e." + std::string(s.name) + "[field] == value, field) end\n";
    }
    text += " assert(e:has('" + std::string(s.name) + "')) e." + std::string(s.name) + " = nil assert(not e:has('" +
            std::string(s.name) + "')) end\n";
  }
  expect_ok(text);
}

TEST_F(World, ScriptsMakeRain) {
  expect_ok(R"(
local rain = world.spawn{ name="rain", emitter={ rain_mm_per_hour=25 }, wind={ velocity_mps={3,0,1} } }
rain.emitter.rain_mm_per_hour = 50
print(rain.emitter.rain_mm_per_hour, rain.name, rain:has("emitter"), rain:has("fog"), rain.wind.velocity_mps)
rain:add("fog", {extinction_per_km=4})
print(rain.fog.extinction_per_km, rain.fog.albedo.g)
rain.fog = {albedo={r=0.5, g=0.25, b=0.125}}
print(rain.fog.extinction_per_km, rain.fog.albedo, rain.fog.albedo[2])
rain:remove("fog")
print(rain:has("fog"), world.find("rain") == rain, world.find("snow"), world.count("emitter"), world.time())
rain.emitter.drop_sizes = "gamma"
print(rain.emitter.drop_sizes, rain.emitter, rain:alive())
rain:destroy()
print(rain:alive(), world.find("rain"))
)");
  EXPECT_EQ(printed,
            (std::vector<std::string>{"50.0\train\ttrue\tfalse\t{3, 0, 1}", "4.0\t" + std::string("0.95999997854233"),
                                      "4.0\t{0.5, 0.25, 0.125}\t0.25", "false\ttrue\tnil\t1\t0.0",
                                      "gamma\temitter of entity \"rain\"\ttrue", "false\tnil"}));
  EXPECT_EQ(registry.size(), 0u);
}

TEST_F(World, MistakesAreToldWithAHint) {
  const std::string rain = "local rain = world.spawn{name='rain', emitter={}}\n";
  EXPECT_CONTAINS(error_of("world.spawn{emiter={}}"), "did you mean \"emitter\"");
  EXPECT_CONTAINS(error_of("world.spawn{emitter={rain=1}}"), "rain_mm_per_hour");
  EXPECT_CONTAINS(error_of("world.spawn{emitter=5}"), "table of fields");
  EXPECT_CONTAINS(error_of("world.spawn{{}}"), "component name");
  EXPECT_CONTAINS(error_of("world.spawn{emitter={1}}"), "field=value");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.rain_mm_per_hour = 0/0"), "emitter.rain_mm_per_hour");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.rain_mm_per_hour = 0/0"), "test.lua:2:");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.rain_mm_per_hour = math.huge"), "finite");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.rain_mm_per_hour = -1"), "0 to 300");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.rain_mm_per_hour = '5'"), "number");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.rain_mm_per_hour = nil"), "nil");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.maximum_drops = 1.5"), "whole");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.drop_sizes = 'gama'"), "gamma");
  EXPECT_CONTAINS(error_of(rain + "rain.emitter.rain_mm_per_our = 1"), "did you mean \"rain_mm_per_hour\"");
  EXPECT_CONTAINS(error_of(rain + "return rain.emitter.wet"), "no field \"wet\"");
  EXPECT_CONTAINS(error_of(rain + "return rain.fog.albedo"), "entity \"rain\" has no fog");
  EXPECT_CONTAINS(error_of(rain + "rain.wind = {velocity_mps={1, 2}}"), "3 numbers");
  EXPECT_CONTAINS(error_of(rain + "rain.wind = {velocity_mps={x=1, y=2}}"), "3 numbers");
  EXPECT_CONTAINS(error_of(rain + "rain.wind = {velocity_mps={1, 2, 3, 4}}"), "3 numbers");
  EXPECT_CONTAINS(error_of(rain + "rain.wind = {velocity_mps={1, 2, 'x'}}"), "3 numbers");
  EXPECT_CONTAINS(error_of(rain + "rain.name = '\\xff'"), "UTF-8");
  EXPECT_CONTAINS(error_of(rain + "vec3(1, 2, 3).x = 5"), "vector");
  EXPECT_CONTAINS(error_of("world.each('lamp', print)"), "no component");
  EXPECT_CONTAINS(error_of("cinematic{durations=3}"), "duration_s");
  // What failed to spawn is not there half made.
  const std::size_t before = registry.size();
  error_of("world.spawn{name='a', emitter={rain_mm_per_hour=-5}}");
  EXPECT_EQ(registry.size(), before);
}

TEST_F(World, ADestroyedEntityIsAClearError) {
  expect_ok("e = world.spawn{emitter={}} c = e.emitter e:destroy()");
  for (const char* use : {"e.emitter = {}", "return e.emitter", "e:destroy()", "return e:has('emitter')",
                          "e:add('fog')", "c.rain_mm_per_hour = 1", "return c.rain_mm_per_hour",
                          "tween(c, 'rain_mm_per_hour', 1, 1)", "for k in pairs(c) do end"}) {
    const std::string message = error_of(use);
    EXPECT_CONTAINS(message, "destroyed");
    EXPECT_CONTAINS(message, "test.lua:1:");
  }
  expect_ok("print(e, c, e:alive())");
  // Its successor in the same slot is somebody else.
  expect_ok("local f = world.spawn{emitter={}} print(f == e, e:alive(), f:alive())");
  EXPECT_EQ(printed.back(), "false\tfalse\ttrue");
  EXPECT_CONTAINS(
      error_of("local e = world.spawn{emitter={}} local c = e.emitter e:remove('emitter') c.rain_mm_per_hour = 1"),
      "no emitter any more");
}

TEST_F(World, EachMayChangeTheWorld) {
  expect_ok(
      "for i = 1, 5 do world.spawn{light={intensity_cd=i}} end local n = 0 "
      "world.each('light', function(e) n = n + 1 world.spawn{light={}} if e:alive() then e:destroy() end end) print(n, "
      "world.count('light'))");
  EXPECT_EQ(printed.back(), "5\t5");
}

TEST_F(World, RotationsPointWhereTheyShould) {
  expect_ok(
      "a = world.spawn{transform={orientation=look_at({0, 0, 0}, {1, 0, 0})}} b = "
      "world.spawn{transform={orientation=euler(90, 0, 0)}} "
      "c = world.spawn{transform={orientation=look_at({0, 5, 0}, {0, 0, 0})}} d = "
      "world.spawn{transform={orientation=euler(0, 30)}}");
  std::vector<glm::vec3> forward;
  registry.view<Transform>().each(
      [&](Entity, Transform& t) { forward.push_back(t.orientation * glm::vec3(0, 0, -1)); });
  ASSERT_EQ(forward.size(), 4u);
  EXPECT_LT(glm::length(forward[0] - glm::vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::length(forward[1] - glm::vec3(-1, 0, 0)), 1e-6f);  // yaw turns left
  EXPECT_LT(glm::length(forward[2] - glm::vec3(0, -1, 0)), 1e-6f);
  EXPECT_LT(glm::length(forward[3] - glm::vec3(0, 0.5f, -std::sqrt(0.75f))), 1e-6f);  // pitch tilts up
  error_of("look_at({0, 0, 0}, {0, 0, 0})");
  expect_ok("local v = vec3(1, 2, 3) * 2 - {1, 1, 1} print(v, -v, v == vec3(1, 3, 5), v.b, v / 2, 2 * v)");
  EXPECT_EQ(printed.back(), "{1, 3, 5}\t{-1, -3, -5}\ttrue\t5.0\t{0.5, 1.5, 2.5}\t{2, 6, 10}");
}

TEST_F(World, ModelsAreListsOfEntities) {
  options.services.load_model = [&](const std::filesystem::path& path) -> Result<std::vector<Entity>> {
    if (path != "content/city.glb") return failure(path.string() + ": no such model");
    std::vector<Entity> out;
    for (const char* name : {"root", "lamp", "lamp"}) {
      out.push_back(registry.create());
      registry.emplace<Name>(out.back(), Name{name});
    }
    registry.emplace<Light>(out[1]);
    return out;
  };
  options.services.bounds = [](std::span<const Entity> entities) -> Result<std::pair<glm::vec3, glm::vec3>> {
    if (entities.size() != 3) return failure("nothing to see");
    return std::pair{glm::vec3(-1, 0, -2), glm::vec3(1, 5, 2)};
  };
  Entity child, parent;
  options.services.set_parent = [&](Entity c, Entity p) -> Result<void> {
    child = c;
    parent = p;
    return {};
  };
  expect_ok(
      "local city = world.model('content/city.glb') print(#city, city[1].name, city:find('lamp') == city[2], "
      "city:find('x'), city:count('light')) "
      "local low, high = city:bounds() print(low, high) city:each('light', function(e) print(e) end) "
      "world.spawn{name='bulb', parent=city[2]}");
  EXPECT_EQ(printed, (std::vector<std::string>{"3\troot\ttrue\tnil\t1", "{-1, 0, -2}\t{1, 5, 2}", "entity \"lamp\""}));
  EXPECT_TRUE(registry.has<Light>(parent));
  EXPECT_EQ(registry.get<Name>(child).text, "bulb");
  EXPECT_CONTAINS(error_of("world.model('content/none.glb')"), "no such model");
  EXPECT_CONTAINS(error_of("world.model('content/none.glb')"), "test.lua:1:");
  EXPECT_CONTAINS(error_of("local city = world.model('content/city.glb') city[1]:destroy() city:bounds()"),
                  "nothing to see");
}

TEST_F(World, WithoutServicesTheirFunctionsAreErrors) {
  EXPECT_CONTAINS(error_of("world.model('a.glb')"), "cannot be loaded");
  EXPECT_CONTAINS(error_of("world.spawn{parent=world.spawn{}}"), "parent");
}

TEST_F(World, CinematicsDeclareThemselves) {
  expect_ok("cinematic{duration_s=10, fps=24, size={640, 360}, render='scripts/render/city.lua'}");
  EXPECT_EQ(host().duration_s(), 10.0);
  EXPECT_EQ(host().cinematic().fps, 24.0);
  EXPECT_EQ(host().cinematic().size_px, glm::ivec2(640, 360));
  EXPECT_EQ(host().cinematic().render, "scripts/render/city.lua");
  for (const char* bad : {"cinematic{fps=0}", "cinematic{fps='x'}", "cinematic{duration_s=-1}",
                          "cinematic{duration_s=0/0}", "cinematic{size={0, 5}}", "cinematic{size={1.5, 5}}",
                          "cinematic{size=5}", "cinematic{render=5}", "cinematic{1}", "cinematic()"}) {
    EXPECT_CONTAINS(error_of(bad), "test.lua:1:");
  }
}

TEST_F(World, FilesAreListedForReload) {
  write("part.lua", "return 1");
  write("broken.lua", "return = 1");
  expect_ok("require('part') require('part')");
  error_of("require('broken')");
  const auto& files = host().files();
  const auto has = [&](const char* name) {
    return std::find(files.begin(), files.end(), folder / name) != files.end();
  };
  EXPECT_TRUE(has("test.lua") && has("part.lua") && has("broken.lua"));
}

TEST_F(World, ArgumentsReachTheScript) {
  options.arguments = {{"model_path", "a b.glb"}};
  expect_ok("print(args.model_path, args.other)");
  EXPECT_EQ(printed.back(), "a b.glb\tnil");
}

TEST_F(World, WhatLivesOutsideLuaHasCaps) {
  options.limits.entities = 1000;
  options.limits.handlers = 100;
  options.limits.models = 3;
  options.services.load_model = [](const std::filesystem::path&) { return std::vector<Entity>{}; };
  EXPECT_CONTAINS(error_of("while true do world.spawn{} end"), "1000 entities");
  EXPECT_EQ(registry.size(), 1000u);
  EXPECT_CONTAINS(error_of("while true do on('x', print) end"), "handlers");
  EXPECT_CONTAINS(error_of("while true do world.model('a.glb') end"), "models");
  registry.clear();
  EXPECT_CONTAINS(error_of("world.spawn{name=('x'):rep(5000)}"), "5000 bytes");
  EXPECT_CONTAINS(error_of("emit(('x'):rep(5000))"), "256");
}

}  // namespace
}  // namespace petrichor
