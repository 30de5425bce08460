#include "windlass/verify/certificate.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "checks.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::verify {

using equilibrium::ArcRecord;
using equilibrium::Solution;

bool Check::passed() const {
  if (!std::isfinite(value)) return false;
  return sense == Sense::at_most ? value <= bound : value >= bound;
}

bool Certificate::passed() const {
  return !checks.empty() &&
         std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.passed(); });
}

const Check* Certificate::find(const std::string& name) const {
  const auto found =
      std::find_if(checks.begin(), checks.end(), [&](const Check& check) { return check.name == name; });
  return found == checks.end() ? nullptr : &*found;
}

const Check* Certificate::worst() const {
  const Check* worst = nullptr;
  double worst_excess = 0.0;
  for (const Check& check : checks) {
    if (check.passed()) continue;
    const double excess = std::isfinite(check.value) ? std::abs(check.value - check.bound) : HUGE_VAL;
    if (worst == nullptr || excess > worst_excess) worst = &check, worst_excess = excess;
  }
  return worst;
}

namespace {

std::string arc_error(const ArcRecord& arc, std::size_t number) {
  const std::string where = "arc " + std::to_string(number);
  const auto count = arc.s.size();
  if (count < 2) return where + " has fewer than two samples";
  if (arc.r.cols() != count || arc.q.cols() != count || arc.n.cols() != count || arc.m.cols() != count ||
      arc.p.size() != count) {
    return where + " has samples that differ in number";
  }
  const bool finite = arc.s.allFinite() && arc.r.allFinite() && arc.q.allFinite() && arc.n.allFinite() &&
                      arc.m.allFinite() && arc.p.allFinite();
  if (!finite) return where + " holds a number that is not finite";
  // Where an event makes an arc vanish, its length is zero to the precision of the event, with either sign.
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    if (arc.s[i + 1] < arc.s[i] - tight) return where + " has samples out of order";
  }
  return {};
}

}  // namespace

std::string structure_error(const Solution& solution) {
  for (const equilibrium::JointRecord& joint : solution.joints)
    if (joint.partner >= static_cast<int>(solution.joints.size()))
      return "a joint touches one that is not there";
  if (!solution.converged) return "the solution is marked as not converged";
  if (solution.arcs.empty()) return "the solution has no arcs";
  if (solution.joints.size() != solution.arcs.size() + 1) return "arcs and joints do not alternate";
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    if (std::string error = arc_error(solution.arcs[k], k); !error.empty()) return error;
    if (k == 0) continue;
    const ArcRecord& before = solution.arcs[k - 1];
    if (std::abs(before.s[before.s.size() - 1] - solution.arcs[k].s[0]) > tight)
      return "there is a hole between arcs";
  }
  return {};
}

Certificate verify(const Solution& stored, const scene::Scene& given, const Standard& standard) {
  // Bounds are for EI = 1 (struts: and length 1).
  const scene::Scene scene = scene::natural(given);
  const scene::Units& units = scene.solved_in;
  Solution solution = stored;
  equilibrium::multiply(solution, scene::Units::of(1.0 / units.length, 1.0 / units.bending_stiffness));
  CheckList list(standard);
  const std::string error = structure_error(solution);
  list.at_most("structure", error.empty() ? 0.0 : 1.0, 0.0,
               error.empty() ? "arcs, joints and samples fit together" : error);
  if (!error.empty()) return list.take();
  Scales scales;
  scales.force = std::max(1.0, std::abs(solution.has_cylinder ? solution.T : solution.end_force));
  const Stiffness law(scene.rod);
  if (law.weighs()) scales.force = std::max(scales.force, law.weight.norm() * scene.rod.length);
  scales.moment = std::sqrt(scales.force);
  scales.tolerance = standard.tolerance;
  double virial = 0.0;
  try {
    virial = check_arcs(solution, scene, scales, list);
  } catch (const std::runtime_error& failure) {  // CVODE gives up on a damaged state
    list.at_most("integration", NAN, 0.0, failure.what());
  }
  check_joints(solution, scene, scales, list);
  check_ends(solution, scene, scales, list);
  check_invariants(solution, scene, scales, virial, list);
  check_totals(solution, scene, scales, list);
  return list.take();
}

nlohmann::ordered_json to_json(const Certificate& certificate) {
  nlohmann::ordered_json json;
  json["passed"] = certificate.passed();
  json["checks"] = nlohmann::ordered_json::array();
  for (const Check& check : certificate.checks) {
    nlohmann::ordered_json entry;
    entry["name"] = check.name;
    entry["value"] =
        std::isfinite(check.value) ? nlohmann::ordered_json(check.value) : nlohmann::ordered_json(nullptr);
    entry["bound"] = check.bound;
    entry["sense"] = check.sense == Sense::at_most ? "at_most" : "at_least";
    entry["passed"] = check.passed();
    entry["meaning"] = check.meaning;
    json["checks"].push_back(std::move(entry));
  }
  return json;
}

std::string to_text(const Certificate& certificate) {
  std::string text;
  char line[256];
  for (const Check& check : certificate.checks) {
    std::snprintf(line, sizeof line, "  %-6s %-20s %10.2e %s %8.0e  ", check.passed() ? "ok" : "FAILED",
                  check.name.c_str(), check.value, check.sense == Sense::at_most ? "<=" : ">=", check.bound);
    text += line + check.meaning + "\n";
  }
  return text;
}

}  // namespace windlass::verify
