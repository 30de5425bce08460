#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace continuation {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

class BorderedNewton;
class Problem;

/// What follows an event: the problem that holds beyond it, and its state there.
struct Transition {
  /// The event itself, where that is known better than as a zero of its function.
  struct Located {
    std::shared_ptr<Problem> problem;
    Vector x, p;
    double precision = 0.0;
  };
  std::shared_ptr<Problem> problem;  ///< null: the branch ends here (a reported end, not a failure)
  Vector state;                      ///< a guess for the new problem, to be corrected by the caller
  std::string before, after;         ///< descriptions of the two sides, e.g. contact topologies
  Vector p;  ///< where `state` solves, if beside the event (where a new part has no size yet)
  /// Of p, if `state` at p is the event itself, located from beyond; negative: it is not. Where the branch ends: how
  /// far the end may be from the zero of the event's function.
  double precision = -1.0;
  std::string vanishes =
      {};  ///< there, the function of `problem` that is zero at the event; "": none has a name
  std::optional<Located> located = {};
  bool silent = false;  ///< the same state, described otherwise: no point of the branch
};

/// A solution of a problem posed on symmetric states, in the problem without that restriction.
struct Unrestricted {
  std::shared_ptr<Problem> problem;
  Vector x;
};

/// A scalar that must keep its sign along a regular branch, or whose zeros are noted.
struct EventFunction {
  std::string name;  ///< e.g. "pressure", "force touch 2"; unique within a problem
  double value = 0.0;
  bool imminent =
      false;  ///< near this zero F is nearly singular: where steps fail, it is taken to be reached
  /// The description of the state changes here, F does not: the branch goes on, and may come back through the zero.
  bool passes = false;
};

/// A smooth family of nonlinear equations F(x, p) = 0, with as many equations as degrees of freedom.
///
/// `x` is a stored state of any length; increments `dx` have length `size()`, and `retract` applies one to
/// the other, so that x may hold redundant coordinates (unit quaternions). For plain problems both are the
/// same. `p` holds every continuation parameter. The library owns no linear algebra of the problem: it asks
/// for bordered systems
///
///     [ J   B ] [dx]   [f]
///     [ Cᵀ  D ] [dy] = [g],       J = ∂F/∂x (n×n),  B, C: n×k,  D: k×k,  k small (0 included),
///
/// which stay regular where J itself is singular (folds, branch points).
class Problem {
 public:
  virtual ~Problem() = default;

  /// Number of equations and of degrees of freedom, n.
  virtual Eigen::Index size() const = 0;

  /// F(x, p); shape n. @throws std::domain_error when x or p lies outside F's domain (the step is then cut).
  virtual Vector residual(const Vector& x, const Vector& p) = 0;

  /// Size of a residual F(x, p) just evaluated, for stopping rules. The default is max |F|; a problem whose equations have
  /// different units weighs them.
  virtual double residual_norm(const Vector& f) const;

  /// Assembles and factors the bordered matrix at (x, p). @throws std::runtime_error if it is singular.
  virtual void factor(const Vector& x, const Vector& p, const Matrix& B, const Matrix& C,
                      const Matrix& D) = 0;

  /// Solves with the last factored matrix. f: n, g: k; returns the n + k unknowns stacked.
  virtual Vector solve(const Vector& f, const Vector& g) = 0;

  /// The same with the transposed matrix.
  virtual Vector solve_transposed(const Vector& f, const Vector& g) = 0;

  /// Number of negative eigenvalues of the second variation at (x, p), an equilibrium; the last `factor` was
  /// made there. Problems that are not gradients return the number of negative real eigenvalues of J, or -1
  /// if unknown: branch points are then seen by determinant_sign() alone.
  virtual int index(const Vector& x, const Vector& p) = 0;

  /// Number of complex eigenvalues of J with negative real part (two a pair), asked for right after index(). With it
  /// Hopf points are seen, and a pair that turns real is told from branch points. The default is 0.
  virtual int complex_index(const Vector& x, const Vector& p);

  /// Where F is posed on the symmetric states of a larger problem only (half of a body that is its own mirror
  /// image): negative directions of the larger problem's second variation that break the symmetry, which index()
  /// does not count and F does not see; of problems that are not gradients that number modulo two is enough, as of
  /// determinant_sign(). Called after index() at the same point; -1: no such restriction, or unknown (the default).
  virtual int breaking_index(const Vector& x, const Vector& p);

  /// The solution x in the larger problem; nullopt where there is none, or it cannot be found.
  virtual std::optional<Unrestricted> unrestricted(const Vector& x, const Vector& p);

  /// ∂F/∂p_k; shape n. The default is a central difference with step cbrt(eps)·max(1, |p_k|).
  virtual Vector parameter_derivative(const Vector& x, const Vector& p, Eigen::Index k);

  /// State after the increment dx (shape n). The default is x + dx.
  virtual Vector retract(const Vector& x, const Vector& dx) const;

  /// Inner product of increments, the metric of path length. The default is the mean of products, (a·b)/n.
  virtual double inner(const Vector& a, const Vector& b) const;

  /// Row vector of the functional inner(a, ·), so that dual(a)·b ≈ inner(a, b) and dual(a)·a = inner(a, a)
  /// exactly. The default scales a; override it together with an `inner` whose weights differ much from
  /// entry to entry.
  virtual Vector dual(const Vector& a) const;

  /// Sign of the determinant of the last factored matrix, borders included; 0 if unknown (the default). Used
  /// to see branch points of problems whose index() is -1; it misses even multiplicities.
  virtual int determinant_sign();

  /// Directions in the kernel of J along which arms may leave a multiple branch point; each is tried with
  /// both signs. kernel: n×k, unit columns in `inner`. None (the default): for k = 2 the library finds the arms
  /// from the bifurcation equations, for larger k it tries the columns.
  virtual std::vector<Vector> kernel_directions(const Vector& x, const Vector& p, const Matrix& kernel);

  /// Signed functions, positive where this problem's description is valid (contact forces, gaps, lengths).
  virtual std::vector<EventFunction> events(const Vector& x, const Vector& p);

  /// Called at a located zero of events()[which]; nullopt: no continuation is known (the branch is lost).
  /// Of an event that `passes` only the two descriptions are asked, that of its positive side first.
  virtual std::optional<Transition> transition(std::size_t which, const Vector& x, const Vector& p);

  /// A solution of whatever description holds at `ahead`, near the guess x there: where transition() knows none, or what it knows
  /// leads nowhere. It must be as near to the guess as that is to the last state, or it is of another branch.
  /// @param last, last_p  the branch's last state of this description
  /// @returns nullopt (the default): none is found
  virtual std::optional<Transition> resettled(const Vector& last, const Vector& last_p, const Vector& x,
                                              const Vector& ahead);

  /// May change the discretisation after an accepted point; returns the new state when it did. size() may
  /// change.
  virtual std::optional<Vector> adapt(const Vector& x, const Vector& p);
  /// A state x of `before`, this problem as it was until adapt(), on the discretisation of now; not solved again. Two of them
  /// tell which way a branch goes. Without it (nullopt, the default) nothing is adapted next to a fold.
  virtual std::optional<Vector> carried_over(const Problem& before, const Vector& x, const Vector& p);

  /// Called on every solution the corrector found, at fixed p: moves x along directions too soft to be left to Newton's
  /// method, to where nothing has to hold it. Returns whether x was moved; the default has no such directions.
  /// @throws std::domain_error where there is no such place.
  virtual bool settle(Vector& x, const Vector& p);
  /// Why x moved by dx would need what settle() takes away; empty: it would not. Along such a direction of a singular
  /// Jacobian no branch leaves.
  virtual std::string unsettled(const Vector& x, const Vector& dx) const;

  /// Motions that cost nothing at solutions close to x, unit columns of increments (n×e): there J and its transpose have them
  /// in their kernel though no branch leaves along them, and where branches cross they are held. The default is none.
  virtual Matrix neutral_motions(const Vector& x, const Vector& p);

  /// Numbers that do not depend on discretisation, nor on which of two mirror images x is: two states with
  /// equal fingerprints are the same solution (up to mirror image). The default is x itself.
  virtual Vector fingerprint(const Vector& x, const Vector& p);

  /// The problem's own nonlinear solver, which lives as long as the problem; null (the default): the
  /// library's ChordNewton. It may keep objects between solves; what it keeps must not change the results.
  virtual BorderedNewton* newton() { return nullptr; }

  /// An independent copy (own factorisation, own discretisation).
  virtual std::shared_ptr<Problem> clone() const = 0;
};

}  // namespace continuation
