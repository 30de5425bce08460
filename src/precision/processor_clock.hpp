#pragma once

#include <ctime>

namespace windlass::precision {

/// Time this process has had the processor [s]: the machine may be shared.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace windlass::precision
