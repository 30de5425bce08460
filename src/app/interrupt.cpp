#include "app/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace windlass::app {

namespace {

std::atomic<int> deferrals{0};
std::atomic<bool> flag{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a signal handler may touch only lock-free atomics");

extern "C" void on_signal(int signal) {
  if (deferrals.load() > 0 && !flag.exchange(true)) return;
  constexpr char message[] = "\nwindlass: interrupted\n";
  [[maybe_unused]] const auto ignored = ::write(STDERR_FILENO, message, sizeof message - 1);
  ::_exit(128 + signal);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

DeferredInterrupts::DeferredInterrupts() { ++deferrals; }
DeferredInterrupts::~DeferredInterrupts() { --deferrals; }

bool interrupted_by_user() { return flag.load(); }

}  // namespace windlass::app
