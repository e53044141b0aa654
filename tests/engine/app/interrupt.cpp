#include "engine/app/interrupt.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

namespace petrichor {
namespace {

// _Exit: threads of libraries do not live on in the forked child, so their destructors would wait for ever.

TEST(Interrupt, TheFirstSignalIsRememberedAndHandedOn) {
  EXPECT_EXIT(
      {
        catch_interrupts();
        if (interrupted()) std::_Exit(3);
        std::raise(SIGINT);
        if (!interrupted()) std::_Exit(4);
        end_if_interrupted();
        std::_Exit(5);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(Interrupt, TheSecondSignalEndsAtOnce) {
  EXPECT_EXIT(
      {
        catch_interrupts();
        std::raise(SIGTERM);
        std::raise(SIGTERM);
        std::_Exit(5);
      },
      testing::KilledBySignal(SIGTERM), "");
}

TEST(Interrupt, WhatTheCallerIgnoresStaysIgnored) {
  EXPECT_EXIT(
      {
        std::signal(SIGHUP, SIG_IGN);
        catch_interrupts();
        std::raise(SIGHUP);
        std::_Exit(interrupted() ? 4 : 0);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace petrichor
