#include "engine/script/reference.hpp"

#include <fmt/format.h>

#include <array>

#include "engine/script/bindings.hpp"
#include "engine/script/script.hpp"

namespace petrichor {
namespace {

using script::Binding;

struct Section {
  std::string_view owner;
  std::string_view title;
  std::string_view text;
};

constexpr std::array sections{
    Section{"", "Anywhere", ""},
    Section{"world", "world", ""},
    Section{"entity", "Entities",
            "`rain.emitter` is a component of the entity `rain`, `rain.emitter.rain_mm_per_hour` one of its fields; "
            "both are read and "
            "written like tables. `rain.fog = {extinction_per_km=4}` adds a component or sets fields of the one that "
            "is there, "
            "`rain.fog = nil` takes it away, `pairs(rain.emitter)` walks the fields. A component that is one text "
            "stands for the text: "
            "`rain.name`. Vectors and colours are `{1, 2, 3}`, `{x=1, y=2, z=3}` or `{r=1, g=0, b=0}`; rotations are "
            "quaternions "
            "`{x, y, z, w}`. Every value is checked against the field's type and range."},
    Section{"model", "Models",
            "What `world.model` gives: a list of entities (`#model`, `model[1]`, `ipairs(model)`), parents first."},
    Section{"handler", "Handlers", "What `on` gives."},
    Section{"camera", "camera", ""},
};

constexpr std::string_view introduction = R"(# Scripts

Scripts are Lua 5.4. A script makes entities, sets their components and directs them in simulation time:

```lua
local rain = world.spawn{ name="rain", emitter={ rain_mm_per_hour=2 }, wind={ velocity_mps={1, 0, 0} } }
timeline(function()
  wait(2)
  tween(rain.emitter, "rain_mm_per_hour", 50, 4, "smooth")
end)
```

A story (the script itself, and what is given to `timeline`, `go` and `on`) runs until it waits, and goes on at the
very time it asked for: waits add up without drift, and the same script gives the same film whatever the step of
the simulation. Stories that are due at the same time go on in the order in which they began. `args` holds what the
program hands to the script.

)";

constexpr std::string_view tables = R"(## Files that return a table

Render scripts (`scripts/render/`) and weather presets return a table of plain data; they see the library below but
no world. A table with the keys 1 to n is a list. Any other is a set of names, and in it whole numbers as keys turn into
their digits; the empty table counts as one without names. Functions, NaN and tables that contain themselves are errors.

)";

}  // namespace

std::string script_reference() {
  std::string page(introduction);
  for (const Section& section : sections) {
    page += fmt::format("## {}\n\n", section.title);
    if (!section.text.empty()) page += fmt::format("{}\n\n", section.text);
    page += "| function | meaning |\n|---|---|\n";
    for (const auto list : script::all_bindings()) {
      for (const Binding& binding : list) {
        if (binding.owner == section.owner) page += fmt::format("| `{}` | {} |\n", binding.signature, binding.meaning);
      }
    }
    page += "\n";
  }
  page += tables;

  const ScriptLimits limits;
  page += fmt::format(
      "## Lua's library\n\n"
      "Scripts have these functions of Lua's library and no others: nothing that loads code, reads files or asks the "
      "clock. "
      "`require(\"scenes.city\")` runs `scripts/scenes/city.lua` once and gives what it returns. `pairs` and `next` go "
      "through numbers, strings, booleans and entities in that order and each kind sorted, so every run is the same; "
      "`math.random` "
      "counts from the run's seed (`--seed`). There are no finalisers (`__gc`). A script may use {} MiB of memory, {} "
      "million "
      "instructions to load and {} million in one step of the simulation; beyond that it is stopped, which it cannot "
      "catch.\n\n",
      limits.memory_bytes >> 20, limits.load_instructions / 1'000'000, limits.step_instructions / 1'000'000);
  page += "| library | functions |\n|---|---|\n";
  for (const auto& library : script::library_names()) {
    std::string names;
    for (const char* name : library.functions) names += fmt::format("{}`{}`", names.empty() ? "" : " ", name);
    page += fmt::format("| {} | {} |\n", *library.library ? fmt::format("`{}`", library.library) : "", names);
  }
  return page;
}

}  // namespace petrichor
