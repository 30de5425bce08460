// Damped motion: a coil disturbed from an unstable state leaves it, from a stable one it returns, both at the rate that
// the spectrum says.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/equilibrium/start.hpp"
#include "windlass/stability/spectrum.hpp"

namespace {

using namespace windlass;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Gradient flow of the discrete energy at fixed active contacts (the edges keep their arclengths):
///
///     M v = −∂E/∂x − Aᵀn,   A v = −γ c,
///
/// with M = ∫ |δ(rotation)|² ds (viscous damping of the frames, the metric of the spectrum), c = 0 the closure of the line
/// contact, A its derivative, n the conserved momenta as multipliers, and γ pulling rounding back to c = 0. Linearised at
/// an equilibrium its rates are the eigenvalues −μ of the second variation. Rest states are equilibria up to the edges'
/// location conditions. Integrated by CVODE's BDF, since elastic relaxation is stiff.
class DampedMotion {
 public:
  DampedMotion(const chain::Chain& chain, contact::Loads loads, const VectorXd& rest)
      : chain_(chain), loads_(loads) {
    for (int j = 0; j < chain.joint_count(); ++j) {
      const std::size_t coordinates =
          j == 0 ? chain.joint(0).even(contact::Symmetry::half_turn).size() : chain.joint(j).tangent();
      for (std::size_t k = 0; k < coordinates; ++k) kept_.push_back(row_++);
      row_ += chain.locates(j);
    }
    for (int i = 0; i < chain.link_count(); ++i)
      if (chain.link(i).pull == 0)
        for (int k = 0; k < chain.link(i).arc->forces(); ++k) {
          multipliers_.push_back(static_cast<Eigen::Index>(kept_.size()));
          places_.push_back(chain.force(const_cast<VectorXd&>(rest), i) + k - rest.data());
          kept_.push_back(row_++);
        }
    while (row_ < chain.size()) kept_.push_back(row_++);
    metric_ = MatrixXd(chain.second_variation(rest, loads, contact::Parity::even).metric);
    BOOST_TEST_REQUIRE(metric_.rows() == static_cast<Eigen::Index>(kept_.size()));
  }

  /// dx/dt of the stored coordinates.
  VectorXd rate(VectorXd x) const {
    for (const Eigen::Index at : places_) x(at) = 0.0;
    const VectorXd free = residual(x);
    MatrixXd matrix = metric_;
    VectorXd rhs = -free;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      VectorXd with = x;
      with(places_[k]) = 1.0;
      VectorXd column = residual(with) - free;  // the action is linear in n
      for (const Eigen::Index m : multipliers_) column(m) = 0.0;
      matrix.col(multipliers_[k]) = column;
      matrix.row(multipliers_[k]) = column.transpose();
      rhs(multipliers_[k]) *= 10.0;  // γ
    }
    const VectorXd v = matrix.partialPivLu().solve(rhs);
    VectorXd step = VectorXd::Zero(chain_.size());
    for (std::size_t k = 0; k < kept_.size(); ++k) step(kept_[k]) = v(k);
    for (const Eigen::Index m : multipliers_) step(kept_[m]) = 0.0;
    constexpr double h = 1e-5;  // central difference of the retraction: error h²
    return (chain_.retract(x, h * step) - chain_.retract(x, -h * step)) / (2.0 * h);
  }

  /// Inclinations of the mid-point at the times given, from x at t = 0.
  std::vector<double> tilts(VectorXd x, const std::vector<double>& times) const {
    SUNContext context = nullptr;
    BOOST_TEST_REQUIRE(SUNContext_Create(nullptr, &context) == 0);
    const auto n = static_cast<sunindextype>(x.size());
    N_Vector state = N_VMake_Serial(n, x.data(), context);
    SUNMatrix matrix = SUNDenseMatrix(n, n, context);
    SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
    void* cvode = CVodeCreate(CV_BDF, context);
    const CVRhsFn right_hand_side = [](realtype, N_Vector y, N_Vector rate, void* self) {
      const Eigen::Map<const VectorXd> at(N_VGetArrayPointer(y), N_VGetLength(y));
      Eigen::Map<VectorXd>(N_VGetArrayPointer(rate), at.size()) =
          static_cast<const DampedMotion*>(self)->rate(at);
      return 0;
    };
    BOOST_TEST_REQUIRE(CVodeInit(cvode, right_hand_side, 0.0, state) == 0);
    BOOST_TEST_REQUIRE(CVodeSStolerances(cvode, 1e-6, 1e-9) == 0);
    BOOST_TEST_REQUIRE(CVodeSetUserData(cvode, const_cast<DampedMotion*>(this)) == 0);
    BOOST_TEST_REQUIRE(CVodeSetLinearSolver(cvode, solver, matrix) == 0);
    std::vector<double> tilts;
    for (const double t : times) {
      double reached = 0.0;
      BOOST_TEST_REQUIRE(CVode(cvode, t, state, &reached, CV_NORMAL) == 0);
      tilts.push_back(chain_.coordinates(x, 0)[chain_.joint(0).even(contact::Symmetry::half_turn).front()]);
    }
    CVodeFree(&cvode);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(state);
    SUNContext_Free(&context);
    return tilts;
  }

 private:
  VectorXd residual(const VectorXd& x) const {
    const VectorXd all = chain_.residual(x, loads_);
    VectorXd out(kept_.size());
    for (std::size_t k = 0; k < kept_.size(); ++k) out(k) = all(kept_[k]);
    return out;
  }

  const chain::Chain& chain_;
  contact::Loads loads_;
  std::vector<Eigen::Index> kept_, multipliers_,
      places_;  ///< rows kept; which of them, and where in x, the n are
  Eigen::Index row_ = 0;
  MatrixXd metric_;
};

struct Outcome {
  double eigenvalue, rate;
  std::vector<double> tilts;
};

/// The flat 2π coil at tension T, disturbed along its lowest mode and let go.
Outcome let_go(double tension, double amplitude) {
  scene::Scene scene;
  scene.has_cylinder = true;
  scene.load.tension = tension;
  scene.load.angle = 2.0 * M_PI;
  scene.rod.length = 14.0;
  const chain::Topology topology{{chain::Stretch::line, chain::Stretch::tail}, true, false};
  const double contact = 0.5 * scene.load.angle - std::acos(1.0 - 0.5 / tension),
               half = 0.5 * scene.rod.length;
  equilibrium::RodProblem problem(
      scene, true, topology, {{chain::uniform_mesh(3), 3}, {chain::uniform_mesh(6), 3}}, {"load.tension"});
  VectorXd x =
      chain::guess_state(problem.chain(), topology, problem.rod(),
                         chain::capstan_profile(tension, scene.load.angle, half, 1.0), {0.0, contact, half});
  const VectorXd p = problem.parameters();
  BOOST_TEST_REQUIRE(problem.polish(x, p) >= 0);
  const contact::Loads loads = problem.loads(p);
  const chain::Linearisation linearised(problem.factored(x, p), problem.rod(), x, loads);
  const auto spectrum =
      stability::SpectrumSolver().lowest(chain::Variation(linearised, contact::Parity::even), 1);
  VectorXd kick = problem.chain().as_increment(spectrum.eigenvectors.col(0), contact::Parity::even);
  kick *= amplitude / std::abs(kick(0));
  const DampedMotion motion(problem.chain(), loads, x);
  const double mu = spectrum.eigenvalues(0), unit = 1.0 / std::abs(mu);
  Outcome out{mu, 0.0, motion.tilts(problem.chain().retract(x, kick), {0.2 * unit, 2.2 * unit})};
  out.rate = std::log(out.tilts[1] / out.tilts[0]) / (2.0 * unit);
  return out;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(dynamics)

BOOST_AUTO_TEST_CASE(an_unstable_coil_is_left_and_a_stable_one_regained) {
  for (const double tension : {1.0, 1.5}) {
    const Outcome out = let_go(tension, 1e-3);
    BOOST_TEST_CONTEXT("T " << tension << ", eigenvalue " << out.eigenvalue << ", rate " << out.rate) {
      BOOST_TEST((out.eigenvalue < 0.0) == (tension < 1.2859));
      // e² away or e² nearer; amplitudes of 1e-2 bend the rate by their square, CVODE by its tolerance.
      BOOST_TEST(out.rate == -out.eigenvalue, boost::test_tools::tolerance(1e-3));
      BOOST_TEST((std::abs(out.tilts[1]) > std::abs(out.tilts[0])) == (out.eigenvalue < 0.0));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
