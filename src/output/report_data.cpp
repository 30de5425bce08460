#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "sheet.hpp"
#include "windlass/output/plot.hpp"
#include "windlass/output/report.hpp"
#include "windlass/output/rod_curve.hpp"
#include "windlass/output/stable_state.hpp"

namespace windlass::output {

using Eigen::Vector3d;
using equilibrium::Mode;
using equilibrium::Solution;
using nlohmann::ordered_json;

namespace {

/// Half width of the space shown round the cylinder [ρ]; tails are cut there.
constexpr double reach = 3.5;

/// Five significant digits: enough to draw, a third of the size.
double rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 4 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

ordered_json short_number(double value) { return finite_or_null(rounded(value)); }

ordered_json triple(const Vector3d& v) {
  return {short_number(v.x()), short_number(v.y()), short_number(v.z())};
}

bool shown(const Vector3d& r, bool has_cylinder) { return !has_cylinder || r.head<2>().norm() < reach; }

/// Arcs as lists {kind, s, x, y, z, p}.
ordered_json arcs_json(const RodCurve& curve, const Solution& solution) {
  ordered_json arcs = ordered_json::array();
  for (std::size_t k = 0; k < solution.arcs.size(); ++k) {
    const bool line = solution.arcs[k].kind == equilibrium::ArcKind::line;
    ordered_json arc = {{"line", line}};
    for (const char* name : {"s", "x", "y", "z"}) arc[name] = ordered_json::array();
    if (line) arc["p"] = ordered_json::array();
    for (std::size_t i = 0; i < curve.s.size(); ++i) {
      if (curve.arc[i] != k || !shown(curve.r[i], solution.has_cylinder)) continue;
      arc["s"].push_back(short_number(curve.s[i]));
      arc["x"].push_back(short_number(curve.r[i].x()));
      arc["y"].push_back(short_number(curve.r[i].y()));
      arc["z"].push_back(short_number(curve.r[i].z()));
      if (line) arc["p"].push_back(short_number(curve.p[i]));
    }
    arcs.push_back(std::move(arc));
  }
  return arcs;
}

/// Position of the rod at s, linear between the dense places.
Vector3d position_at(const RodCurve& curve, double s) {
  const auto after = std::lower_bound(curve.s.begin(), curve.s.end(), s);
  if (after == curve.s.begin()) return curve.r.front();
  if (after == curve.s.end()) return curve.r.back();
  const auto i = static_cast<std::size_t>(after - curve.s.begin());
  const double width = curve.s[i] - curve.s[i - 1], part = width > 0.0 ? (s - curve.s[i - 1]) / width : 1.0;
  return (1.0 - part) * curve.r[i - 1] + part * curve.r[i];
}

/// The mode as places of the rod and displacements there.
ordered_json mode_json(const RodCurve& curve, const Mode& mode, bool has_cylinder) {
  ordered_json json = {{"eigenvalue", short_number(mode.eigenvalue)},
                       {"plane", mode.plane},
                       {"parity", mode.parity},
                       {"r", ordered_json::array()},
                       {"d", ordered_json::array()}};
  for (Eigen::Index i = 0; i < mode.s.size(); ++i) {
    const Vector3d r = position_at(curve, mode.s[i]);
    if (!shown(r, has_cylinder)) continue;
    json["r"].push_back(triple(r));
    json["d"].push_back(triple(mode.displacement.col(i)));
  }
  return json;
}

ordered_json rod_json(const Solution& solution) {
  const double length =
      solution.arcs.empty() ? 1.0 : solution.arcs.back().s.tail<1>()[0] - solution.arcs.front().s[0];
  const RodCurve curve = dense_curve(solution, solution.has_cylinder ? 0.06 : std::max(length, 1e-3) / 200.0);
  ordered_json json = {
      {"topology", solution.topology}, {"model", solution.model}, {"arcs", arcs_json(curve, solution)}};
  json["forces"] = ordered_json::array();
  for (const PointForce& force : point_forces(solution)) {
    ordered_json entry = {{"s", short_number(force.s)},
                          {"r", triple(force.r)},
                          {"d", triple(force.direction)},
                          {"f", short_number(force.size)}};
    if (force.partner) entry["partner"] = short_number(*force.partner);
    json["forces"].push_back(std::move(entry));
  }
  json["eigenvalues"] = ordered_json::array();
  if (solution.stability) {
    for (const double value : solution.stability->eigenvalues)
      json["eigenvalues"].push_back(short_number(value));
    if (!solution.stability->modes.empty()) {
      json["mode"] = mode_json(curve, solution.stability->modes.front(), solution.has_cylinder);
    }
  }
  return json;
}

/// Flat obstacles: corners of a rectangle each, beside the whole length of the rod.
ordered_json sheets_json(const Solution& solution, const obstacle::Set& obstacles, double rod_radius) {
  const double half = 0.5 * (solution.arcs.back().s.tail<1>()[0] - solution.arcs.front().s[0]);
  const Eigen::AlignedBox3d box(Vector3d(-half, 0.0, 0.0), Vector3d(half, 0.0, 0.0));
  ordered_json sheets = ordered_json::array();
  for (int o = 0; o < obstacles.size(); ++o) {
    ordered_json corners = ordered_json::array();
    for (const Vector3d& corner : sheet_of(obstacles[o], box, rod_radius)) corners.push_back(triple(corner));
    if (!corners.empty()) sheets.push_back(std::move(corners));
  }
  return sheets;
}

struct ReportQuantity {
  const char* name;
  const char* title;
  std::function<double(const BranchRow&)> value;
};

std::vector<ReportQuantity> quantities(const Run& run, const ReportOptions& options) {
  std::vector<ReportQuantity> list;
  const bool capstan = run.info.has_cylinder;
  if (capstan) {
    list = {{"T", "tension T [EI/ρ²]", [](const BranchRow& r) { return r.T; }},
            {"phi", "capstan angle φ [rad]", [](const BranchRow& r) { return r.phi; }},
            {"R_tot", "contact force R_tot [EI/ρ²]", [](const BranchRow& r) { return r.R_tot; }},
            {"phi_star", "half contact angle φ* [rad]", [](const BranchRow& r) { return r.phi_star; }}};
  } else {
    list = {{"shortening", "end shortening / length", [](const BranchRow& r) { return r.shortening; }},
            {"end_force", "end thrust [EI/ρ²]", [](const BranchRow& r) { return r.end_force; }},
            {"end_moment", "axial end moment [EI/ρ]", [](const BranchRow& r) { return r.end_moment; }}};
  }
  if (capstan && !options.plates.empty()) {
    list.push_back({"F0", "drag of the cylinder F0 [EI/ρ²]",
                    [](const BranchRow& r) { return r.F0.value_or(std::nan("")); }});
    list.push_back(
        {"plate_force", "forces of the plates [EI/ρ²]", [](const BranchRow& r) { return r.plate_force; }});
  }
  // A flat rod in three dimensions is flat to rounding.
  const auto or_flat = [](double value) { return std::abs(value) < 1e-7 ? 0.0 : value; };
  list.push_back(
      {"tilt", "tilt at the mid-point [rad]", [or_flat](const BranchRow& r) { return or_flat(r.tilt); }});
  list.push_back({"z_span", "extent in z [ρ]", [or_flat](const BranchRow& r) { return or_flat(r.z_span); }});
  list.push_back({"energy", "energy [EI/ρ]", [](const BranchRow& r) { return r.energy; }});
  if (options.rod_radius > 0.0) {
    list.push_back({"self_distance", "closest approach to itself [ρ]",
                    [](const BranchRow& r) { return r.self_distance.value_or(std::nan("")); }});
    list.push_back(
        {"self_force", "force between strands [EI/ρ²]", [](const BranchRow& r) { return r.self_force; }});
  }
  list.push_back({"eigenvalue_1", "lowest eigenvalue",
                  [](const BranchRow& r) { return r.eigenvalue_1.value_or(std::nan("")); }});
  list.push_back({"index", "number of negative eigenvalues",
                  [](const BranchRow& r) { return r.index ? *r.index : std::nan(""); }});
  list.push_back({"error_estimate", "error estimate", [](const BranchRow& r) { return r.error_estimate; }});
  list.push_back({"ds", "continuation step", [](const BranchRow& r) { return r.ds; }});
  if (capstan && options.units) {
    const double newton = options.units->force;
    list.push_back({"T_N", "tension [N]", [newton](const BranchRow& r) { return r.T * newton; }});
    list.push_back(
        {"mass_g", "hung mass [g]", [newton](const BranchRow& r) { return r.T * newton / 9.80665 * 1e3; }});
    list.push_back(
        {"R_tot_N", "contact force [N]", [newton](const BranchRow& r) { return r.R_tot * newton; }});
  }
  if (!run.info.extra_parameter.empty()) {
    list.push_back({"parameter", run.info.extra_parameter.c_str(),
                    [](const BranchRow& r) { return r.parameter.value_or(std::nan("")); }});
  }
  return list;
}

/// One entry a branch: point names, labels, stability, and a list of values a quantity, in order.
ordered_json branches_json(const Run& run, const std::vector<ReportQuantity>& list) {
  std::map<int, std::vector<BranchRow>> branches;
  for (const BranchRow& row : run.rows) branches[row.branch].push_back(row);
  ordered_json json = ordered_json::array();
  for (const auto& [branch, rows] : branches) {
    ordered_json entry = {{"branch", branch}};
    entry["between"] = ordered_json::array();  // unstable directions from each point to the next
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const std::optional<int> index = index_between(rows[i - 1], rows[i]);
      entry["between"].push_back(index ? ordered_json(*index) : ordered_json(nullptr));
    }
    for (const BranchRow& row : rows) {
      entry["names"].push_back(point_name(row.branch, row.point, row.label));
      entry["index"].push_back(row.index ? ordered_json(*row.index) : ordered_json(nullptr));
      entry["topology"].push_back(row.topology);
      for (const ReportQuantity& quantity : list) {
        entry["values"][quantity.name].push_back(finite_or_null(quantity.value(row)));
      }
    }
    if (run.info.has_cylinder) {
      for (const double slope : log_slopes(rows)) entry["values"]["alpha"].push_back(short_number(slope));
    }
    json.push_back(std::move(entry));
  }
  return json;
}

/// Of each plate: the height of its surface, a radius of the rod beyond where it stops the centre line, and its outer radius, null
/// where it is endless.
ordered_json plates_json(const ReportOptions& options) {
  ordered_json plates = ordered_json::array();
  for (const scene::Plate& plate : options.plates) {
    const double up = plate.side == scene::PlateSide::above ? 1.0 : -1.0;
    plates.push_back({{"z", short_number(plate.height + up * options.rod_radius)},
                      {"outer", finite_or_null(plate.outer_radius)}});
  }
  return plates;
}

}  // namespace

ordered_json report_data(const Run& run, const ReportOptions& options) {
  const std::vector<ReportQuantity> list = quantities(run, options);
  ordered_json data;
  data["info"] = to_json(run.info);
  data["scene"] = run.scene_toml;
  data["radius"] = options.rod_radius;
  for (const ReportQuantity& quantity : list)
    data["quantities"].push_back({{"name", quantity.name}, {"title", quantity.title}});
  if (run.info.has_cylinder) {
    data["quantities"].push_back({{"name", "alpha"}, {"title", "α = dlog R_tot / dlog T"}});
  }
  data["branches"] = branches_json(run, list);
  data["special"] = ordered_json::array();
  for (const SpecialPoint& point : run.special_points) data["special"].push_back(to_json(point));
  const std::size_t stride = 1 + run.points.size() / std::max<std::size_t>(1, options.most_rods);
  data["rods"] = ordered_json::object();
  data["sheets"] = ordered_json::array();
  data["plates"] = plates_json(options);
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    const PointStore::Key& key = run.points.keys()[i];
    if (i % stride != 0 && key.label.empty()) continue;
    Solution solution = run.points.get(i);
    if (solution.arcs.empty()) continue;
    if (options.complete) options.complete(i, solution);
    data["rods"][point_name(key.branch, key.point, key.label)] = rod_json(solution);
    if (data["sheets"].empty() && !solution.has_cylinder)
      data["sheets"] = sheets_json(solution, options.obstacles, options.rod_radius);
  }
  return data;
}

}  // namespace windlass::output
