#include "systems/systems.hpp"

#include <gtest/gtest.h>

#include <set>

#include "components/components.hpp"

namespace petrichor {
namespace {

std::vector<SystemAccess> accesses() {
  const Schedule<SystemContext> schedule(all_systems(), component_schemas());
  const auto all = schedule.accesses();
  return {all.begin(), all.end()};
}

TEST(Systems, NoTwoOfAPhaseConflictUnordered) {
  for (const Conflict& conflict : conflicts(accesses()))
    ADD_FAILURE() << conflict.first << " and " << conflict.second << " both touch " << conflict.what
                  << ", and nothing says in which order";
}

TEST(Systems, TheListHasNoSlips) {
  const auto outside = outside_resources();
  for (const std::string& problem : problems(accesses(), component_schemas(), outside)) ADD_FAILURE() << problem;
}

TEST(Systems, PassesAndTheirSlotsHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const PassOffer& pass : all_passes()) {
    EXPECT_TRUE(names.insert(pass.name).second) << pass.name << " is offered twice";
    EXPECT_FALSE(pass.meaning.empty()) << pass.name;
    EXPECT_TRUE(pass.execute) << pass.name;
    std::set<std::string> slots;
    for (const Slot& slot : pass.slots) EXPECT_TRUE(slots.insert(slot.name).second) << pass.name << "." << slot.name;
  }
}

}  // namespace
}  // namespace petrichor
