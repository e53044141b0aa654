#pragma once
// Ctrl-C and SIGTERM during long work: the work stops between two frames, half-written files are removed, and only
// then does the program end. A second signal ends it at once.

namespace petrichor {

void catch_interrupts();

// Whether a signal came since.
bool interrupted();

// Ends the program by the signal that came, so that the shell knows why; returns if none did.
void end_if_interrupted();

}  // namespace petrichor
