#pragma once

#include <continuation/bordered_newton.hpp>

#include "unit/equilibrium/coil.hpp"

namespace windlass::test {

/// A coil as the continuation library sees it; p = (T).
class ChainProblem : public continuation::Problem {
 public:
  explicit ChainProblem(Coil& coil) : coil_(coil) {}

  Eigen::Index size() const override { return coil_.chain.size(); }
  Eigen::VectorXd residual(const Eigen::VectorXd& x, const Eigen::VectorXd& p) override {
    return coil_.chain.residual(x, at(p));
  }
  void factor(const Eigen::VectorXd& x, const Eigen::VectorXd& p, const Eigen::MatrixXd& b,
              const Eigen::MatrixXd& c, const Eigen::MatrixXd& d) override {
    coil_.chain.factor(x, at(p), b, c, d);
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g) override {
    return coil_.chain.solve(f, g);
  }
  Eigen::VectorXd solve_transposed(const Eigen::VectorXd& f, const Eigen::VectorXd& g) override {
    return coil_.chain.solve(f, g, true);
  }
  int index(const Eigen::VectorXd&, const Eigen::VectorXd&) override { return -1; }
  Eigen::VectorXd retract(const Eigen::VectorXd& x, const Eigen::VectorXd& dx) const override {
    return coil_.chain.retract(x, dx);
  }
  std::shared_ptr<continuation::Problem> clone() const override {
    return std::make_shared<ChainProblem>(coil_);
  }

 private:
  contact::Loads at(const Eigen::VectorXd& p) const {
    contact::Loads loads = coil_.loads;
    loads.tension = p(0);
    return loads;
  }

  Coil& coil_;
};

/// The tension stays.
inline continuation::Borders no_borders(const continuation::Problem& problem) {
  continuation::Borders none;
  none.psi = none.c = Eigen::MatrixXd(problem.size(), 0);
  return none;
}

/// T is an unknown, x is held at right angles to `direction`.
inline continuation::Borders free_tension(const Eigen::VectorXd& direction) {
  continuation::Borders borders;
  borders.parameter = 0;
  borders.psi = Eigen::MatrixXd(direction.size(), 0);
  borders.c = direction;
  borders.d = Eigen::MatrixXd::Ones(1, 1);
  borders.g = Eigen::VectorXd::Constant(1, 0.01);
  return borders;
}

inline continuation::Iterate iterate_at(const Coil& coil, const Eigen::VectorXd& x,
                                        const continuation::Borders& borders) {
  return {x, Eigen::VectorXd::Zero(coil.chain.size()), Eigen::VectorXd::Constant(1, coil.loads.tension),
          Eigen::VectorXd::Zero(borders.c.cols())};
}

}  // namespace windlass::test
