#include "engine/app/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace petrichor {
namespace {

volatile std::sig_atomic_t caught = 0;

void remember(int signal) {
  caught = signal;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);  // the second one is not caught
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    // What the caller had ignored (nohup) stays ignored.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
}

bool interrupted() {
  return caught != 0;
}

void end_if_interrupted() {
  if (!caught) return;
  std::signal(caught, SIG_DFL);
  std::raise(caught);
}

}  // namespace petrichor
