#include "windlass/equilibrium/opening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "windlass/chain/singular_matrix.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/rod/quaternion.hpp"

namespace windlass::equilibrium {

namespace {

using Eigen::MatrixXd;

/// Borders of one Newton system: `count` columns and rows added to the chain's own.
struct Borders {
  Borders(Eigen::Index size, Eigen::Index count)
      : b(MatrixXd::Zero(size, count)), c(MatrixXd::Zero(size, count)) {}
  MatrixXd b, c;
};

/// One slack an edge stands in for its location condition, and its arclength does not move: as many unknowns as rows.
Borders hold_edges(const chain::Chain& chain, const std::vector<int>& opened) {
  std::vector<int> edges;
  for (const int link : opened)
    for (const int joint : {link, link + 1})
      if (chain.joint(joint).kind() == contact::JointKind::edge) edges.push_back(joint);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  Borders held(chain.size(), static_cast<Eigen::Index>(edges.size()));
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Eigen::Index row = chain.arclength_row(edges[k]);
    held.b(row, static_cast<Eigen::Index>(k)) = held.c(row, static_cast<Eigen::Index>(k)) = 1.0;
  }
  return held;
}

/// p(0) is one more unknown, the length of the link one more equation.
Borders fix_length(RodProblem& problem, const Vector& x, const Vector& p, int link) {
  const chain::Chain& chain = problem.chain();
  Borders held(chain.size(), 1);
  held.b.col(0) = problem.parameter_derivative(x, p, 0);
  const Eigen::Index begin = chain.arclength_row(link), end = chain.arclength_row(link + 1);
  if (begin >= 0) held.c(begin, 0) = -1.0;
  if (end >= 0) held.c(end, 0) = 1.0;
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

/// One Newton step, cut where an arc would lose more than half its length. @returns the largest uncut increment; infinity,
/// and nothing is changed, where the increment is not finite
double newton_step(RodProblem& problem, Vector& x, Vector& p, const Borders& borders, const Vector& goal,
                   bool moves_p) {
  const Eigen::Index size = problem.size(), count = borders.b.cols();
  problem.factor(x, p, borders.b, borders.c, MatrixXd::Zero(count, count));
  const Vector solution = problem.solve(-problem.residual(x, p), goal);
  const Vector dx = solution.head(size);
  if (!solution.allFinite()) return HUGE_VAL;
  const double part = longest_part(problem.chain(), x, problem.loads(p), dx);
  x = problem.retract(x, part * dx);
  if (moves_p) p(0) += part * solution(size);
  return dx.cwiseAbs().maxCoeff();
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

}  // namespace

bool enter_bowed(RodProblem& problem, Vector& x, Vector& p, int link) {
  constexpr double size = 1e-2;     // of the largest slope of the rod
  constexpr double settled = 1e-8;  // converges by squares: what is left is rounding
  double slope = 0.0;
  for (const chain::Piece& piece : problem.profile(x, p).pieces)
    for (Eigen::Index k = 0; k < piece.s.size(); ++k)
      slope = std::max(slope, rod::directors(piece.q.col(k)).col(2).tail<2>().norm());
  const BucklingMode mode = buckling_mode(problem, x, p, link);
  x = problem.retract(x, size * slope * mode.whole);
  try {
    for (int k = 0; k < 20; ++k) {
      Borders borders(problem.size(), 1);
      borders.b.col(0) = problem.parameter_derivative(x, p, 0);
      borders.c.col(0) = mode.link / mode.link.squaredNorm();
      const double step = newton_step(problem, x, p, borders, Vector::Zero(1), true);
      if (step < settled * std::max(1.0, x.cwiseAbs().maxCoeff())) return true;
    }
  } catch (const std::domain_error&) {  // a length left its domain
  } catch (const chain::SingularMatrix&) {
  }
  return false;
}

void settle_shape(RodProblem& problem, Vector& x, Vector& p, const std::vector<int>& opened) {
  const Borders borders = hold_edges(problem.chain(), opened);
  const Vector goal = Vector::Zero(borders.b.cols());
  for (int k = 0; k < 4; ++k)
    if (const double step = newton_step(problem, x, p, borders, goal, false); step < 1e-8 || std::isinf(step))
      return;
}

std::optional<LineBegins> where_line_begins(RodProblem& problem, Vector x, Vector p, int link) {
  // p(0) is smooth in the length: Richardson's extrapolation from lengths that double.
  constexpr int levels = 4;
  const double shortest = 4.0 * least_length * problem.rod().unit_length;
  std::array<double, levels> values;
  double before = 0.0;
  for (int k = levels; k-- > 0;) {
    if (!solve_at_length(problem, x, p, link, shortest * (1 << k))) return std::nullopt;
    values[k] = p(0);
  }
  for (int order = 1; order < levels; ++order) {
    before = values[0];
    for (int k = 0; k + order < levels; ++k) values[k] += (values[k] - values[k + 1]) / ((1 << order) - 1);
  }
  return LineBegins{values[0], std::abs(values[0] - before)};
}

bool solve_at_length(RodProblem& problem, Vector& x, Vector& p, int link, double length) {
  double last = 1e300;
  int stalls = 0;
  for (int k = 0; k < 20; ++k) {
    const contact::Loads at = problem.loads(p);
    const double now = problem.chain().length(x, at, link);
    const Vector goal = Vector::Constant(1, length - now);
    const double step = newton_step(problem, x, p, fix_length(problem, x, p, link), goal, true);
    if (std::isinf(step)) return false;
    // Converged, or as far as rounding lets a short arc: the increment is tiny and no longer falls.
    if (step < 1e-5 && step > 0.3 * last) ++stalls;
    if (step < 1e-12 || stalls >= (step < 1e-7 ? 1 : 3)) return true;
    last = step;
  }
  return false;
}

}  // namespace windlass::equilibrium
