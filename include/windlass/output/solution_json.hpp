#pragma once

#include <nlohmann/json_fwd.hpp>

#include "windlass/equilibrium/solution.hpp"
#include "windlass/scene/scene.hpp"

namespace windlass::output {

/// The object of `windlass solve --json` (CONTRACT). A physical scene adds `physical`, the same quantities as
/// {value, unit} in N, mm, N mm, mJ, N/mm and the tension also as a hung mass in g. Not-finite numbers are null.
nlohmann::ordered_json to_json(const equilibrium::Solution& solution, const scene::Scene& scene);

/// "tail", "gap", "line" of an arc; "end", "touch", "edge", "infinity" of a joint.
std::string arc_kind_name(const equilibrium::ArcRecord& arc);
std::string joint_kind_name(equilibrium::JointKind kind);
/// Inverse of joint_kind_name. @throws OutputError for any other name
equilibrium::JointKind joint_kind_from_name(const std::string& name);

}  // namespace windlass::output
