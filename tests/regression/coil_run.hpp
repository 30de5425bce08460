#pragma once

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "support/run_program.hpp"

/// Runs of the rod of length 30, a full turn round the cylinder.
namespace windlass::test {

inline constexpr double full_turn = 2.0 * M_PI;

inline std::string coil() { return shipped_scene("capstan-2pi"); }

using Words = std::vector<std::string>;

inline Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

inline Words planar(const std::string& command, const Words& more = {}) {
  return Words{command, coil(), "--set", "model.kind=planar"} + more;
}

inline double relative(double value, double exact) { return std::abs(value / exact - 1.0); }

/// A short branch, T from 5 to 0.55, in `folder`/run.
inline void make_run(const TemporaryFolder& folder, const Words& more = {}) {
  const Outcome outcome = run_program(
      planar("continue", Words{"--set", "continuation.to=0.55", "--out", "run"} + more), folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
}

}  // namespace windlass::test
