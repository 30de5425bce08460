#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"

/// Certificates: what a stored equilibrium must satisfy, checked by means other than those that computed it.
namespace windlass::verify {

enum class Sense { at_most, at_least };

/// One measured quantity against its bound; a value that is not finite fails.
struct Check {
  std::string name;
  double value = 0.0;
  double bound = 0.0;
  Sense sense = Sense::at_most;
  std::string meaning;  ///< one line, with the scale the value was divided by
  bool passed() const;
};

struct Certificate {
  std::vector<Check> checks;
  bool passed() const;
  /// Check by name, or nullptr.
  const Check* find(const std::string& name) const;
  /// The failed check that exceeds its bound most, or nullptr when all passed.
  const Check* worst() const;
};

/// Checks one equilibrium of the scene.
///
/// Every arc is integrated again with CVODE (Adams, rtol 1e-12, atol 1e-13), from stored sample to stored sample:
/// a tail amplifies errors by exp(√T L), so a single sweep would measure that growth and not the solution; where
/// even one step between samples does, the distance to the nearest true trajectory is measured (Shadow). Checks
/// the match at the next sample, the joints (position, frame, moment; the jump of n is the contact force along the
/// outward normal), the end conditions and pulls, the invariants of PHYSICS (H, axial torque, n_z, twisting moment),
/// unilateral contact (gaps and forces >= 0, tangency), and that R_tot is the sum of the contact forces.
/// Forces are divided by max(1, T), moments by max(1, √T), for struts with T the size of the end force.
///
/// @throws nothing about the solution: a malformed one fails the check "structure"; std::runtime_error when CVODE
///         itself cannot be set up
Certificate verify(const equilibrium::Solution& solution, const scene::Scene& scene);

/// {passed, checks: [{name, value, bound, passed, meaning}]}; a value that is not finite is null.
nlohmann::ordered_json to_json(const Certificate& certificate);

/// One aligned line a check.
std::string to_text(const Certificate& certificate);

}  // namespace windlass::verify
