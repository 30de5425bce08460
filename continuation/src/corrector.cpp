#include "continuation/corrector.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace continuation {
namespace {

double rms(const Vector& x) {
  return x.size() == 0 ? 0.0 : x.norm() / std::sqrt(static_cast<double>(x.size()));
}

class Newton {
 public:
  Newton(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options)
      : problem_(problem), borders_(borders), it_(iterate), options_(options), n_(problem.size()) {}

  CorrectorReport run() {
    try {
      iterate();
    } catch (const std::domain_error& error) {
      report_.failure = std::string("outside the domain: ") + error.what();
    } catch (const std::runtime_error& error) {
      report_.failure = error.what();
    }
    return report_;
  }

 private:
  bool parameter_free() const { return borders_.parameter >= 0; }

  void factor() {
    Matrix columns(n_, borders_.c.cols());
    if (parameter_free()) columns.col(0) = problem_.parameter_derivative(it_.x, it_.p, borders_.parameter);
    if (borders_.psi.cols() > 0) columns.rightCols(borders_.psi.cols()) = borders_.psi;
    problem_.factor(it_.x, it_.p, columns, borders_.c, borders_.d);
    ++report_.factorizations;
  }

  void direction() {
    delta_ = problem_.solve(-residual_, defect_);
    if (!delta_.allFinite()) throw std::runtime_error("Newton's correction is not finite");
    dx_ = delta_.head(n_);
    double square = problem_.inner(dx_, dx_);
    if (parameter_free()) square += std::pow(delta_[n_] / borders_.scale, 2);
    size_ = std::sqrt(square);
  }

  void apply() {
    it_.x = problem_.retract(it_.x, dx_);
    it_.u += dx_;
    it_.y += delta_.tail(borders_.c.cols());
    if (parameter_free()) it_.p[borders_.parameter] += delta_[n_];
  }

  void iterate() {
    double previous = 0.0;
    for (int k = 0;; ++k) {
      residual_ = problem_.residual(it_.x, it_.p);
      if (borders_.psi.cols() > 0) residual_ += borders_.psi * it_.y.tail(borders_.psi.cols());
      defect_ = borders_.g - borders_.c.transpose() * it_.u - borders_.d * it_.y;
      report_.residual = residual_.size() ? residual_.lpNorm<Eigen::Infinity>() : 0.0;
      if (!std::isfinite(report_.residual)) throw std::runtime_error("the residual is not finite");
      const double tolerance = options_.newton_tolerance;
      // What rounding may leave where the state has large entries; taken only once corrections no longer shrink.
      const double rounding = tolerance * std::max(1.0, rms(it_.x));
      bool fresh = k == 0;
      if (fresh) factor();
      direction();
      bool stagnant = false;
      if (k > 0) {
        double contraction = size_ / previous;
        if (k == 1) report_.contraction = contraction;
        // Three more chord steps will not do, or they hardly converge.
        const bool slow = size_ * std::pow(contraction, 3) > tolerance ||
                          (k > 1 && contraction > 0.1 && size_ * contraction > tolerance);
        if (size_ > tolerance && slow) {
          factor();
          direction();
          fresh = true;
          contraction = size_ / previous;
        }
        if (contraction > 1.0 && size_ > 10.0 * rounding)
          throw std::runtime_error("Newton's corrections grow");
        stagnant = contraction > 0.2;
      }
      report_.increment = size_;
      // Equations that are nearly singular turn a residual that is all rounding into corrections above the tolerance.
      const bool exhausted = stagnant && report_.residual <= 1e-4 * options_.residual_tolerance;
      const bool small = size_ <= tolerance || (stagnant && size_ <= (exhausted ? 10.0 : 1.0) * rounding);
      // Where corrections are this small twice, what is left of F is the rounding of its large terms (those of an arc
      // about to vanish, say).
      const bool rounded = k > 0 && previous <= tolerance && size_ <= 0.1 * tolerance;
      const bool done = small && (rounded || report_.residual <= options_.residual_tolerance);
      // At roundoff the state is left alone, so that the factorisation belongs to it exactly.
      if (done && fresh && size_ <= 1e-3 * tolerance) {
        report_.factored_here = true;
      } else {
        apply();
      }
      if (done) {
        report_.converged = true;
        return;
      }
      previous = size_;
      if (++report_.iterations > options_.max_newton) {
        std::ostringstream message;
        message << "no convergence in " << options_.max_newton << " corrections (increment " << size_
                << ", residual " << report_.residual << ")";
        report_.failure = message.str();
        return;
      }
    }
  }

  Problem& problem_;
  const Borders& borders_;
  Iterate& it_;
  const Options& options_;
  const Eigen::Index n_;
  CorrectorReport report_;
  Vector residual_, defect_, delta_, dx_;
  double size_ = 0.0;
};

}  // namespace

CorrectorReport correct(Problem& problem, const Borders& borders, Iterate& iterate, const Options& options) {
  return Newton(problem, borders, iterate, options).run();
}

}  // namespace continuation
