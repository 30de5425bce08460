#include "app/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace windlass::app {

namespace {

std::atomic<bool> flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch only lock-free atomics");

extern "C" void raise_flag(int signal) {
  if (flag.exchange(true)) {  // the user insists
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, raise_flag);
  std::signal(SIGTERM, raise_flag);
}

bool interrupted_by_user() { return flag.load(); }

}  // namespace windlass::app
