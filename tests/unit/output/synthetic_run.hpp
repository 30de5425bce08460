#pragma once

#include "unit/verify/closed_form_rods.hpp"
#include "windlass/output/run_folder.hpp"

namespace windlass::test {

/// Planar capstan with a helical bump in z: not an equilibrium, only a shape with z_span > 0 to draw.
inline Solution helical_shape(double T, double phi, double pitch) {
  Solution solution = planar_capstan(T, phi);
  double low = 0.0, high = 0.0;
  for (ArcRecord& arc : solution.arcs) {
    for (Eigen::Index i = 0; i < arc.s.size(); ++i) {
      const double s = arc.s[i], z = pitch * std::tanh(s / 3.0),
                   slope = pitch / 3.0 / std::pow(std::cosh(s / 3.0), 2);
      const Eigen::Vector4d q = arc.q.col(i);
      Eigen::Vector3d d3 = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix().col(2);
      d3.z() = slope;
      arc.r(2, i) = z;
      const Eigen::Vector3d side = Eigen::Vector3d(d3.y(), -d3.x(), 0.0).normalized();
      set_frame(arc, i, side, d3.normalized());
      low = std::min(low, z), high = std::max(high, z);
    }
  }
  for (JointRecord& joint : solution.joints) joint.z = joint.r.z() = pitch * std::tanh(joint.s / 3.0);
  solution.z_span = high - low;
  solution.tilt = std::atan(pitch / 3.0);
  return solution;
}

/// A run folder made of closed forms: the planar branch, and a second branch that stands for a helical one.
inline void write_synthetic_run(const std::filesystem::path& folder, bool force = false) {
  constexpr double phi = 2 * std::numbers::pi, critical = 1.6;
  auto scene = capstan_scene(5.0, phi);
  scene.name = "capstan-2pi";
  output::WriterOptions options;
  options.force = force, options.command = "diagram", options.version = "test";
  auto writer = output::RunWriter::create(folder, scene, options);
  const auto add = [&](Solution solution, int branch, int point, double lowest, const char* label,
                       const char* type) {
    equilibrium::Stability stability;
    stability.index = lowest < -1e-12 ? 1 : 0;
    stability.eigenvalues = {lowest, lowest + 0.7, lowest + 1.9};
    equilibrium::Mode mode{lowest, "out", "odd", Eigen::VectorXd::LinSpaced(60, -4, 4),
                           Eigen::Matrix3Xd::Zero(3, 60)};
    for (int i = 0; i < 60; ++i) mode.displacement(2, i) = std::tanh(mode.s[i]) / std::cosh(mode.s[i] / 3);
    stability.modes.push_back(mode);
    solution.stability = stability;
    writer.add_point(output::make_row(solution, branch, point, label, type, 0.1), solution);
  };
  int point = 0;
  for (double T = 5.0; T > 0.5; T *= 0.96) {
    if (T / 0.96 > critical && T <= critical) {
      add(planar_capstan(critical, phi), 1, ++point, 0.0, "BP1", "branch_point");
      writer.add_special_point(
          {"BP1", "branch_point", 1, critical, phi, 1e-9, 1, output::SpecialMode{"out", "odd"}, "", "", {}});
    }
    add(planar_capstan(T, phi), 1, ++point, (T - critical) / 2, "", "regular");
  }
  add(planar_capstan(0.5, phi), 1, ++point, -0.55, "C1", "contact");
  writer.add_special_point(
      {"C1", "contact", 1, 0.5, phi, 1e-9, 1, {}, "tail edge line edge tail", "tail touch tail", {}});
  point = 0;
  for (double T = critical; T > 0.6; T *= 0.96) {
    auto solution = helical_shape(T, phi, 1.2 * std::sqrt(critical - T));
    solution.R_tot *= 1 - 0.25 * (critical - T);
    add(solution, 2, ++point, (critical - T) / 3 + 1e-9, "", "regular");
  }
  writer.finish("finished", {point, 0.02, 0.05, 0.1}, {{"branches", 2}});
}

}  // namespace windlass::test
