#pragma once

namespace windlass::app {

/// From here on Ctrl-C and SIGTERM end the process at once, with 128 plus the signal's number as its status. Files are
/// replaced whole, so that nothing on disk is left half.
void catch_interrupts();

/// While one lives, Ctrl-C and SIGTERM only raise a flag, which the loop over points looks at: the current point is
/// finished and saved, then the command returns `interrupted`. A second Ctrl-C ends the process at once.
class DeferredInterrupts {
 public:
  DeferredInterrupts();
  ~DeferredInterrupts();
  DeferredInterrupts(const DeferredInterrupts&) = delete;
  DeferredInterrupts& operator=(const DeferredInterrupts&) = delete;
};

/// True once the user wants to stop.
bool interrupted_by_user();

}  // namespace windlass::app
