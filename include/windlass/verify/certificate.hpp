#pragma once

#include <nlohmann/json_fwd.hpp>
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

/// What is asked of a stored point.
struct Standard {
  double tolerance = 1e-12;  ///< relative, of the reference integration; a tenth of it is the absolute one
  double accept = 1e-9;      ///< largest mismatch, drift, hole and negative gap or force that passes
};

/// Checks one equilibrium of the scene.
///
/// Every arc is integrated again with CVODE (Adams), from stored sample to stored sample:
/// a tail amplifies errors by exp(√T L), so a single sweep would measure that growth and not the solution; where
/// even one step between samples does, the distance to the nearest true trajectory is measured (Shadow). Checks
/// the match at the next sample, the joints (position, frame, moment; the jump of n is the contact force along the
/// outward normal), the end conditions and pulls, the invariants of PHYSICS (H, axial torque, n_z, twisting moment),
/// unilateral contact (gaps and forces >= 0, tangency), and that length, loads and R_tot are those of
/// the scene and of the contact forces.
/// In units of EI = 1 (struts: and length 1), forces are divided by max(1, T), moments by max(1, √T), for struts with T the size of the end force.
///
/// @throws nothing about the solution: a malformed one fails the check "structure", one that CVODE cannot follow the
///         check "integration"
Certificate verify(const equilibrium::Solution& solution, const scene::Scene& scene,
                   const Standard& standard = {});

/// {passed, checks: [{name, value, bound, passed, meaning}]}; a value that is not finite is null.
nlohmann::ordered_json to_json(const Certificate& certificate);

/// One aligned line a check.
std::string to_text(const Certificate& certificate);

}  // namespace windlass::verify
