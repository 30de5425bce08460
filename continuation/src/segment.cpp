#include "continuation/segment.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace continuation {

Segment::Segment(std::shared_ptr<Problem> problem, const Options& options, Vector x, Vector p,
                 Tangent tangent)
    : problem_(std::move(problem)), options_(options), tangent_(std::move(tangent)) {
  keller_.parameter = options_.parameter;
  keller_.scale = options_.parameter_scale;
  keller_.psi = Matrix(problem_->size(), 0);
  keller_.state_scale = options_.state_scale;
  keller_.c = problem_->dual(tangent_.x) / (options_.state_scale * options_.state_scale);
  keller_.d = Matrix::Constant(1, 1, tangent_.p / (keller_.scale * keller_.scale));
  keller_.g = Vector::Zero(1);
  Sample base;
  base.it = Iterate{std::move(x), Vector::Zero(problem_->size()), std::move(p), Vector::Zero(1)};
  base.tangent = tangent_;
  samples_.push_back(std::move(base));
}

Iterate Segment::guess(double s) const {
  const Sample* nearest = &samples_.front();
  const Sample* second = nullptr;
  for (const Sample& sample : samples_) {
    if (std::abs(sample.s - s) < std::abs(nearest->s - s)) nearest = &sample;
  }
  for (const Sample& sample : samples_) {
    if (&sample == nearest || sample.s == nearest->s) continue;
    if (!second || std::abs(sample.s - s) < std::abs(second->s - s)) second = &sample;
  }
  Iterate it = nearest->it;
  if (s == nearest->s) return it;
  Vector du;
  double dp = 0.0;
  if (second) {
    const double ratio = (s - nearest->s) / (second->s - nearest->s);
    du = ratio * (second->it.u - nearest->it.u);
    dp = ratio * (second->it.y[0] - nearest->it.y[0]);
  } else {
    du = (s - nearest->s) * tangent_.x;
    dp = (s - nearest->s) * tangent_.p;
    if (curvature_.x.size() > 0) {
      du += 0.5 * s * s * curvature_.x;
      dp += 0.5 * s * s * curvature_.p;
    }
  }
  it.x = problem_->retract(it.x, du);
  it.u += du;
  it.p[options_.parameter] += dp;
  it.y[0] += dp;
  return it;
}

Sample* Segment::finish(const Borders& borders, Iterate it, bool wants_complete) {
  Sample sample;
  sample.it = std::move(it);
  sample.report = correct(*problem_, borders, sample.it, options_);
  if (!sample.report.converged) {
    failure_ = sample.report.failure;
    return nullptr;
  }
  sample.s = path_length(sample.it.u, sample.it.y[0]);
  if (!settled(sample)) return nullptr;
  if (&borders != &keller_) sample.report.factored_here = false;
  if (wants_complete && !completed(sample)) return nullptr;
  samples_.push_back(std::move(sample));
  return &samples_.back();
}

bool Segment::settled(Sample& sample) {
  return tried([&] {
    if (problem_->settle(sample.it.x, sample.it.p)) sample.report.factored_here = false;
  });
}

bool Segment::completed(Sample& sample) {
  return tried([&] { complete(sample); });
}

bool Segment::tried(const std::function<void()>& step) {
  try {
    step();
    return true;
  } catch (const std::domain_error& error) {
    failure_ = error.what();
  } catch (const std::runtime_error& error) {
    failure_ = error.what();
  }
  return false;
}

Sample* Segment::at(double s, bool wants_complete) {
  for (Sample& sample : samples_) {
    if (sample.s != s) continue;
    if (sample.complete || !wants_complete) return &sample;
    // Solved again it would differ by rounding, and with it the sign of an event function that is zero here.
    sample.report.factored_here = false;
    return completed(sample) ? &sample : nullptr;
  }
  keller_.g[0] = s;
  Sample* sample = finish(keller_, guess(s), wants_complete);
  if (sample) sample->s = s;
  return sample;
}

const Sample* Segment::corrected() {
  keller_.g[0] = 0.0;
  return finish(keller_, base().it, true);
}

Sample* Segment::at_parameter(double value, const Sample& lo, const Sample& hi, bool wants_complete) {
  const double change = value - base().it.p[options_.parameter];
  const double rise = hi.it.y[0] - lo.it.y[0];
  const double s = rise == 0.0 ? lo.s : lo.s + (hi.s - lo.s) * (change - lo.it.y[0]) / rise;
  Borders fixed = keller_;
  fixed.c.setZero();
  fixed.d(0, 0) = 1.0;
  fixed.g[0] = change;
  Sample* sample = finish(fixed, guess(s), wants_complete);
  if (sample) sample->it.p[options_.parameter] = value;
  return sample;
}

void Segment::complete(Sample& sample) {
  Problem& problem = *problem_;
  if (!sample.report.factored_here) {
    const Matrix column = problem.parameter_derivative(sample.it.x, sample.it.p, options_.parameter);
    problem.factor(sample.it.x, sample.it.p, column, keller_.c, keller_.d);
  }
  sample.tangent = next_tangent(problem, options_.scales());
  if (!sample.tangent.x.allFinite()) throw std::runtime_error("the tangent is not finite");
  sample.determinant = problem.determinant_sign();
  sample.index = options_.detect_branch_points ? problem.index(sample.it.x, sample.it.p) : -1;
  if (options_.detect_branch_points && sample.index < 0 && sample.determinant != 0) {
    const std::optional<SmallEigenvalues>& near = base().small;
    sample.small =
        small_eigenvalues(problem, sample.tangent.x, sample.tangent.p, near ? near->basis : Matrix());
  }
  sample.complex_index = sample.index >= 0 ? problem.complex_index(sample.it.x, sample.it.p) : 0;
  sample.breaking_index =
      options_.detect_branch_points ? problem.breaking_index(sample.it.x, sample.it.p) : -1;
  sample.complete = true;
}

Correction Segment::sharpen(Sample& sample) {
  keller_.g[0] = sample.s;
  BorderedSystem system(*problem_, keller_, sample.it);
  const Vector defect = system.defect();
  system.factor();
  const Vector delta = system.solve(defect);
  system.add(delta);
  sample.report.factored_here = false;
  return {system.length(delta), std::abs(delta[problem_->size()])};
}

const Sample* Segment::complete_beside(double s, double beyond, int side) const {
  const Sample* nearest = nullptr;
  for (const Sample& sample : samples_) {
    const double distance = side * (sample.s - s);
    if (!sample.complete || distance < beyond) continue;
    if (!nearest || distance < side * (nearest->s - s)) nearest = &sample;
  }
  return nearest;
}

double Segment::reach() const {
  double reach = 0.0;
  for (const Sample& sample : samples_) reach = std::max(reach, std::abs(sample.s));
  return reach;
}

void Segment::add_events(Sample& sample) { sample.events = problem_->events(sample.it.x, sample.it.p); }

}  // namespace continuation
