#include <algorithm>
#include <cmath>

#include "windlass/equilibrium/curve_piece.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/pull/outcome.hpp"

namespace windlass::pull {

using Eigen::Vector3d;
using equilibrium::CurvePlace;
using equilibrium::Pressing;

namespace {

constexpr int cylinder = 0, plate = 1;  // their places among the scene's obstacles

/// The whole rod as a curve with the forces in it.
chain::Profile shape_of(const Pull& pull, const std::vector<PlaceLoad>& loads) {
  const DraggedRod& rod = pull.rod();
  const discrete_rod::OpenSpline& spline = rod.spline();
  const Eigen::VectorXd& u = pull.state().unknowns;
  constexpr int samples = 4;  // an element
  std::vector<CurvePlace> places;
  for (int k = 0; k <= samples * spline.elements(); ++k) {
    const int e = std::min(k / samples, spline.elements() - 1);
    const double t = static_cast<double>(k - samples * e) / samples, h = spline.length(e);
    const auto controls = discrete_rod::OpenSpline::controls(u, e);
    places.push_back({spline.knot(e) + t * h, controls * discrete_rod::cubic_weights(t, 0),
                      controls * discrete_rod::cubic_weights(t, 1) / h,
                      controls * discrete_rod::cubic_weights(t, 2) / (h * h)});
  }
  const rod::Quaternion first = rod::turn_between(Vector3d::UnitZ(), places.front().slope.normalized());
  std::vector<discrete_rod::PointLoad> points;
  for (const PlaceLoad& load : loads)
    if (load.cylinder > 0.0 || load.plate > 0.0) points.push_back({load.s, load.force});
  const double difference = rod.setting.blocked ? u(u.size() - 1) : 0.0;
  chain::Piece piece = equilibrium::without_torsion(
      places, first, (rod.setting.tension + difference) * rod.right_pull(), points);
  // Unrolled from the left end; the middle lies about the south pole.
  piece.angle.array() -= 2.0 * M_PI * std::round(piece.angle(piece.angle.size() / 2) / (2.0 * M_PI));
  chain::Profile out;
  out.pieces.push_back(std::move(piece));
  return out;
}

/// A stretch along which a bed is pressed on.
struct Lobe {
  double begin = 0.0, end = 0.0;  ///< [ρ]
  double force = 0.0, moment = 0.0;
  double length() const { return end - begin; }
};

/// Of one obstacle. Beside a strong force a bed is pressed on again a little further, weakly; such lobes are left out, and what is
/// missing shows on exact arcs.
std::vector<Lobe> lobes_on(const std::vector<PlaceLoad>& loads, int obstacle) {
  constexpr double weak = 0.05;  // of all the force: e^−π is that of a bed's next lobe
  std::vector<Lobe> lobes;
  double all = 0.0;
  bool pressed = false;
  for (std::size_t k = 1; k < loads.size(); ++k) {
    const double p = obstacle == cylinder ? loads[k].cylinder : loads[k].plate, s = loads[k].s,
                 force = p * (s - loads[k - 1].s);
    if (p > 0.0 && !pressed) lobes.push_back({s, s});
    pressed = p > 0.0;
    if (!pressed) continue;
    lobes.back().end = s;
    lobes.back().force += force, lobes.back().moment += force * s;
    all += force;
  }
  std::erase_if(lobes, [&](const Lobe& lobe) { return lobe.force < weak * all; });
  return lobes;
}

/// A bed smears a point force, and what is at a line's ends, over `range`: lobes shorter than this are touches, longer ones lines,
/// those between may be either.
constexpr double shortest_line = 1.2, longest_touch = 4.0;  // in ranges

/// All contacts by increasing s; nullopt where some of the rod lies on cylinder and plate at once.
/// @param lines  a bit for each lobe of the cylinder that may be either: is it a line?
std::optional<std::vector<Pressing>> contacts_of(const std::vector<Lobe>& on_cylinder,
                                                 const std::vector<Lobe>& on_plate, double range,
                                                 unsigned lines) {
  std::vector<Pressing> out;
  for (const Lobe& lobe : on_cylinder) {
    bool line = lobe.length() > longest_touch * range;
    if (!line && lobe.length() > shortest_line * range) line = lines & 1u, lines >>= 1;
    const double centre = lobe.moment / lobe.force;
    out.push_back(line ? Pressing{lobe.begin + 0.5 * range, lobe.end - 0.5 * range, cylinder}
                       : Pressing{centre, centre, cylinder});
  }
  for (const Lobe& lobe : on_plate) {
    const double centre = lobe.moment / lobe.force;
    for (const Pressing& lying : out)
      if (lying.line() && lying.begin < lobe.end && lobe.begin < lying.end) return std::nullopt;
    out.push_back({centre, centre, plate});
  }
  std::ranges::sort(out, {}, &Pressing::begin);
  return out;
}

bool agree(const Plateau& at, const equilibrium::StateSummary& state, double force) {
  return std::abs(at.drag * force / state.F0.value_or(0.0) - 1.0) < same_state &&
         std::abs(at.R_tot * force / state.R_tot - 1.0) < same_state;
}

}  // namespace

std::optional<equilibrium::StateSummary> polished(const Pull& pull, const Plateau& at,
                                                  const scene::Scene& scene, std::string& failure) {
  if (scene.strand_radius() > 0.0) {
    failure = "where strands touch is not read off a pull";
    return std::nullopt;
  }
  if (scene.second_plate) {
    failure = "which of two plates is touched is not read off a pull";
    return std::nullopt;
  }
  // With the slip remembered all of the contact is at the limit of friction, in the direction that it slips.
  const std::vector<PlaceLoad> loads =
      pull.rod().loads(pull.state().unknowns, pull.memory(), {0.0, 0.0, true});
  const double range = 1.5 * pull.h();
  const chain::Profile shape = shape_of(pull, loads);
  const std::vector<Lobe> on_cylinder = lobes_on(loads, cylinder), on_plate = lobes_on(loads, plate);
  const auto open = std::ranges::count_if(on_cylinder, [&](const Lobe& lobe) {
    return lobe.length() > shortest_line * range && lobe.length() <= longest_touch * range;
  });
  constexpr long most = 5;
  for (unsigned lines = 0; lines < 1u << std::min<long>(open, most); ++lines) {
    const auto contacts = contacts_of(on_cylinder, on_plate, range, lines);
    if (!contacts) {
      failure = "part of it lies on cylinder and plate at once";
      continue;
    }
    const auto found = equilibrium::dragged_on(scene, shape, *contacts, {"load.tension"}, failure);
    if (!found) continue;
    const equilibrium::StateSummary state = equilibrium::summarised(*found, scene);
    if (agree(at, state, scene.solved_in.force)) return state;
    failure = "the state on the contacts " + state.topology + " is another";
  }
  return std::nullopt;
}

}  // namespace windlass::pull
