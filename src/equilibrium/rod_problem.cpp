#include "windlass/equilibrium/rod_problem.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "dense_samples.hpp"
#include "end_events.hpp"
#include "flat_torsion.hpp"
#include "friction_couple.hpp"
#include "not_built.hpp"
#include "stretched_drag.hpp"
#include "windlass/chain/singular_matrix.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/start.hpp"
#include "windlass/obstacle/rim.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"
#include "windlass/rod/quaternion.hpp"
#include "windlass/scene/keys.hpp"
#include "windlass/scene/units.hpp"

namespace windlass::equilibrium {

namespace {

using contact::Loads;

/// Does the rod touch a plate's outer edge? It is as round as the rod is thick (obstacle::Rim), and built into joints.
bool touches_rim(const chain::RodKind& rod, const Topology& topology) {
  for (int j = 0; j < static_cast<int>(topology.on.size()); ++j)
    if (topology.obstacle(j) > 0 && obstacle::as_rim(rod.obstacles.pointer(topology.obstacle(j))))
      return true;
  return false;
}

/// Parameters that change loads only; all others rebuild the arcs.
double Loads::*field_of(const std::string& key, const scene::Scene& scene) {
  if (key == "load.tension") return &Loads::tension;
  if (key == "load.angle") return &Loads::angle;
  if (key == "load.thrust") return &Loads::thrust;
  if (key == "ends.shortening") return &Loads::shortening;
  if (key == "ends.twist") return &Loads::twist;
  if (key == "ends.guide_offset") return &Loads::guide_offset;
  if (key == "rod.radius") return scene.friction_has_couple() ? &Loads::arm : &Loads::radius;
  if (key == "cylinder.friction") return &Loads::friction;
  if (key == "rod.axial_compliance") return &Loads::compliance;
  if (key == "rod.weight_x") return &Loads::weight_x;
  if (key == "rod.weight_y") return &Loads::weight_y;
  if (key == "rod.weight_z") return &Loads::weight_z;
  return nullptr;
}

}  // namespace

Loads loads_of(const scene::Scene& scene) {
  Loads loads;
  loads.tension = scene.load.tension;
  loads.angle = scene.load.angle;
  loads.half_length = scene.rod.infinite() ? 0.0 : 0.5 * scene.rod.length;
  loads.thrust = scene.load.thrust.value_or(0.0);
  loads.shortening = scene.ends.shortening.value_or(0.0);
  loads.twist = scene.ends.twist;
  loads.radius = scene.strand_radius();
  loads.friction = scene.dragging_friction();
  loads.arm = scene.friction_arm();
  loads.compliance = scene.rod.compliance();
  loads.guide_offset = scene.ends.guide_offset;
  loads.guide_height = scene.plate ? scene.plate->height : 0.0;
  std::tie(loads.weight_x, loads.weight_y, loads.weight_z) = std::tuple_cat(scene.rod.weight);
  return loads;
}

namespace {

/// The end of a free rod holds its place on e_x: an end free of moment is a pin there.
chain::EndKind end_kind(const scene::Scene& scene, scene::EndKind kind) {
  if (kind == scene::EndKind::clamped) return chain::EndKind::clamped;
  if (kind == scene::EndKind::spin_held) return chain::EndKind::spin_held;
  return scene.has_cylinder ? chain::EndKind::moment_free : chain::EndKind::pinned;
}

}  // namespace

chain::RodKind rod_of(const scene::Scene& scene, bool spatial) {
  chain::RodKind rod;
  rod.spatial = spatial;
  rod.left = end_kind(scene, scene.ends.left_kind());
  rod.right = end_kind(scene, scene.ends.right_kind());
  rod.infinite = scene.rod.infinite();
  rod.guided = scene.ends.guided();
  rod.strut = !scene.has_cylinder;
  rod.obstacles = obstacle::obstacles_of(scene);
  if (!spatial && scene.plate)
    rod.obstacles = obstacle::Set({rod.obstacles.pointer(0)});  // lies in the plate
  if (spatial && scene.slides())
    rod.travel = scene.ends.travel == scene::Travel::free ? chain::Travel::free : chain::Travel::blocked;
  constexpr double twentieth = 0.05;  // a capstan's rod has a length of some 20 ρ
  if (rod.strut) rod.unit_length = twentieth * scene.rod.length;
  rod.under_thrust = !scene.ends.shortening.has_value();
  rod.knotted = rod.strut && scene.knot.tied();
  if (spatial && scene.has_cylinder) rod.pull_angle = scene.load.angle;
  rod.bending_stiffness = scene.rod.bending_stiffness;
  rod.stiffness = {scene.rod.bending_stiffness_2, scene.rod.bending_stiffness,
                   scene.rod.twist_ratio * scene.rod.bending_stiffness};
  rod.natural = {0.0, -scene.rod.natural_curvature, scene.rod.natural_twist};
  rod.extensible = scene.rod.extensible;
  for (std::size_t k = 0; k < 3; ++k) rod.weighs[k] = scene.rod.weight[k] != 0.0;
  return rod;
}

RodProblem::RodProblem(scene::Scene scene, bool spatial, Topology topology,
                       std::vector<chain::ArcMesh> meshes, std::vector<std::string> keys)
    : scene_(std::move(scene)),
      spatial_(spatial),
      topology_(std::move(topology)),
      meshes_(std::move(meshes)),
      keys_(std::move(keys)) {
  for (const std::string& key : keys_) fields_.push_back(field_of(key, scene_));
  rebuild();
}

bool RodProblem::varies(const char* key) const {
  return std::find(keys_.begin(), keys_.end(), key) != keys_.end();
}

bool RodProblem::coupled() const {
  return scene_.friction_arm() > 0.0 || (varies("rod.radius") && scene_.friction_has_couple());
}

bool RodProblem::flat(const Topology& topology) const { return !spatial_ || lies_in_plate(topology); }

bool RodProblem::asks_for(double Loads::*field) const {
  return base_.*field != 0.0 || std::find(fields_.begin(), fields_.end(), field) != fields_.end();
}

bool RodProblem::layered() const {
  return coupled() || (rod_.travel != chain::Travel::none && asks_for(&Loads::compliance));
}

const char* RodProblem::missing_on(const Topology& topology) const {
  if (coupled() && !(flat(topology) ? stays_in_plate(topology, scene_) : carries_couple(topology)))
    return "cylinder.friction_couple";
  for (int j = 0; j < static_cast<int>(topology.on.size()); ++j)
    if (obstacle::plate_at(scene_, topology.seat(j).flat) == 2 ||
        obstacle::plate_at(scene_, topology.seat(j).stop) == 2)
      return "plate.2.height";
  if (varies("rod.radius") && touches_rim(rod_, topology)) return "plate.outer_radius";
  if (rod_.travel != chain::Travel::none && !scene_.free_of_torsion() && strands_in_plate(topology))
    return "ends.kind";
  if (rod_.travel != chain::Travel::none && asks_for(&Loads::compliance) &&
      !carries_stretch(topology, rod_.travel))
    return "rod.extensible";
  return nullptr;
}

void RodProblem::rebuild() {
  rod_ = rod_of(scene_, spatial_);
  if (spatial_ && scene_.second_plate) rod_.obstacles = obstacle::obstacles_of(scene_, &second_plate_);
  if (varies("load.angle")) rod_.pull_angle = NAN;
  if (varies("rod.weight_x")) rod_.weighs[0] = true;
  if (varies("rod.weight_y")) rod_.weighs[1] = true;
  if (varies("rod.weight_z")) rod_.weighs[2] = true;
  base_ = loads_of(scene_);
  if (const char* key = missing_on(topology_)) throw NoEquilibrium(not_built(key));
  rod_.coupled = layered() && !flat(topology_);
  chain_ = chain::build_chain(rod_, topology_, meshes_);
  chain_->let_slide(slides_);
  finer_.reset();
  factored_x_.resize(0);
  estimated_x_.resize(0);
  counts_ = {};
}

Loads RodProblem::loads(const Vector& p) {
  bool changed = false;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    if (fields_[k]) continue;
    if (scene::get_parameter(scene_, keys_[k]) == p(k)) continue;
    scene::set_parameter(scene_, keys_[k], p(k));
    changed = true;
  }
  if (changed) {
    // Lengths live in the loads; only stiffness and natural strains are built into the arcs.
    const chain::RodKind rod = rod_of(scene_, spatial_);
    const bool arcs = rod.stiffness != rod_.stiffness || rod.natural != rod_.natural;
    base_ = loads_of(scene_);
    if (arcs) rebuild();
    if (scene_.second_plate) second_plate_.move_to(scene_.second_plate->height);
  }
  Loads loads = base_;
  for (std::size_t k = 0; k < keys_.size(); ++k)
    if (fields_[k]) loads.*fields_[k] = p(k);
  if (loads.arm != 0.0) {
    if (scene_.self_contact) loads.radius = loads.arm;
    if (flat(topology_)) loads.arm = 0.0;  // the torsion of a flat coil acts back on nothing
  }
  if (!scene_.slides()) loads.friction = 0.0;  // of a cylinder that stands it only enters F0
  if (scene_.has_cylinder && !(loads.tension > 0.0)) throw std::domain_error("the tension is not positive");
  return loads;
}

Vector RodProblem::parameters() const {
  Vector p(keys_.size());
  for (std::size_t k = 0; k < keys_.size(); ++k) p(k) = scene::get_parameter(scene_, keys_[k]);
  return p;
}

scene::Scene RodProblem::scene_at(const Vector& p) const {
  scene::Scene scene = scene_;
  for (std::size_t k = 0; k < keys_.size(); ++k) scene::set_parameter(scene, keys_[k], p(k));
  return scene;
}

double RodProblem::as_given(double p, std::size_t k) const { return scene::as_given(scene_, keys_[k], p); }

Vector RodProblem::residual(const Vector& x, const Vector& p) {
  factored_x_.resize(0);      // the index reads the arcs' gradients too, which now belong to x
  const Loads at = loads(p);  // may rebuild the chain
  closures_.clear();
  for (int i = 0; i < chain_->link_count(); ++i) {
    const double length = chain_->closure_row(i) >= 0 ? chain_->length(x, at, i) : 1.0;
    for (int k = 0; k < chain_->link(i).arc->forces() && length < 1.0; ++k)
      closures_.emplace_back(chain_->closure_row(i) + k, std::max(length, least_length));
  }
  return chain_->residual(x, at);
}

double RodProblem::residual_norm(const Vector& f) const {
  double norm = Problem::residual_norm(f);
  for (const auto& [row, length] : closures_) norm = std::max(norm, std::abs(f(row)) / (length * length));
  return norm;
}

void RodProblem::factor(const Vector& x, const Vector& p, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c,
                        const Eigen::MatrixXd& d) {
  factored_x_.resize(0);
  const Loads at = loads(p);  // may rebuild the chain
  chain_->factor(x, at, b, c, d);
  factored_x_ = x;
  factored_p_ = p;
}

std::optional<continuation::Unrestricted> RodProblem::unrestricted(const Vector& x, const Vector& p) {
  if (!topology_.half) return std::nullopt;
  try {
    const Started full = unfold(*this, x, p, 0);
    // As a branch of the full chain would: short tails hold the rod, and where held and free rods lose stability differs.
    full.problem->let_slide(slides_);
    return continuation::Unrestricted{full.problem, full.x};
  } catch (const NoEquilibrium&) {
    return std::nullopt;
  }
}

const chain::Chain& RodProblem::factored(const Vector& x, const Vector& p) {
  if (factored_x_.size() == 0 || factored_x_ != x || factored_p_ != p)
    factor(x, p, Eigen::MatrixXd(chain_->size(), 0), Eigen::MatrixXd(chain_->size(), 0),
           Eigen::MatrixXd(0, 0));
  return *chain_;
}

Vector RodProblem::parameter_derivative(const Vector& x, const Vector& p, Eigen::Index k) {
  const bool moves = keys_[static_cast<std::size_t>(k)] == "plate.2.height";  // what the chain stands beside
  if (fields_[k] || moves) return continuation::Problem::parameter_derivative(x, p, k);
  // Other values of this parameter build other arcs: the factorisation at hand must outlive them.
  RodProblem beside(scene_at(p), spatial_, topology_, meshes_, keys_);
  return beside.continuation::Problem::parameter_derivative(x, p, k);
}

double RodProblem::inner(const Vector& a, const Vector& b) const {
  // Contact places and arclengths by their sum, the shape by its mean: path length must not depend on the mesh.
  // Forces follow from the rest and would swamp it at high tension.
  const Eigen::Index dense = chain_->geometric_size(), rest = a.size() - chain_->dense_size();
  double sum = a.head(dense).dot(b.head(dense));
  if (rest > 0) sum += a.tail(rest).dot(b.tail(rest)) / static_cast<double>(rest);
  return sum;
}

Vector RodProblem::dual(const Vector& a) const {
  Vector row = Vector::Zero(a.size());
  const Eigen::Index dense = chain_->geometric_size(), rest = a.size() - chain_->dense_size();
  row.head(dense) = a.head(dense);
  if (rest > 0) row.tail(rest) = a.tail(rest) / static_cast<double>(rest);
  return row;
}

chain::Profile RodProblem::profile(const Vector& x, const Vector& p) {
  const Loads at = loads(p);  // may rebuild the chain
  chain::Profile out = chain::profile(*chain_, topology_, rod_, x, at);
  if (second_plate_.face) out.obstacles = obstacle::obstacles_of(scene_);  // which do not move
  centre_between_plates(out);
  return out;
}

std::vector<double> RodProblem::joint_places(const Vector& x, const Vector& p, const chain::Profile& shape) {
  std::vector<double> s;
  const Loads at = loads(p);
  for (int j = 0; j < chain_->joint_count(); ++j) {
    const double here = chain_->arclength(x, at, j);
    s.push_back(std::isinf(here) ? (here > 0.0 ? shape.end() : shape.begin()) : here);
  }
  return s;
}

continuation::CorrectorReport RodProblem::solve_from_guess(const continuation::Borders& borders,
                                                           continuation::Iterate& iterate, int most,
                                                           const SnesNewton::Part& part) {
  continuation::Options options;
  options.max_newton = most - 1;  // the last correction is not counted
  // Meshes and branches start here: from states as exact as rounding lets them be, so that nothing depends on the guess.
  options.newton_tolerance = 1e-12;
  try {
    const Loads at = loads(iterate.p);
    options.residual_scale = std::max({1.0, std::abs(at.tension), std::abs(at.thrust)});
  } catch (const std::domain_error& error) {
    continuation::CorrectorReport report;
    report.failure = error.what();
    return report;
  }
  return newton_.solve_from_guess(*this, borders, iterate, options, part);
}

int RodProblem::polish(Vector& x, const Vector& p, int most) {
  factored_x_.resize(0);
  if (size() == 0) return 0;          // one touch between infinite tails: nothing is unknown
  static constexpr double far = 0.6;  // [rad, ρ, EI/ρ²] beyond it the linearisation is worth nothing
  const double unit = rod_.unit_length *
                      rod_.unit_length;  // forces in EI/unit²: in a short rod's natural units they are large
  continuation::Borders none;
  none.psi = none.c = Eigen::MatrixXd(size(), 0);
  continuation::Iterate iterate{x, Vector::Zero(size()), p, Vector(0)};
  const continuation::CorrectorReport report =
      solve_from_guess(none, iterate, most, [&](const continuation::Iterate&, const Vector& dx) {
        const Eigen::Index geometric = chain_->geometric_size(), dense = chain_->dense_size();
        const double forces = unit * dx.segment(geometric, dense - geometric).lpNorm<Eigen::Infinity>();
        const double shape = std::max(dx.head(geometric).lpNorm<Eigen::Infinity>(),
                                      dx.tail(dx.size() - dense).lpNorm<Eigen::Infinity>());
        // The equations are linear in the forces: what is left out of them is of the order shape·(shape + forces). Forces of
        // touches that stand for lines, which answer to their places by 192B/h³, may be far off where nothing else is.
        const double left_out = chain_->couplings().empty() ? forces : std::sqrt(shape * forces);
        return far / std::max({far, shape, left_out});
      });
  if (report.converged) x = iterate.x;
  return report.converged ? report.iterations : -1;
}

double RodProblem::target(const chain::Chain& chain, const Vector& x, const Loads& at) const {
  if (!rod_.strut) return chain::total_contact_force(chain, topology_, rod_, x, at);
  return -chain.force(x, at, chain.link_count() - 1)(0);
}

std::shared_ptr<continuation::Problem> RodProblem::clone() const {
  auto copy = std::make_shared<RodProblem>(scene_, spatial_, topology_, meshes_, keys_);
  copy->remember(memory());
  // What is known of the last state, so that it is not found again.
  copy->estimated_x_ = estimated_x_, copy->estimated_p_ = estimated_p_;
  copy->nodal_error_ = nodal_error_;
  copy->counts_ = counts_;
  return copy;
}

namespace {

/// Sum over the obstacles of the squares of the least gaps.
double nearness(const chain::Profile& shape) {
  double sum = 0.0;
  for (int o = 0; o < shape.obstacles.size(); ++o) {
    double least = HUGE_VAL;
    for (const chain::Piece& piece : shape.pieces)
      for (Eigen::Index k = 0; k < piece.s.size(); k += piece.stride)
        least = std::min(least, shape.obstacles[o].gap(piece.r.col(k)));
    sum += least * least;
  }
  return sum;
}

}  // namespace

Vector RodProblem::fingerprint(const Vector& x, const Vector& p) {
  const Loads at = loads(p);
  const chain::Profile shape = profile(x, p);
  const double copies = topology_.half ? 2.0 : 1.0;  // of the whole rod, whichever chain it is on
  double energy = 0.0, contacts = 0.0;
  for (int i = 0; i < chain_->link_count(); ++i)
    energy += copies * chain_->link(i).arc->energy(chain_->place(x, at, i).point());
  for (const chain::Contact& contact : shape.contacts) contacts += contact.joint > 0 ? copies : 1.0;
  // The middle of the contacts, not of the rod: a long one may lie anywhere along itself.
  const bool has_middle = topology_.half || shape.contacts.empty();
  const double middle = has_middle ? 0.0 : 0.5 * (shape.contacts.front().s + shape.contacts.back().s);
  const double tilt = std::abs(std::asin(std::clamp(rod::directors(shape.at(middle).q)(2, 2), -1.0, 1.0)));
  const bool told_apart =
      rod_.strut && rod_.obstacles.size() > 0;  // mirror images, where the obstacles are no images
  Vector print(told_apart ? 6 : 5);
  print.head<5>() << target(*chain_, x, at), energy, extent_in_z(shape), tilt, contacts;
  if (told_apart) print(5) = nearness(shape);
  return print;
}

}  // namespace windlass::equilibrium
