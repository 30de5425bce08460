#include "arcs.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/chain/guess.hpp"
#include "windlass/equilibrium/record.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/rod/capstan.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::precision {

using chain::ArcMesh;
using chain::Stretch;
using equilibrium::RodProblem;
using equilibrium::Vector;

namespace {

const std::vector<std::string> keys{"load.tension"};

/// The mesh with `count` elements that has the same distribution of nodes.
std::vector<double> thinned(const std::vector<double>& nodes, int count) {
  std::vector<double> out{0.0};
  const double last = static_cast<double>(nodes.size() - 1);
  for (int k = 1; k < count; ++k) {
    const double at = last * k / count;
    const std::size_t e = static_cast<std::size_t>(at);
    out.push_back(nodes[e] + (at - static_cast<double>(e)) * (nodes[e + 1] - nodes[e]));
  }
  out.push_back(1.0);
  return out;
}

/// `elements` shared out among the arcs as in `full`.
std::vector<ArcMesh> ladder_meshes(const std::vector<ArcMesh>& full, int elements, int stages) {
  double total = 0.0;
  for (const ArcMesh& mesh : full) total += static_cast<double>(mesh.nodes.size() - 1);
  std::vector<ArcMesh> out;
  for (const ArcMesh& mesh : full) {
    const double share = static_cast<double>(mesh.nodes.size() - 1) / total;
    out.push_back(
        {thinned(mesh.nodes, std::max(1, static_cast<int>(std::lround(share * elements)))), stages});
  }
  return out;
}

Quantities quantities_of(RodProblem& problem, const Vector& x, const Vector& p) {
  const equilibrium::Solution solution = equilibrium::record(problem, x, p);
  return {solution.R_tot, solution.phi_star, solution.energy, std::nullopt};
}

/// Half a rod long enough that the closed form of infinite tails has died out.
double half_length(const scene::Scene& scene) {
  return scene.rod.infinite() ? 0.5 * scene.load.angle + 40.0 / std::sqrt(scene.load.tension)
                              : 0.5 * scene.rod.length;
}

/// Meshes and joints of a whole rod from those of its right half.
/// The whole rod of a symmetric half: topology, meshes and places.
void unfold(chain::Topology& topology, std::vector<ArcMesh>& meshes, std::vector<double>& s) {
  const std::size_t spanned = topology.mid_touch ? 0 : 1;  // the first stretch spans both halves
  std::vector<ArcMesh> all;
  for (std::size_t i = meshes.size(); i-- > spanned;) all.push_back(equilibrium::reversed(meshes[i]));
  if (spanned == 1) all.push_back(equilibrium::spanning(meshes[0]));
  all.insert(all.end(), meshes.begin() + static_cast<std::ptrdiff_t>(spanned), meshes.end());
  std::vector<double> whole;
  for (std::size_t j = s.size(); j-- > 1;) whole.push_back(-s[j]);
  whole.insert(whole.end(), s.begin() + static_cast<std::ptrdiff_t>(spanned), s.end());
  topology = chain::unfolded(topology);
  meshes = all;
  s = whole;
}

}  // namespace

Reference make_reference(const scene::Scene& scene) {
  Reference out;
  out.scene = scene::natural(scene);
  out.scene.model.tolerance = 1e-11;
  const equilibrium::Solution found = equilibrium::solve(out.scene);
  constexpr double flat_to = 1e-9;
  out.flat = std::abs(found.tilt) < flat_to && found.z_span < flat_to;
  const bool closed_form = rod::capstan::line_contact(out.scene.load.tension, scene.load.angle);
  equilibrium::Started start;
  if (out.flat) {
    start = equilibrium::cold_start(out.scene, true, true, keys);
  } else {
    scene::Scene half = out.scene;
    half.model.symmetry = scene::Symmetry::half_turn;
    const equilibrium::Solution helix = equilibrium::solve(half);
    start.problem = equilibrium::reopen(scene::as_given(half), helix.restart, keys);
    start.x = helix.restart.state;
    start.p = start.problem->parameters();
  }
  if (auto meshed = equilibrium::with_meshed_tails(*start.problem, start.x, start.p)) {
    start = *meshed;
    out.scene.rod.length = start.problem->scene_at(start.p).rod.length;  // of an infinite rod
    start.x = start.problem->refine(start.x, start.p);
  }
  out.topology = start.problem->topology();
  out.meshes = start.problem->meshes();
  const contact::Loads loads = start.problem->loads(start.p);
  out.guess = start.problem->profile(start.x, start.p);
  for (int j = 0; j < start.problem->chain().joint_count(); ++j) {
    const double at = start.problem->chain().arclength(start.x, loads, j);
    out.s.push_back(std::isinf(at) ? out.guess.end() : at);
  }
  // Twice the elements and more stages: the error falls by some 1e-4 at least.
  std::vector<ArcMesh> fine = out.meshes;
  for (ArcMesh& mesh : fine) mesh = {thinned(mesh.nodes, 2 * static_cast<int>(mesh.nodes.size() - 1)), 8};
  RodProblem problem(out.scene, true, out.topology, fine, keys);
  Vector x = chain::guess_state(problem.chain(), out.topology, problem.rod(), out.guess, out.s);
  if (problem.polish(x, start.p) < 0) throw equilibrium::NoEquilibrium("the reference did not converge");
  out.value = quantities_of(problem, x, start.p);
  out.unknowns = static_cast<int>(problem.size());
  if (out.flat && closed_form && out.topology.stretches.size() == 2) {
    const double length = half_length(scene);
    out.guess = chain::capstan_profile(out.scene.load.tension, scene.load.angle, length, 1.0);
    out.s = {0.0, rod::capstan::phi_star(out.scene.load.tension, scene.load.angle), length};
  }
  return out;
}

ArcSolver::ArcSolver(const Reference& reference, bool spatial, bool half, int elements, int stages)
    : reference_(reference), spatial_(spatial), half_(half) {
  std::vector<ArcMesh> meshes = reference.meshes;
  if (!spatial) {  // a planar line contact is a formula and takes no elements
    const std::vector<Stretch>& kinds = reference.topology.stretches;
    for (std::size_t i = 0; i < kinds.size(); ++i)
      if (kinds[i] == Stretch::line) meshes[i] = ArcMesh{};
  }
  meshes_ = ladder_meshes(meshes, half ? elements : std::max(1, elements / 2), stages);
}

bool ArcSolver::solve() {
  chain::Topology topology = reference_.topology;
  std::vector<ArcMesh> meshes = meshes_;
  std::vector<double> s = reference_.s;
  chain::Profile guess = reference_.guess;
  if (!half_) {
    guess = chain::unfolded(guess, chain::Symmetry::half_turn);
    unfold(topology, meshes, s);
  }
  problem_ = std::make_shared<RodProblem>(reference_.scene, spatial_, topology, meshes, keys);
  p_ = problem_->parameters();
  x_ = chain::guess_state(problem_->chain(), topology, problem_->rod(), guess, s);
  return problem_->polish(x_, p_) >= 0 &&
         std::isfinite(problem_->target(problem_->chain(), x_, problem_->loads(p_)));
}

Quantities ArcSolver::quantities() { return quantities_of(*problem_, x_, p_); }

std::optional<double> ArcSolver::transition(double near) {
  constexpr double away = 0.01;
  p_(0) = (1.0 + away) * near;
  if (problem_->polish(x_, p_) < 0) return std::nullopt;
  // The mode by inverse iteration.
  const Eigen::Index n = problem_->size();
  const Eigen::MatrixXd none(n, 0);
  problem_->factor(x_, p_, none, none, Eigen::MatrixXd(0, 0));
  Vector mode = Vector::Ones(n);
  for (int k = 0; k < 4; ++k) mode = problem_->solve(mode, Vector(0)).normalized();
  double before = p_(0), now = (1.0 - away) * near;
  double g_before = singularity(before, mode);
  for (int k = 0; k < 20; ++k) {
    const double g = singularity(now, mode), next = now - g * (now - before) / (g - g_before);
    if (!(std::abs(next / near - 1.0) < 0.5)) return std::nullopt;  // another zero, or none; NaN too
    if (std::abs(next - now) < 1e-14 * near) return next;
    before = now, now = next, g_before = g;
  }
  return now;
}

double ArcSolver::singularity(double tension, const Vector& mode) {
  constexpr double converged = 1e-13;
  p_(0) = tension;
  const Vector zero = Vector::Zero(mode.size()), one = Vector::Ones(1);
  for (int k = 0; k < 12; ++k) {
    const Vector f = problem_->residual(x_, p_);
    problem_->factor(x_, p_, mode, mode, Eigen::MatrixXd::Zero(1, 1));
    const Vector dx = problem_->solve(-f, Vector::Zero(1)).head(mode.size());
    x_ = problem_->retract(x_, dx);
    if (dx.lpNorm<Eigen::Infinity>() < converged * std::max(1.0, x_.lpNorm<Eigen::Infinity>())) break;
  }
  return problem_->solve(zero, one)(mode.size());
}

int ArcSolver::even_index(double tension) {
  p_(0) = tension;
  if (problem_->polish(x_, p_) < 0) return -1;
  const Eigen::MatrixXd none(problem_->size(), 0);
  problem_->factor(x_, p_, none, none, Eigen::MatrixXd(0, 0));
  return problem_->index(x_, p_);
}

}  // namespace windlass::precision
