#include "neutral_turn.hpp"
#include "windlass/chain/chain.hpp"

/// LAPACK: Bunch-Kaufman factorisation of a symmetric matrix. Reaches the program through PETSc.
extern "C" void dsytrf_(const char* uplo, const int* n, double* a, const int* lda, int* pivot, double* work,
                        const int* work_size, int* info);

namespace windlass::chain {

using contact::Parity;

namespace {

/// Number of eigenvalues of a symmetric matrix below zero, by Bunch-Kaufman factorisation (LAPACK dsytrf).
int negative_eigenvalues(MatrixXd a) {
  int n = static_cast<int>(a.rows()), info = 0, work_size = 64 * std::max(n, 1);
  if (n == 0) return 0;
  std::vector<int> pivot(n);
  VectorXd work(work_size);
  dsytrf_("L", &n, a.data(), &n, pivot.data(), work.data(), &work_size, &info);
  int negative = 0;
  for (int k = 0; k < n; ++k) {
    if (pivot[k] > 0) {
      negative += a(k, k) < 0.0;
    } else {  // a 2×2 pivot has one eigenvalue of each sign
      ++negative;
      ++k;
    }
  }
  return negative;
}

}  // namespace

void Chain::add_pins(const Numbering& numbering, const VectorXd& x, MatrixXd& dense) const {
  for (int j = 0; j < joint_count(); ++j) {
    const Eigen::Index row = numbering.pin[j], first = numbering.coordinate[j], s = numbering.location[j];
    if (row < 0) continue;
    dense(row, first) = dense(first, row) = 1.0;
    dense(row, s) = dense(s, row) = -joints_[j]->slide(coordinates(x, j));
  }
}

MatrixXd Chain::variation_matrix(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                                 const Loads& loads) const {
  MatrixXd dense = MatrixXd::Zero(numbering.size, numbering.size);
  for (int i = 0; i < link_count(); ++i)
    add_joint_terms(purpose, numbering, x, loads, i, gradients_[i], dense);
  add_pins(numbering, x, dense);
  return dense;
}

MatrixXd Chain::condensed_variation(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                                    const Loads& loads) const {
  MatrixXd dense = variation_matrix(purpose, numbering, x, loads);
  for (int i = 0; i < link_count(); ++i) {
    const Local l = local(purpose, numbering, x, loads, i);
    bvp::EndsMatrix hessian = with_commutator(*links_[i].arc, condensed_[i], gradients_[i]);
    if (purpose == Purpose::odd && i == 0 && links_[0].arc->ambient() == 4)  // see Joint::attach_odd
      hessian.block(0, 0, 3, 3) = condensed_[0].block(0, 0, 3, 3);
    const MatrixXd share = l.columns.transpose() * hessian * l.columns;
    for (std::size_t r = 0; r < l.dofs.size(); ++r)
      for (std::size_t s = 0; s < l.dofs.size(); ++s) dense(l.dofs[r], l.dofs[s]) += share(r, s);
  }
  return 0.5 * (dense + dense.transpose());
}

int Chain::negative_directions(const MatrixXd& dense, const Numbering& numbering) const {
  int negative = neutral_turn_ ? negative_but_turn(dense, numbering.location) : negative_eigenvalues(dense);
  for (const Link& link : links_) negative += link.arc->negative_pivots();
  return negative - numbering.constraints;
}

int Chain::index(const VectorXd& x, const Loads& loads, Parity parity) const {
  if (parity == Parity::odd && !half()) return 0;
  const Purpose purpose = parity == Parity::odd ? Purpose::odd : Purpose::even;
  const Numbering numbering = number(purpose);
  return negative_directions(condensed_variation(purpose, numbering, x, loads), numbering);
}

}  // namespace windlass::chain
