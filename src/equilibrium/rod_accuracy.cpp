// How accurate a rod's state is, and the mesh that makes it so.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "layer_mesh.hpp"
#include "windlass/equilibrium/contact_events.hpp"
#include "windlass/equilibrium/rod_problem.hpp"

namespace windlass::equilibrium {

using contact::Loads;

namespace {

/// Error levels: the estimate is doubled, so that it bounds the change under refinement where orders compete, and
/// never claims less than rounding leaves.
constexpr double safety = 2.0, rounding = 2e-14;

/// Every stored point must pass `verify`, whose bounds on frames, moments and positions are 1e-9: half of that, since what is
/// left on several arcs adds up.
constexpr double certificate_level = 5e-10;

/// A tenth or a thirtieth is asked of a mesh: one that leaves more than this part of an error has met rounding, which
/// changes by chance.
constexpr double towards = 0.3;

/// Growth lengths of an element: the certificate integrates from node to node, and errors grow by exp(3) at most. Elements
/// of many (straight tails at high tension) are left whole; there it measures the distance to the nearest true trajectory
/// instead.
constexpr double longest = 3.0, whole = 25.0;

/// Growth lengths from the contact to an element that is left whole. There the rod is bent by exp(−16) = 1e-7 at most, of which the
/// element, that does not see it, makes an error of 5e-3; meshes begin it where that is 2e-9, so that they last.
constexpr double bent = 16.0, straight = 20.0;

/// One element is enough for so short an arc [unit length], and rounds least: moments follow from differences of frames,
/// divided by the element's length. Taken away from one that has shrunk to a fifth of it.
constexpr double short_arc = 0.05, shrunk_to = 0.01;

double growth_over(const chain::Chain::Placed& arc, double bending_stiffness) {
  return arc.length * std::sqrt(arc.n.norm() / bending_stiffness);
}

/// Place in a mesh of an element left whole that is too near the tail's contact; 0: there is none. Nodes are counted from the contact.
std::size_t whole_but_bent(const std::vector<double>& nodes, double growth) {
  for (std::size_t k = 1; k < nodes.size(); ++k)
    if (growth * (nodes[k] - nodes[k - 1]) >= whole && growth * nodes[k - 1] < bent) return k;
  return 0;
}

std::vector<double> reversed(std::vector<double> nodes) {
  std::reverse(nodes.begin(), nodes.end());
  for (double& node : nodes) node = 1.0 - node;
  return nodes;
}

/// A tail's mesh, finer up to where it is straight.
std::vector<double> fine_while_bent(std::vector<double> nodes, double growth, bool towards_contact) {
  if (towards_contact) {
    std::vector<double> turned = reversed(nodes);
    return whole_but_bent(turned, growth) > 0 ? reversed(fine_while_bent(turned, growth, false)) : nodes;
  }
  const auto k = static_cast<std::ptrdiff_t>(whole_but_bent(nodes, growth));
  if (k == 0) return nodes;
  nodes.insert(nodes.begin() + k, straight / growth);
  std::vector<double> out = chain::split_mesh({nodes.begin(), nodes.begin() + k + 1}, growth, longest);
  const std::vector<double> rest =
      chain::split_mesh({nodes.begin() + k, nodes.end()}, growth, longest, whole);
  out.insert(out.end(), rest.begin() + 1, rest.end());
  return out;
}

/// Have layers in which friction's moment presses grown out of their elements?
bool layers_outgrown(const chain::Chain& chain, const std::vector<chain::ArcMesh>& meshes, const Vector& x,
                     const Loads& at) {
  for (int i = 0; i < chain.link_count(); ++i)
    if (layers_outgrown(meshes[i].nodes, layers_of(chain, x, at, i), meshes[i].stages)) return true;
  return false;
}

/// Has a contact grown, by a fifth, out of the elements it was given?
bool outgrown(const chain::Chain& chain, const std::vector<chain::ArcMesh>& meshes, const Vector& x,
              const Loads& at, double bending_stiffness) {
  if (layers_outgrown(chain, meshes, x, at)) return true;
  for (int i = 0; i < chain.link_count(); ++i) {
    if (chain.link(i).arc->elements() == 0) continue;
    const double growth = growth_over(chain.place(x, at, i), bending_stiffness);
    const std::vector<double>& nodes = meshes[i].nodes;
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const double size = growth * (nodes[k] - nodes[k - 1]);
      if (size > 1.2 * longest && size < whole) return true;
    }
    const bool towards_contact = i == 0;
    if (chain.link(i).role == "tail" && whole_but_bent(towards_contact ? reversed(nodes) : nodes, growth) > 0)
      return true;
  }
  return false;
}

/// Has an arc become too short for the elements it was given?
bool shrunk(const chain::Chain& chain, const Vector& x, const Loads& at, double unit_length) {
  for (int i = 0; i < chain.link_count(); ++i)
    if (chain.link(i).arc->elements() > 1 && chain.place(x, at, i).length < shrunk_to * unit_length)
      return true;
  return false;
}

/// What rounding leaves of the target of a rod that stretches, relative: the tension is EA times a strain, which is known to some
/// digits of 1.
double stretched_rounding(const Loads& at, double target) {
  return rounding * std::max(1.0, 1.0 / std::abs(at.compliance * target));
}

/// Order of the arcs on a mesh, at their ends; a chain of formulas only never asks.
double order_of(const std::vector<chain::ArcMesh>& meshes) {
  int stages = 1;
  for (const chain::ArcMesh& mesh : meshes) stages = std::max(stages, mesh.stages);
  return 2.0 * stages;
}

}  // namespace

double RodProblem::error_estimate(const Vector& x, const Vector& p) {
  const Loads at = loads(p);  // may rebuild the chain
  const bool asked_before = estimated_p_.size() == p.size() && estimated_x_.size() == x.size();
  if (asked_before && estimated_x_ == x && estimated_p_ == p) return last_error_;
  estimated_x_ = x;
  estimated_p_ = p;
  bool meshed = false;
  for (int i = 0; i < chain_->link_count(); ++i) meshed |= chain_->link(i).arc->elements() > 0;
  nodal_error_ = 0.0;
  if (!meshed) return last_error_ = rounding;
  if (!finer_) {
    std::vector<chain::ArcMesh> finer = meshes_;
    for (auto& mesh : finer) mesh.stages += mesh.stages > 0;  // formulas stay
    finer_ = chain::build_chain(rod_, topology_, finer);
    finer_->let_slide(slides_);
  }
  Vector fine = chain::transfer_state(*chain_, *finer_, x, at);
  const double before = target(*chain_, x, at);
  const Eigen::MatrixXd none(finer_->size(), 0);
  finer_->factor(fine, at, none, none, Eigen::MatrixXd(0, 0));
  const Vector dx = finer_->solve(-finer_->residual(fine, at), Vector(0));
  nodal_error_ = finer_->nodal_norm(dx);
  fine = finer_->retract(fine, dx);
  const double after = target(*finer_, fine, at), scale = std::max(std::abs(after), 1e-3);
  return last_error_ = safety * std::abs(after - before) / scale + rounding;
}

std::vector<chain::ArcMesh> RodProblem::new_meshes(const Vector& x, const Loads& at, double growth) const {
  std::vector<chain::ArcMesh> out = meshes_;
  double total = 0.0;
  int elements = 0;
  std::vector<std::vector<double>> weights(meshes_.size());
  for (int i = 0; i < chain_->link_count(); ++i) {
    const bvp::Arc& arc = *chain_->link(i).arc;
    if (arc.elements() == 0) continue;
    const chain::Chain::Placed placed = chain_->place(x, at, i);
    // Each element's share of the error density; the floor keeps smooth stretches meshed. It goes with the length, so that
    // an arc which shrinks sheds its elements: in a short one each is a place more where rounding of the frames bends it.
    constexpr double smooth = 0.03;  // a unit of length
    const std::vector<double> resolution = arc.resolution(placed.point());
    for (std::size_t e = 0; e < resolution.size(); ++e) {
      const double length =
          placed.length * (meshes_[i].nodes[e + 1] - meshes_[i].nodes[e]) / rod_.unit_length;
      weights[i].push_back(std::pow(resolution[e], 1.0 / arc.stages()) + smooth * std::min(1.0, length));
      total += weights[i].back();
    }
    elements +=
        arc.elements() - elements_of_layers(meshes_[i].nodes, layers_of(*chain_, x, at, i), arc.stages());
  }
  const double goal = std::clamp(growth, 0.4, 2.5) * elements;
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (weights[i].empty()) continue;
    double sum = 0.0;
    for (double w : weights[i]) sum += w;
    const double length = chain_->place(x, at, static_cast<int>(i)).length / rod_.unit_length;
    const int count = std::clamp(static_cast<int>(std::ceil(goal * sum / total)), length < short_arc ? 1 : 2,
                                 length < shrunk_to ? 1 : 400);
    const std::vector<double>& old = meshes_[i].nodes;
    std::vector<double> mesh{0.0};
    std::size_t e = 0;
    double before = 0.0;
    for (int k = 1; k < count; ++k) {
      const double want = sum * k / count;
      while (e + 1 < weights[i].size() && before + weights[i][e] < want) before += weights[i][e++];
      mesh.push_back(old[e] + (old[e + 1] - old[e]) * (want - before) / weights[i][e]);
    }
    mesh.push_back(1.0);
    const chain::Chain::Placed placed = chain_->place(x, at, static_cast<int>(i));
    const double grown = growth_over(placed, rod_.bending_stiffness);
    mesh = chain::split_mesh(mesh, grown, longest, whole);
    if (topology_.stretches[i] == chain::Stretch::tail) mesh = fine_while_bent(mesh, grown, i == 0);
    out[i].nodes = fine_in_layers(mesh, layers_of(*chain_, x, at, static_cast<int>(i)), meshes_[i].stages);
  }
  return out;
}

double RodProblem::excess(const Vector& x, const Vector& p) {
  // In long helices estimates below this are rounding's: no mesh brings less, and ever finer ones bring more.
  constexpr double attainable = 2e-12;
  const double goal = std::max(scene_.model.tolerance, attainable);
  const auto beyond = [](double error, double most) { return error > most ? error : 0.0; };
  const double error = beyond(error_estimate(x, p), 3.0 * error_floor_);
  // What a mesh adds to rounding is forgiven as long as certificates bear both.
  const double forgiven =
      nodal_floor_ < bearable() ? std::min(3.0 * nodal_floor_, bearable()) : 3.0 * nodal_floor_;
  return std::max(error / goal, beyond(nodal_error_, forgiven) / nodal_goal());
}

void RodProblem::note_rounding(double error_before) {
  constexpr double plausible = 1e-10;
  if (last_error_ > towards * error_before && last_error_ < plausible) error_floor_ = last_error_;
}

double RodProblem::nodal_goal() const {
  // A strut is as long as its unit, so its strains, and with them the moments, are some ten times its rotations.
  const double share = rod_.strut ? 0.03 : 0.3;
  // Moments are strains times stiffnesses, the bending stiffness being 1.
  const double stiffest = std::max(1.0, rod_.stiffness.maxCoeff() / rod_.bending_stiffness);
  // The tolerance is the target's: frames beside short arcs round to no better than certificates ask.
  return share * certificate_level / stiffest;
}

double RodProblem::bearable() const { return 2.0 * nodal_goal(); }

Vector RodProblem::carried_to(std::vector<chain::ArcMesh> meshes, const Vector& x, const Vector& p) {
  meshes_ = std::move(meshes);
  const std::unique_ptr<chain::Chain> old = std::move(chain_);
  rebuild();
  Vector fresh = chain::transfer_state(*old, *chain_, x, loads(p));
  if (polish(fresh, p) < 0) throw NoEquilibrium("Newton failed after the mesh was adapted");
  return fresh;
}

Vector RodProblem::refine(Vector x, const Vector& p, int rounds) {
  if (layers_outgrown(*chain_, meshes_, x, loads(p)))  // first: they would have all of the mesh finer
    x = carried_to(with_layers(*chain_, meshes_, x, loads(p)), x, p);
  bool refined = false;  // with less error asked for, not only distributed evenly
  for (int k = 0; k < rounds; ++k) {
    settle(x, p);
    const double before = nodal_error_, error_before = last_error_;
    error_estimate(x, p);
    if (k > 1 && nodal_error_ > towards * before) nodal_floor_ = nodal_error_;
    if (refined) note_rounding(error_before);
    const double too_large = excess(x, p);
    refined = too_large > 1.0;
    if (too_large <= 1.0 && k > 0) return x;  // the first mesh is a guess and is always equidistributed
    x = carried_to(new_meshes(x, loads(p), std::pow(10.0 * too_large, 1.0 / order_of(meshes_))), x, p);
  }
  settle(x, p);
  error_estimate(x, p);
  return x;
}

std::optional<Vector> RodProblem::moved_to(std::vector<chain::ArcMesh> meshes, const Vector& x,
                                           const Vector& p, bool within) {
  const std::vector<chain::ArcMesh> old_meshes = std::exchange(meshes_, std::move(meshes));
  const double old_nodal = nodal_error_;
  const auto old_errors = std::tuple(last_error_, nodal_error_, estimated_x_, estimated_p_);
  const std::unique_ptr<chain::Chain> old = std::move(chain_);
  rebuild();
  Vector fresh = chain::transfer_state(*old, *chain_, x, loads(p));
  if (polish(fresh, p) >= 0) {
    const double too_large = excess(fresh, p);
    // What rounding is forgiven no coarser mesh may add, but by chance.
    constexpr double by_chance = 3.0;
    if (within && too_large <= 1.0 && nodal_error_ <= std::max(nodal_goal(), by_chance * old_nodal))
      return fresh;
    constexpr double by_mesh = 0.05;
    const double old_error = std::get<0>(old_errors);
    const bool closer = old_error > scene_.model.tolerance && last_error_ < towards * old_error;
    const bool saves = old_nodal > bearable() && nodal_error_ <= bearable();  // the certificate
    if (!within && (closer || saves || nodal_error_ < by_mesh * old_nodal)) return fresh;
    if (!within) {  // rounding: no mesh helps
      nodal_floor_ = std::max(nodal_error_, old_nodal);
      note_rounding(old_error);
    }
  }
  meshes_ = old_meshes;  // keep what works
  rebuild();
  std::tie(last_error_, nodal_error_, estimated_x_, estimated_p_) = old_errors;
  return std::nullopt;
}

std::optional<Vector> RodProblem::adapt(const Vector& x, const Vector& p) {
  std::optional<Vector> moved = laid_where_needed(x, p);
  if (auto adapted = adapt_mesh(moved.value_or(x), p)) moved = std::move(adapted);
  return moved;
}

std::optional<Vector> RodProblem::adapt_mesh(const Vector& x, const Vector& p) {
  std::optional<Vector> moved = remeshed_where_needed(x, p);
  // Other equations for the same state: its tangent is another, too.
  if (choose_sliding(moved.value_or(x), p) && !moved) moved = x;
  if (moved) settle(*moved, p);
  return moved;
}

std::optional<Vector> RodProblem::carried_over(const continuation::Problem& before, const Vector& x,
                                               const Vector& p) {
  const chain::Chain& old = *static_cast<const RodProblem&>(before).chain_;
  if (old.joint_count() != chain_->joint_count()) return std::nullopt;  // touches laid anew
  return chain::transfer_state(old, *chain_, x, loads(p));
}

std::optional<Vector> RodProblem::remeshed_where_needed(const Vector& x, const Vector& p) {
  // A mesh far finer than needed costs as much as one too coarse: shed when a quarter of it or more is superfluous.
  constexpr double superfluous = 1e-3, worthwhile = 0.75;
  // Near an event rounding may be large, and soon is not: forgotten from point to point, and at once where an estimate is
  // smaller by more than chance.
  constexpr double forgotten = 0.9, by_chance = 10.0;
  const double error = error_estimate(x, p);
  nodal_floor_ = std::min(forgotten * nodal_floor_, by_chance * nodal_error_);
  error_floor_ = std::min(forgotten * error_floor_, by_chance * error);
  const double too_large = excess(x, p);
  // A straight strut is exact on any mesh, which says nothing about its modes: their loads need the mesh it has.
  const Loads at = loads(p);
  const double noise = at.compliance == 0.0 ? rounding : stretched_rounding(at, target(*chain_, x, at));
  const bool coarsen = too_large < superfluous && last_error_ > 1.5 * noise;
  if (too_large <= 1.0 &&
      (outgrown(*chain_, meshes_, x, at, rod_.bending_stiffness) || shrunk(*chain_, x, at, rod_.unit_length)))
    return moved_to(new_meshes(x, at, 1.0), x, p, true);
  if (too_large <= 1.0 && !coarsen) return std::nullopt;
  const double order = order_of(meshes_);
  const auto meshes =
      new_meshes(x, loads(p), std::pow(30.0 * std::max(too_large, 1e-3 * superfluous), 1.0 / order));
  const auto elements = [](const std::vector<chain::ArcMesh>& arcs) {
    std::size_t sum = 0;
    for (const chain::ArcMesh& arc : arcs) sum += arc.nodes.size() - 1;
    return static_cast<double>(sum);
  };
  if (coarsen && elements(meshes) > worthwhile * elements(meshes_)) return std::nullopt;
  return moved_to(meshes, x, p, coarsen);
}

}  // namespace windlass::equilibrium
