#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "windlass/scene/scene.hpp"

/// Where does a start from nothing succeed? Every case is solved on its own and its answer is put to the certificate.
namespace windlass::robustness {

enum class Outcome {
  solved,
  impossible,  ///< no equilibrium in contact exists: the rod is too short, or its loop is wider than the cylinder
  diverged,            ///< Newton, or a walk that ended for no mechanical reason
  event_loop,          ///< contact events that repeat without progress
  certificate_failed,  ///< a state was returned that is not one
};
inline constexpr std::array<std::string_view, 5> outcome_names{"solved", "impossible", "diverged",
                                                               "event_loop", "certificate_failed"};
std::string_view name(Outcome outcome);

struct Case {
  scene::Scene scene;
  std::string place;  ///< why it is asked: "grid", or the hard place it stands for
};

struct Answer {
  Outcome outcome = Outcome::diverged;
  std::string cause;     ///< empty for solved ones
  std::string topology;  ///< of the state found
  double R_tot = 0.0;
  int newton_iterations = 0;
  double seconds = 0.0;
};

/// Tensions spaced evenly in their logarithm, angles evenly; both ends of the ranges included.
struct Grid {
  double tension_low = 0.05, tension_high = 1e4;
  double angle_low = 0.25 * M_PI, angle_high = 8.0 * M_PI;
  int tensions = 40, angles = 40;
};
std::vector<Case> grid_cases(const scene::Scene& scene, const Grid& grid);

/// The places where methods fail: T close to the limit of line contact on both sides, phi close to pi, boundary layers
/// (T from 0.02 to 1e5), tails much longer and hardly longer than the wrap, 20 pi of wrap; half and full chains.
std::vector<Case> hard_cases(const scene::Scene& scene);

/// Solves the case and checks the answer. Never throws about the solution.
Answer try_case(const Case& one);

}  // namespace windlass::robustness
