// Motions that next to nothing resists: a rod is moved along itself to where no force holds it, and states
// that something would have to hold are refused.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "windlass/equilibrium/rod_problem.hpp"

namespace windlass::equilibrium {

using contact::Loads;

namespace {

constexpr const char* leaves_clamp =
    "a clamped end whose rod lies on an obstacle leaves its clamp: such states are not followed";

/// Are clamped ends posed with hinges? They turn with the square of a motion out of the plane that these
/// allow.
bool has_hinges(const chain::Chain& chain) {
  for (int j = 0; j < chain.joint_count(); ++j)
    if (!chain.joint(j).fixed_in_variations().empty()) return true;
  return false;
}

/// Does a motion turn or shift a line contact on its obstacle, out of the plane in which it lies?
bool turns_lines(const chain::Chain& chain, const Vector& x, const Vector& dx, double visible) {
  const Vector moved = chain.retract(x, dx);
  for (int j = 0; j < chain.joint_count(); ++j) {
    if (chain.joint(j).kind() != contact::JointKind::edge) continue;
    for (const int k : chain.joint(j).out_of_plane())
      if (std::abs(chain.coordinates(moved, j)[k] - chain.coordinates(x, j)[k]) > visible) return true;
  }
  return false;
}

}  // namespace

bool RodProblem::slides_freely(const Vector& x, const Vector& p) {
  // What resists sliding, over the pull; rounding moves a rod that hardly resists along itself.
  constexpr double resolved = 1e-7, lost = 8e-8;
  const bool half = topology_.half;  // its odd variations slide
  if (rod_.strut || dragged() || rod_.infinite || !(half || chain_->holds_slide())) return false;
  const Loads at = loads(p);
  const int last = chain_->link_count() - 1;
  // Plates, which push across the rod, let it slide: tails go on past their touches.
  const auto plate = [&](int joint) {
    return topology_.seat(joint).strand == 0 && topology_.pushed_by(joint) > 0;
  };
  const auto tail_from = [&](int link, int way) {
    double length = chain_->length(x, at, link);
    for (int i = link + way; i >= 0 && i <= last && plate(way > 0 ? i : i + 1); i += way)
      length += chain_->length(x, at, i);
    return length;
  };
  const double tail = std::min(tail_from(half ? last : 0, half ? -1 : 1), tail_from(last, -1));
  const double resistance = std::exp(-2.0 * std::sqrt(at.tension / rod_.bending_stiffness) * tail);
  return resistance > (slides_ ? lost : resolved);
}

bool RodProblem::choose_sliding(const Vector& x, const Vector& p) {
  const bool freely = slides_freely(x, p);
  if (freely == slides_) return false;
  let_slide(freely);
  if (topology_.half) return false;  // the same equations
  finer_.reset();
  factored_x_.resize(0);
  return true;
}

void RodProblem::let_slide(bool freely) {
  slides_ = freely;
  chain_->let_slide(freely);
  sliding_reference_.reset();
}

bool RodProblem::settle(Vector& x, const Vector& p) {
  constexpr double nothing = 1e-10;  // of the pulls: below what a certificate asks
  constexpr int most = 12;
  const double tension = loads(p).tension;
  // [rad] In the plane rounding leaves 1e-15. Out of it the turn grows with the square of the way, and an arm
  // that starts only 5e-5 from its branch must be seen to turn.
  constexpr double out = 1e-13;
  for (int j = 0; j < chain_->joint_count(); ++j)
    if (std::abs(chain_->joint(j).out_of_clamp(chain_->coordinates(x, j))) > out)
      throw std::domain_error(leaves_clamp);
  if (std::abs(chain_->holding_force(x)) < nothing * tension) return false;
  if (chain_->slides()) {
    if (polish(x, p) < 0) throw std::domain_error("the rod slides along itself: nothing balances it here");
    return true;
  }
  const Eigen::MatrixXd none(chain_->size(), 0), corner(0, 0);
  for (int k = 0; k < most; ++k) {
    factor(x, p, none, none, corner);
    const Vector by_place = chain_->solve(Vector::Unit(chain_->size(), chain_->slide_row()), Vector(0));
    const double slope = by_place(chain_->slide_row());
    if (slope == 0.0) break;
    const double reach = 0.5 / std::sqrt(tension / rod_.bending_stiffness);  // a tail's decay length, halved
    chain_->slide_place(x) += std::clamp(-chain_->holding_force(x) / slope, -reach, reach);
    if (polish(x, p) < 0) break;
    if (std::abs(chain_->holding_force(x)) < nothing * tension) return true;
  }
  throw std::domain_error("the rod slides along itself: nothing balances it here");
}

std::string RodProblem::unsettled(const Vector& x, const Vector& dx) const {
  constexpr double nothing = 1e-8;  // what rounding leaves of a force in a mode of unit size
  const double visible = nothing * dx.cwiseAbs().maxCoeff();
  if (!dragged() && chain_->holds_slide() && std::abs(dx(chain_->slide_row())) >= visible)
    return "the rod would have to be held against sliding along itself";
  if (has_hinges(*chain_) && turns_lines(*chain_, x, dx, visible)) return leaves_clamp;
  return {};
}

double RodProblem::sliding_stiffness(const Vector& x, const Vector& p) {
  return factored(x, p).sliding_stiffness(x, loads(p));
}

}  // namespace windlass::equilibrium
