#pragma once

namespace windlass::app {

/// From here on Ctrl-C (and SIGTERM) only raises a flag, which the loop over points looks at: the current point is
/// finished and saved, then the process exits with 130. A second Ctrl-C ends the process at once.
void catch_interrupts();

/// True once the user wants to stop.
bool interrupted_by_user();

}  // namespace windlass::app
