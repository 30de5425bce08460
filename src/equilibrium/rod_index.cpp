// Negative directions of a rod's second variation, as a branch follows them.
#include <algorithm>

#include "windlass/chain/singular_matrix.hpp"
#include "windlass/chain/variation.hpp"
#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/equilibrium/start.hpp"

namespace windlass::equilibrium {

using contact::Loads;

int RodProblem::index(const Vector& x, const Vector& p) {
  const Loads at = loads(p);
  if (dragged()) return -1;  // no second variation: the load has no potential
  // Where a contact carries nothing, or an arc has no length left, the second variation is not that of a rod held by
  // these contacts: the count of the last sound point stands until the event is located.
  if (index_ < 0 || !degenerate(x, at)) {
    index_ = count(x, p, contact::Parity::even, index_);
    if (!topology_.half) count_sliding(x, at);
  }
  return topology_.half ? index_ : index_ + sliding_off_;
}

// By Haynsworth's inertia formula, the directions of a rod that may slide; counted from where it was let to, which is no
// point of the branch.
void RodProblem::count_sliding(const Vector& x, const Loads& at) {
  if (!slides_) return;
  const int off = chain_->sliding_stiffness(x, at) < 0.0;
  if (!sliding_reference_) sliding_reference_ = off - sliding_off_;
  sliding_off_ = off - *sliding_reference_;
}

namespace {

/// Sign of det J of the equilibrium equations at a state; 0: J is singular.
int sign_of_determinant(RodProblem& problem, const Vector& x, const Vector& p) {
  const Eigen::MatrixXd none(problem.size(), 0);
  try {
    problem.factor(x, p, none, none, Eigen::MatrixXd(0, 0));
    return problem.determinant_sign();
  } catch (const chain::SingularMatrix&) {
    return 0;
  }
}

}  // namespace

// On even and odd motions together det J of the full chain is a product, up to a factor of the mesh: the second one's sign, which
// says where odd motions of a load without potential lose their stability one by one.
int RodProblem::breaking_sign(const Vector& x, const Vector& p) {
  const Started whole = image_on_full_chain(*this, x, p);
  RodProblem half(scene_at(p), spatial_, topology_, meshes_,
                  keys_);  // this one's factors are still asked for
  return sign_of_determinant(*whole.problem, whole.x, p) * sign_of_determinant(half, x, p);
}

int RodProblem::breaking_index(const Vector& x, const Vector& p) {
  if (!topology_.half) return -1;
  const Loads at = loads(p);
  if (dragged()) {
    const int sign = breaking_index_ < 0 || !degenerate(x, at) ? breaking_sign(x, p) : 0;
    if (sign != 0) breaking_index_ = sign < 0 ? 1 : 0;
    return breaking_index_;
  }
  if (breaking_index_ < 0 || !degenerate(x, at)) {
    breaking_index_ = count(x, p, contact::Parity::odd, breaking_index_);
    count_sliding(x, at);
  }
  return breaking_index_ + sliding_off_;
}

continuation::Matrix RodProblem::neutral_motions(const Vector& x, const Vector& p) {
  const Loads at = loads(p);  // may rebuild the chain
  const Vector turn = chain_->nearly_neutral_turn(x, at);
  return turn.size() > 0 ? continuation::Matrix(turn) : continuation::Matrix(size(), 0);
}

bool RodProblem::degenerate(const Vector& x, const Loads& at) const {
  constexpr double nothing = 1e-7;
  if (topology_.mid_touch && chain_->touch_force(x, at, 0) < nothing) return true;
  for (int j = 1; j < chain_->joint_count(); ++j) {
    if (!chain_->shares_place(j) && chain_->arclength(x, at, j) - chain_->arclength(x, at, j - 1) < nothing)
      return true;
    const bool touch = chain_->joint(j).kind() == contact::JointKind::touch;
    if (touch && chain_->touch_force(x, at, j) < nothing) return true;
  }
  return false;
}

int RodProblem::count(const Vector& x, const Vector& p, contact::Parity parity, int last) {
  if (counts_.x.size() == 0 || counts_.x != x || counts_.p != p) counts_ = {x, p};
  const int at = parity == contact::Parity::even ? 0 : 1;
  int &negative = counts_.negative[at], &rounded = counts_.rounded[at];
  if (negative < 0) {
    const Loads loads = this->loads(p);
    const chain::Chain::Inertia inertia = chain_->inertia(x, loads, parity);
    negative = inertia.negative;
    // The factors' signs are one choice of those that rounding leaves open: where they say what held at the last point, that
    // stands, and the spectrum of the block is not asked. Pivots of a large block, taken from a part of it at a time, may be small
    // without that: its spectrum, which is dear, is asked where the count changes.
    const bool asked = last >= 0 || chain_->dense_size() <= chain::Block::large;
    if (inertia.near_rounding && asked && negative != last) {
      const chain::Linearisation linearised(*chain_, rod_, x, loads);
      const chain::Variation::Doubt doubt = chain::Variation(linearised, parity).doubt();
      negative = doubt.negative, rounded = doubt.rounded;
    }
  }
  return std::clamp(last, negative, negative + rounded);
}

int RodProblem::total_index(const Vector& x, const Vector& p) {
  if (dragged()) return -1;
  // At an event where a contact carries nothing the last sound point's count stands here, too.
  const bool known = index_ >= 0 && (!topology_.half || breaking_index_ >= 0);
  if (known && degenerate(x, loads(p))) return index_ + (topology_.half ? breaking_index_ : 0);
  const bool counted = counts_.x.size() > 0 && counts_.x == x && counts_.p == p && counts_.negative[0] >= 0 &&
                       counts_.negative[1] >= 0;
  if (!counted) factored(x, p);
  return count(x, p, contact::Parity::even) + count(x, p, contact::Parity::odd);
}

}  // namespace windlass::equilibrium
