#include "windlass/pull/pull.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "start.hpp"
#include "step_solver.hpp"

namespace windlass::pull {

using discrete_rod::OpenSpline;
using discrete_rod::SplineRod;
using Eigen::VectorXd;

namespace {

/// Fine elements reach so far beyond half the angle: what touches, and what may run up to it [ρ].
constexpr double fine_beyond = 2.5;

/// Iterations after which the next step may be longer, and by how much; what a failed step is cut to.
constexpr int few_iterations = 6;
constexpr double growth = 1.6, cut = 0.25;
/// Far below any length of the problem: shorter steps find what this one does not only by rounding [ρ].
constexpr double shortest = 1e-7;

OpenSpline spline_of(const Setting& setting, double half_length, double h) {
  return OpenSpline(SplineRod(half_length, 0.5 * setting.angle + fine_beyond, h));
}

/// The shape on one mesh as control points of another.
VectorXd resampled(const OpenSpline& from, const VectorXd& controls, const OpenSpline& to) {
  std::vector<OpenSpline::Point> points;
  int e = 0;
  for (int k = 0; k <= to.elements(); ++k) {
    const double s = to.knot(k);
    while (e + 1 < from.elements() && from.knot(e + 1) < s) ++e;
    points.push_back(OpenSpline::position(controls, e, (s - from.knot(e)) / from.length(e)));
  }
  return to.through(points);
}

}  // namespace

void Options::validate() const {
  if (!(step > 0.0 && step <= 1.0)) throw std::invalid_argument("pull: step must be in (0, 1]");
  if (!(window >= step)) throw std::invalid_argument("pull: window must be >= step");
  if (!(steady > 0.0)) throw std::invalid_argument("pull: steady must be > 0");
}

double mesh_under(double tension, double h) { return h * std::min(1.0, 1.0 / std::sqrt(tension)); }

Setting setting_of(const scene::Scene& natural) {
  Setting out;
  out.tension = natural.load.tension;
  out.angle = natural.load.angle;
  out.plate = natural.plate ? natural.plate->height : 0.0;
  if (natural.second_plate) out.below = natural.second_plate->height;
  out.radius = natural.strand_radius();
  out.compliance = natural.rod.compliance();
  out.blocked = natural.ends.travel == scene::Travel::blocked;
  out.coulomb.friction = natural.friction.value_or(0.0);
  return out;
}

scene::Scene at_rest(scene::Scene scene) {
  scene.motion = {};
  scene.friction.reset();
  scene.plate.reset();
  scene.second_plate.reset();
  scene.continuation.reset();
  return scene;
}

Pull::Pull(const Setting& setting, double half_length, double h, const Options& options)
    : half_length_(half_length),
      h_(h),
      options_(options),
      rod_(spline_of(setting, half_length, h), setting, h),
      solver_(std::make_unique<StepSolver>(rod_)) {
  options.validate();
  if (!(h > 0.0 && h <= 0.25)) throw std::invalid_argument("pull: h must be in (0, 0.25]");
}

Pull::~Pull() = default;

bool Pull::settle(VectorXd& unknowns, double damping, bool plates) {
  return solver_->solve(rod_.fresh_memory(unknowns), {0.0, damping, false, plates}, unknowns) >= 0;
}

/// Damping that fades: proximal steps, which leave motions that cost nothing where they are.
bool Pull::relax(VectorXd& unknowns) {
  constexpr double first = 10.0, last = 1e-6, fade = 0.1;
  for (double damping = first; damping > last; damping *= fade)
    if (!settle(unknowns, damping * rod_.setting.tension, false)) return false;
  return true;
}

/// Without friction the second plate is brought from below the rod to where it is. Tails come to lie along both plates all at once:
/// against a damping like the beds' stiffness each place finds its own way, and as it fades it comes to rest.
bool Pull::squeeze(VectorXd& unknowns, double span) {
  Setting& setting = rod_.setting;
  const double room = setting.plate - setting.below, excess = std::max(0.0, span - room);
  if (!std::isfinite(room)) return true;
  const double part = 0.5 * h_, stiff = rod_.stiffness(), fade = 0.3;
  const int parts = std::max(1, static_cast<int>(std::ceil(excess / part)));
  for (int k = 1; k <= parts; ++k) {
    setting.below = setting.plate - room - excess * (1.0 - static_cast<double>(k) / parts);
    if (!settle(unknowns, stiff, true)) return false;
  }
  for (double damping = stiff; damping > setting.tension && settle(unknowns, damping, true);) damping *= fade;
  return true;  // the pull begins with the rod at rest, or brings it there
}

bool Pull::start(const equilibrium::Solution& frictionless) {
  // From meshes coarse enough for what lies between the samples of the state.
  constexpr double coarse = 0.2, ratio = 0.6;
  VectorXd controls;
  std::optional<OpenSpline> before;
  for (double h = std::max(coarse, h_);; h = std::max(ratio * h, h_)) {
    Pull level(rod_.setting, half_length_, h, options_);
    const OpenSpline& spline = level.rod_.spline();
    VectorXd unknowns =
        level.rod_.unknowns(before ? resampled(*before, controls, spline) : laid_along(spline, frictionless));
    if (!level.relax(unknowns)) return false;
    controls = unknowns.head(spline.size());
    before = spline;
    if (h > h_) continue;
    const Measured at = rod_.measured(unknowns, rod_.fresh_memory(unknowns), {0.0, 0.0, false, false});
    for (Eigen::Index k = 2; k < spline.size(); k += 3)
      unknowns(k) += rod_.setting.plate - rod_.reach() - at.z_high;
    if (!squeeze(unknowns, at.z_high - at.z_low)) return false;
    state_ = {unknowns, unknowns, rod_.fresh_memory(unknowns).slip,
              0.0,      0.0,      std::min(rod_.setting.coulomb.slip, options_.step)};
    return true;
  }
}

void Pull::resume(State state) { state_ = std::move(state); }

Memory Pull::memory() const {
  Memory out = rod_.fresh_memory(state_.unknowns);
  out.slip = state_.slip;
  return out;
}

void Pull::accept(const VectorXd& unknowns, const Memory& last, const Step& step) {
  state_.before = std::exchange(state_.unknowns, unknowns);
  state_.slip = rod_.memory(unknowns, last, step).slip;
  state_.displacement += step.advance;
  state_.last_step = step.advance;
}

int Pull::jump(double advance, Row& row) {
  constexpr double fade = 0.3, stronger = 4.0, weakest = 1e-6;
  constexpr int most = 400;
  Step step{advance, rod_.setting.tension, true};
  int iterations = 0;
  for (int k = 0; k < most; ++k) {
    const bool free = step.damping < weakest * rod_.setting.tension;
    if (free) step.damping = 0.0;
    const Memory last = memory();
    VectorXd unknowns = state_.unknowns;
    const int used = solver_->solve(last, step, unknowns);
    if (used < 0) {
      step.damping = free ? weakest * rod_.setting.tension : step.damping * stronger;
      continue;
    }
    iterations += used;
    row.at = rod_.measured(unknowns, last, step);
    accept(unknowns, last, step);
    step.advance = 0.0;
    if (free) return iterations;
    step.damping *= fade;
  }
  return -1;
}

std::optional<Row> Pull::advance() {
  const Memory last = memory();
  Row row;
  for (double length = state_.next_step; length > shortest; length *= cut) {
    const Step step{length, 0.0, true};
    VectorXd unknowns = state_.unknowns;
    if (state_.last_step > 0.0) unknowns += length / state_.last_step * (state_.unknowns - state_.before);
    row.iterations = solver_->solve(last, step, unknowns);
    if (row.iterations < 0) continue;
    row.at = rod_.measured(unknowns, last, step);
    accept(unknowns, last, step);
    state_.next_step = row.iterations <= few_iterations ? std::min(options_.step, growth * length) : length;
    row.displacement = state_.displacement;
    row.step = length;
    return row;
  }
  row.jumped = true;
  row.step = std::min(rod_.setting.coulomb.slip, options_.step);
  row.iterations = jump(row.step, row);
  if (row.iterations < 0) return std::nullopt;
  state_.before = state_.unknowns;
  state_.last_step = 0.0;
  state_.next_step = row.step;
  row.displacement = state_.displacement;
  return row;
}

std::optional<Plateau> plateau(std::span<const Row> rows, const Options& options) {
  if (rows.empty()) return std::nullopt;
  constexpr double at_rest =
      0.02;  // of the cylinder's speed; a chord of travel along a bend leaves half its sag
  constexpr double stuck = 1e-6;
  const double end = rows.back().displacement;
  Plateau now, earlier;
  double covered = 0.0, covered_earlier = 0.0;
  for (auto row = rows.rbegin(); row != rows.rend() && row->displacement > end - 2.0 * options.window;
       ++row) {
    if (row->jumped || row->at.sticking > stuck || row->at.moved > at_rest * row->step) return std::nullopt;
    const bool late = row->displacement > end - options.window;
    Plateau& mean = late ? now : earlier;
    (late ? covered : covered_earlier) += row->step;
    mean.drag += row->step * row->at.drag;
    mean.R_tot += row->step * row->at.R_tot;
  }
  if (end < 2.0 * options.window || covered_earlier <= 0.0) return std::nullopt;
  const double change = now.drag / covered - earlier.drag / covered_earlier;
  if (std::abs(change) > options.steady * now.drag / covered) return std::nullopt;
  return Plateau{now.drag / covered, now.R_tot / covered};
}

}  // namespace windlass::pull
