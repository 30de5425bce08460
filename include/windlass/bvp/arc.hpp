#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// The discrete arc as the chain sees it: a generating function of its ends.
///
/// An arc's action, made stationary over its interior, is a function of its end configurations, of the internal
/// force (or momenta) n conserved along it, and of its length:
///
///     S(q_a, q_b, n, ℓ) = stat ∫₀^ℓ [W(q, q') − n·d(q)] ds,
///     ∂S/∂q_a = −m_a,   ∂S/∂q_b = m_b,   ∂S/∂n = −∫ d ds,   ∂S/∂ℓ = −H.
///
/// Everything the joints need (moments, relative positions, the Hamiltonian) is a gradient of S, and the Newton
/// matrix of a chain is a sum of Hessians of S, one an arc, condensed to the arc's ends.
namespace windlass::bvp {

/// Largest sizes an arc's ends can have: two quaternions (3 + 3), a force (3) and the length (1); of a line that slips with the
/// moment of its friction (3 + 3), (2), (1) and what it changes (2).
inline constexpr int max_ends = 11;
using EndsVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_ends, 1>;
using EndsMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_ends, max_ends>;

/// Where an arc is evaluated. Pointers refer to ambient coordinates; `interior` is empty for closed-form arcs.
struct ArcPoint {
  const double* q_a = nullptr;       ///< configuration at the start; ambient() numbers
  const double* q_b = nullptr;       ///< configuration at the end
  const double* interior = nullptr;  ///< configurations between, interior_nodes() × ambient()
  const double* n = nullptr;         ///< conserved force; forces() numbers
  double length = 0.0;               ///< ℓ > 0
  double friction = 0.0;             ///< mu of what the arc slips on; dragged arcs only
  double travel = 0.0;      ///< ω: the rod runs along itself at ω times the speed of what slips on it
  double compliance = 0.0;  ///< 1/EA of a rod that stretches; extensible arcs only
  const double* weight =
      nullptr;       ///< known force per length: n falls by it, and n is that of the start; null: none
  double arm = 0.0;  ///< of the friction about the centre line; arcs that carry its moment only
};

/// Samples of an arc at all its Lagrange points, ends included.
struct ArcSamples {
  Eigen::VectorXd sigma;     ///< scaled arclength in [0, 1]; N
  Eigen::MatrixXd q;         ///< ambient × N
  Eigen::MatrixXd momentum;  ///< ∂L/∂q' in the tangent basis; tangent × N (superconvergent at element ends)
  Eigen::MatrixXd displacement;   ///< ∫₀ d ds; forces × N
  Eigen::MatrixXd slope;          ///< dq/ds in the tangent basis; tangent × N (empty: closed-form arcs)
  std::vector<int> nodes = {};    ///< indices of the element ends among the N samples
  Eigen::MatrixXd force = {};     ///< n along the arc; forces × N (empty: conserved)
  Eigen::VectorXd pressure = {};  ///< where it is an unknown of the arc; N
  double pressed = 0.0;           ///< ∫ of it
  Eigen::VectorXd lever = {};     ///< w of it: the force along the normal is less by w p; N
};

/// An interior configuration that an elimination holds by a spring, as the arc held at its ends alone would not resist:
/// K̂ = K + d dᵀ. What uses the factors undoes it with one more unknown, K ⇔ [K̂ d; dᵀ 1].
struct Held {
  int first = 0;              ///< place of `direction` in the interior's tangent list
  Eigen::VectorXd direction;  ///< d; tangent
};

class Arc {
 public:
  virtual ~Arc() = default;

  virtual int ambient() const = 0;  ///< stored numbers per configuration
  virtual int tangent() const = 0;  ///< degrees of freedom per configuration
  virtual int forces() const = 0;   ///< components of n
  virtual int interior_nodes() const { return 0; }
  /// Stored numbers and degrees of freedom of an interior configuration; its ends may have more.
  virtual int node_ambient() const { return ambient(); }
  virtual int node_tangent() const { return tangent(); }
  int interior_ambient() const { return interior_nodes() * node_ambient(); }
  int interior_tangent() const { return interior_nodes() * node_tangent(); }
  /// Components of n that a load along the arc changes: n is then the force at its start. Such a load has no potential, the
  /// condensed matrix is not symmetric, and S only names the place of what the arc answers.
  virtual int carried() const { return 0; }
  /// Order of the ends: q_a (tangent), q_b (tangent), n (forces), ℓ (1); of an arc that changes n as many more as it
  /// changes: in a gradient n(ℓ) − n(0), among the unknowns ω first, the others nothing.
  int ends() const { return 2 * tangent() + forces() + 1 + carried(); }
  int length_end() const { return 2 * tangent() + forces(); }

  /// Gradient of the action. `interior` (interior_tangent numbers) is overwritten.
  virtual void gradient(const ArcPoint& at, double* interior, EndsVector& ends) const = 0;

  /// Assembles and factors the Hessian; returns it condensed to the ends (q_a, q_b, n, ℓ), symmetric part. All of it is
  /// that of K̂ where held() is not empty.
  virtual void factor(const ArcPoint& at, EndsMatrix& condensed) = 0;

  /// Forward elimination: on return `rhs_ends` holds the right-hand side of the condensed system.
  virtual void reduce(double* rhs_interior, EndsVector& rhs_ends) const {
    (void)rhs_interior, (void)rhs_ends;
  }
  /// The same with the transpose of a matrix that is not symmetric.
  virtual void reduce_transposed(double* rhs_interior, EndsVector& rhs_ends) const {
    reduce(rhs_interior, rhs_ends);
  }
  /// Back substitution: `interior` comes from reduce() and leaves as the solution, given the solution at the ends.
  virtual void expand(double* interior, const EndsVector& solution_ends) const {
    (void)interior, (void)solution_ends;
  }
  virtual void expand_transposed(double* interior, const EndsVector& solution_ends) const {
    expand(interior, solution_ends);
  }
  /// Negative pivots among the eliminated interior unknowns at the last factor().
  virtual int negative_pivots() const { return 0; }
  /// What the last factor() holds.
  virtual std::span<const Held> held() const { return {}; }

  /// Hessian entries of the whole arc (not condensed): interior first, then the ends. For the spectrum and tests.
  virtual void hessian(const ArcPoint& at, std::vector<Eigen::Triplet<double>>& entries) const = 0;
  /// Diagonal of the metric ∫ |δq|² ds over interior, then q_a, q_b (n and ℓ weigh nothing). Sizes as hessian().
  virtual Eigen::VectorXd metric(const ArcPoint& at) const = 0;

  virtual ArcSamples sample(const ArcPoint& at) const = 0;
  /// Elastic energy ∫ W ds.
  virtual double energy(const ArcPoint& at) const = 0;

  // Discretisation; closed-form arcs have none.
  virtual int elements() const { return 0; }
  virtual int stages() const { return 0; }
  virtual std::vector<double> mesh() const { return {0.0, 1.0}; }
  /// Size of the highest Legendre coefficient in each element, the local resolution indicator.
  virtual std::vector<double> resolution(const ArcPoint& at) const {
    (void)at;
    return {};
  }
  /// The same continuous problem on another mesh or with another number of stages.
  virtual std::unique_ptr<Arc> remeshed(const std::vector<double>& mesh, int stages) const = 0;
  /// Interior configurations of `target` (an arc from remeshed()) interpolated from this arc's; ambient numbers.
  virtual Eigen::VectorXd transfer(const ArcPoint& at, const Arc& target) const = 0;
};

}  // namespace windlass::bvp
