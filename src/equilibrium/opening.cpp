#include "windlass/equilibrium/opening.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

namespace {

using continuation::Borders;
using continuation::Iterate;
using Eigen::MatrixXd;

/// `count` unknowns and equations to be filled in.
Borders borders(Eigen::Index size, Eigen::Index count) {
  Borders out;
  out.psi = MatrixXd(size, 0);
  out.c = MatrixXd::Zero(size, count);
  out.d = MatrixXd::Zero(count, count);
  out.g = Vector::Zero(count);
  return out;
}

/// Does a joint lie on an obstacle alone, with a place that a condition of its own finds?
bool finds_place(const chain::Chain& chain, int joint) {
  const contact::JointKind kind = chain.joint(joint).kind();
  const bool coupled = std::any_of(
      chain.couplings().begin(), chain.couplings().end(),
      [&](const chain::Coupling& coupling) { return coupling.first == joint || coupling.second == joint; });
  return kind == contact::JointKind::edge || (kind == contact::JointKind::touch && !coupled);
}

/// One slack an edge or touch stands in for the condition of its place, and its arclength does not move: as many unknowns as
/// rows. Where sliding is held, the outermost contacts' mean place is given already: one of the two is left to that.
Borders hold(const chain::Chain& chain, std::vector<int> joints) {
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  double shares = 0.0;
  for (const int joint : joints) shares += chain.slide_share(joint);
  if (chain.holds_slide() && !chain.slides() && shares == 1.0) joints.pop_back();
  Borders held = borders(chain.size(), static_cast<Eigen::Index>(joints.size()));
  for (std::size_t k = 0; k < joints.size(); ++k)
    held.c(chain.arclength_row(joints[k]), static_cast<Eigen::Index>(k)) = 1.0;
  held.psi = held.c;
  return held;
}

/// Those at the ends of opened links that find their places.
std::vector<int> edges_of(const chain::Chain& chain, const std::vector<int>& opened) {
  std::vector<int> edges;
  for (const int link : opened)
    for (const int joint : {link, link + 1})
      if (finds_place(chain, joint) && chain.locates(joint)) edges.push_back(joint);
  return edges;
}

/// p(0) is one more unknown, `change` of the link's length one more equation.
Borders change_length(const chain::Chain& chain, int link, double change) {
  Borders held = borders(chain.size(), 1);
  held.parameter = 0;
  const Eigen::Index begin = chain.arclength_row(link), end = chain.arclength_row(link + 1);
  if (begin >= 0) held.c(begin, 0) = -1.0;
  if (end >= 0) held.c(end, 0) = 1.0;
  held.g(0) = change;
  return held;
}

/// Part of a step after which no arc between contacts has lost more than half its length.
double longest_part(const chain::Chain& chain, const Vector& x, const contact::Loads& at, const Vector& dx) {
  double part = std::min(1.0, 0.6 / std::max(dx.cwiseAbs().maxCoeff(), 1e-300));
  const auto shift = [&](int joint) {
    const Eigen::Index row = chain.arclength_row(joint);
    return row >= 0 ? dx(row) : 0.0;
  };
  for (int i = 0; i < chain.link_count(); ++i) {
    const double length = chain.length(x, at, i);
    const double change = shift(i + 1) - shift(i);
    if (length > 0.0 && change < 0.0) part = std::min(part, 0.5 * length / -change);
  }
  return part;
}

/// Newton's method with steps cut where an arc would lose more than half its length.
continuation::CorrectorReport solve_cut(RodProblem& problem, const Borders& held, Iterate& iterate,
                                        int most) {
  return problem.solve_from_guess(held, iterate, most, [&](const Iterate& at, const Vector& correction) {
    return longest_part(problem.chain(), at.x, problem.loads(at.p), correction.head(problem.size()));
  });
}

Iterate iterate_of(const RodProblem& problem, const Vector& x, const Vector& p, const Borders& held) {
  return {x, Vector::Zero(problem.size()), p, Vector::Zero(held.g.size())};
}

/// Turns the tangents of a link towards `normal` by sin(waves·2πσ), as an increment.
void bow(const RodProblem& problem, const Vector& x, const contact::Loads& at, int link,
         const Eigen::Vector3d& normal, double waves, Vector& mode) {
  const chain::Chain& chain = problem.chain();
  const bvp::Arc& arc = *chain.link(link).arc;
  Eigen::Index row = chain.dense_size();
  for (int i = 0; i < link; ++i) row += chain.link(i).arc->interior_tangent();
  const bvp::ArcSamples samples = arc.sample(chain.place(x, at, link).point());
  for (int k = 1; k <= arc.interior_nodes(); ++k) {
    const Eigen::Matrix3d d = rod::directors(samples.q.col(k));
    const double turn = std::sin(2.0 * M_PI * waves * samples.sigma(k));
    mode.segment<3>(row + 3 * (k - 1)) = 0.5 * turn * (d.transpose() * d.col(2).cross(normal));
  }
}

/// Buckling mode of a straight link held at its ends, and where a half chain's link begins at its mid-point that moves
/// along the normal. The part between a clamp and the link has the same buckling load and bows with it.
struct BucklingMode {
  Vector whole, link;  ///< link: its own part
};
BucklingMode buckling_mode(RodProblem& problem, const Vector& x, const Vector& p, int link) {
  const chain::Chain& chain = problem.chain();
  const contact::Loads at = problem.loads(p);
  const bool from_middle = problem.topology().half && link == 0;
  const Eigen::Vector3d normal = chain.joint(link + 1).chart(chain.coordinates(x, link + 1)).normal;
  BucklingMode mode{Vector::Zero(chain.size()), {}};
  bow(problem, x, at, link, normal, from_middle ? -0.5 : 1.0, mode.whole);
  mode.link = mode.whole;
  constexpr int along_y = 0;  // of a symmetric section's even coordinates
  if (from_middle) mode.whole(along_y) = 2.0 * normal(1) * chain.length(x, at, link) / M_PI;
  const int last = chain.link_count() - 1;
  if (link == last - 1 && problem.rod().right == chain::EndKind::clamped)
    bow(problem, x, at, last, normal, 1.0, mode.whole);
  if (link == 1 && !problem.topology().half && problem.rod().left == chain::EndKind::clamped)
    bow(problem, x, at, 0, normal, 1.0, mode.whole);
  return mode;
}

/// The gaps so short that their edges answer steeply to all that is wrong in a state.
std::vector<int> short_gaps(RodProblem& problem, const Vector& x, const Vector& p) {
  constexpr double most = 0.5;
  const contact::Loads at = problem.loads(p);
  std::vector<int> links;
  for (int i = 0; i < problem.chain().link_count(); ++i)
    if (problem.topology().stretches[i] == chain::Stretch::gap && finds_place(problem.chain(), i) &&
        finds_place(problem.chain(), i + 1) &&
        problem.chain().length(x, at, i) < most * problem.rod().unit_length)
      links.push_back(i);
  return links;
}

/// Newton's method for states with short gaps. An edge that slides by δ leaves its line by δ², which a gap of length ℓ takes for
/// a force δ²/ℓ³, next to which the force ℓ³ that says where the edge belongs is nothing: after each correction the shape
/// adjusts to the edges as they are then. @param held_now  the equations beside the problem's, at x and p
bool solve_by_turns(RodProblem& problem, Vector& x, Vector& p, const std::function<Borders()>& held_now) {
  const bool by_turns = !short_gaps(problem, x, p).empty();
  const int turns = by_turns ? 12 : 1, corrections = by_turns ? 2 : 20;  // the last correction is not taken
  for (int k = 0; k < turns; ++k) {
    const Borders held = held_now();
    Iterate iterate = iterate_of(problem, x, p, held);
    const continuation::CorrectorReport report = solve_cut(problem, held, iterate, corrections);
    x = iterate.x, p = iterate.p;
    if (report.converged) return true;
    if (!by_turns || report.iterations < corrections || !settle_shape(problem, x, p, {})) return false;
  }
  return false;
}

}  // namespace

bool enter_bowed(RodProblem& problem, Vector& x, Vector& p, int link) {
  constexpr double size = 1e-2;  // of the largest slope of the rod
  double slope = 0.0;
  for (const chain::Piece& piece : problem.profile(x, p).pieces)
    for (Eigen::Index k = 0; k < piece.s.size(); ++k)
      slope = std::max(slope, rod::directors(piece.q.col(k)).col(2).tail<2>().norm());
  const BucklingMode mode = buckling_mode(problem, x, p, link);
  x = problem.retract(x, size * slope * mode.whole);
  Borders bowed = borders(problem.size(), 1);
  bowed.parameter = 0;
  bowed.c.col(0) = mode.link / mode.link.squaredNorm();
  Iterate iterate = iterate_of(problem, x, p, bowed);
  constexpr int most = 20;
  const bool converged = solve_cut(problem, bowed, iterate, most).converged;
  x = iterate.x, p = iterate.p;
  return converged;
}

bool settle_shape(RodProblem& problem, Vector& x, const Vector& p, const std::vector<int>& opened) {
  std::vector<int> links = short_gaps(problem, x, p);
  links.insert(links.end(), opened.begin(), opened.end());
  return settle_about(problem, x, p, edges_of(problem.chain(), links));
}

bool settle_about(RodProblem& problem, Vector& x, const Vector& p, const std::vector<int>& joints) {
  const Borders held = hold(problem.chain(), joints);
  Iterate iterate = iterate_of(problem, x, p, held);
  constexpr int most = 5;  // the last one is not taken: a start for what follows, no solution
  const continuation::CorrectorReport report = solve_cut(problem, held, iterate, most);
  x = iterate.x;
  return report.converged || report.iterations == most;
}

std::optional<Vanishing> where_length_vanishes(RodProblem& problem, Vector x, Vector p, int link,
                                               double shortest) {
  constexpr int levels = 4;
  std::array<double, levels> values;  // p(0) and the state are smooth in the length
  std::array<Vector, levels> states;
  for (int k = levels; k-- > 0;) {
    if (!solve_at_length(problem, x, p, link, shortest * (1 << k))) return std::nullopt;
    values[k] = p(0);
    states[k] = x;
  }
  const Limit<double> limit = limit_at_zero(values);
  const Limit<Vector> state = limit_at_zero(states);
  const double uncertain = (state.value - state.before).lpNorm<Eigen::Infinity>();
  return Vanishing{limit.value, std::abs(limit.value - limit.before), state.value, values[0], states[0],
                   uncertain};
}

double entered_beside_strand(const RodProblem& problem) {
  return 2.0 * least_beside_strand * problem.rod().unit_length;
}

bool leave_event(RodProblem& problem, Vector& x, Vector& p) {
  const double entered = entered_beside_strand(problem);
  std::vector<int> links =
      vanished_beside_strands(contact_events(problem.profile(x, p), problem.topology()), problem.topology());
  // What is only to be redrawn has a length.
  std::erase_if(links,
                [&](int link) { return problem.chain().length(x, problem.loads(p), link) >= entered; });
  return links.empty() || tried([&] { return solve_at_length(problem, x, p, links.front(), entered); });
}

bool solve_in_place(RodProblem& problem, Vector& x, const Vector& p) {
  Vector fixed = p;
  return solve_by_turns(problem, x, fixed, [&] { return borders(problem.size(), 0); });
}

bool solve_at_length(RodProblem& problem, Vector& x, Vector& p, int link, double length) {
  const chain::Chain& chain = problem.chain();
  return solve_by_turns(problem, x, p, [&] {
    return change_length(chain, link, length - chain.length(x, problem.loads(p), link));
  });
}

}  // namespace windlass::equilibrium
