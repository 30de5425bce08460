#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "continuation/problem.hpp"

namespace continuation {

/// The event function of this name; null if there is none.
inline const EventFunction* find(const std::vector<EventFunction>& events, const std::string& name) {
  const auto at =
      std::find_if(events.begin(), events.end(), [&](const auto& event) { return event.name == name; });
  return at == events.end() ? nullptr : &*at;
}

}  // namespace continuation
