// The page in docs/ and the functions of a script are one list.

#include "engine/script/reference.hpp"

#include <unistd.h>

#include "engine/ecs/schema_reference.hpp"
#include "tests/engine/script/fixture.hpp"

namespace petrichor {
namespace {

class Reference : public ScriptTest {};

TEST_F(Reference, EveryFunctionIsOnThePageAndTheOtherWayRound) {
  const std::string page = script_reference();
  // All that a script can name, asked of the sandbox itself.
  expect_ok(R"(
local function names(t, prefix)
  for name, value in pairs(t) do
    if type(value) == "function" then print(prefix .. name)
    elseif type(value) == "table" and name ~= "_G" and name ~= "args" then names(value, prefix .. name .. ".") end
  end
end
names(_G, "")
)");
  EXPECT_GT(printed.size(), 60u);
  for (const std::string& name : printed) {
    const auto dot = name.find('.');
    const std::string short_name = name.substr(dot == std::string::npos ? 0 : dot + 1);
    EXPECT_TRUE(contains(page, "`" + name + "(") || contains(page, "`" + name + "{") ||
                contains(page, "`" + short_name + "`"))
        << name;
  }
  // And each row of the page is a function that is there.
  std::istringstream lines(page);
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `") || contains(line, "| `coroutine`") || contains(line, "| `math`") ||
        contains(line, "| `string`") || contains(line, "| `table`") || contains(line, "| `utf8`")) {
      continue;
    }
    ++rows;
    std::string name = line.substr(3, line.find_first_of("({", 3) - 3);
    const auto colon = name.find(':');
    if (colon == std::string::npos)
      expect_ok("assert(type(" + name + ") == 'function')");
    else if (name.starts_with("entity"))
      expect_ok("assert(type(world.spawn{}." + name.substr(colon + 1) + ") == 'function')");
    else if (name.starts_with("handler"))
      expect_ok("assert(type(on('x', print)." + name.substr(colon + 1) + ") == 'function')");
    else
      EXPECT_TRUE(name.starts_with("model")) << name;
  }
  EXPECT_GT(rows, 25);
}

TEST_F(Reference, ThePageInDocsIsTheOneThatIsGenerated) {
  std::ifstream stream(std::filesystem::path(PETRICHOR_SOURCE_DIR) / "docs/reference.md");
  std::stringstream page;
  page << stream.rdbuf();
  EXPECT_TRUE(page.str() == script_reference() + "\n" + schema_reference(component_schemas()))
      << "write it anew: petrichor info --reference docs/reference.md";
}

}  // namespace
}  // namespace petrichor
