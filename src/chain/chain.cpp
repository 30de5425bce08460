#include "windlass/chain/chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "windlass/rod/quaternion.hpp"

namespace windlass::chain {

using contact::JointKind;
using contact::Side;
using contact::SmallVector;

namespace {

/// An infinite tail is sampled this many decay lengths √(B/T) out: exp(−40) is below rounding.
constexpr double tail_decay_lengths = 40.0;

/// Rests of a contact's arclength and of its places, the leading coordinates (Joint::places).
constexpr int rest_of_s = 0, rest_of_place = 1;

/// value + rest + change, rounded once; what is left becomes the new rest (Knuth's two-sum).
void add(double value, double rest, double change, double& new_value, double& new_rest) {
  const double sum = value + change, part = sum - value;
  const double error = (value - (sum - part)) + (change - part) + rest;
  new_value = sum + error;
  new_rest = error - (new_value - sum);
}

/// Increments of the coordinates that vary as increments of all of them.
const double* widened(const double* kept_step, const std::vector<int>& kept,
                      std::array<double, contact::max_coordinates>& all) {
  all.fill(0.0);
  for (std::size_t k = 0; k < kept.size(); ++k) all[kept[k]] = kept_step[k];
  return all.data();
}

}  // namespace

Chain::Chain(std::vector<std::unique_ptr<Joint>> joints, std::vector<double> fixed_s, std::vector<Link> links,
             const Gauges& gauges, std::vector<Coupling> couplings)
    : joints_(std::move(joints)),
      fixed_s_(std::move(fixed_s)),
      links_(std::move(links)),
      gauges_(gauges),
      couplings_(std::move(couplings)) {
  if (joints_.size() != links_.size() + 1 || fixed_s_.size() != joints_.size())
    throw std::invalid_argument("a chain has one joint more than arcs");
  couple();
  keep_coordinates();
  numbering_ = number(Purpose::equilibrium);
  for (int j = 0; j < joint_count(); ++j) {
    joint_at_.push_back(shares_place(j) ? joint_at_.back() : ambient_size_);
    if (!shares_place(j)) ambient_size_ += joints_[j]->ambient() + (numbering_.location[j] >= 0);
  }
  if (numbering_.slide >= 0) {
    slide_at_ = ambient_size_;
    ambient_size_ += 2;
  }
  for (std::size_t k = 0; k < couplings_.size(); ++k) strand_at_.push_back(ambient_size_++);
  for (int j = 0; j < joint_count(); ++j) {
    rest_at_.push_back(shares_place(j) ? rest_at_.back() : is_contact(j) ? ambient_size_ : -1);
    if (is_contact(j) && !shares_place(j)) ambient_size_ += rest_of_place + std::max(2, joints_[j]->places());
  }
  for (const Link& link : links_) {
    force_at_.push_back(ambient_size_);
    if (link.pull == 0) ambient_size_ += link.arc->forces();
  }
  for (const Link& link : links_) {
    interior_at_.push_back(ambient_size_);
    ambient_size_ += link.arc->interior_ambient();
  }
  dense_size_ = size_ = numbering_.size;
  geometric_size_ = numbering_.geometric;
  for (const Link& link : links_) {
    interior_row_.push_back(size_);
    size_ += link.arc->interior_tangent();
  }
  outside_ = out_of_plane();
  locals_.resize(links_.size());
  condensed_.resize(links_.size());
  gradients_.resize(links_.size());
}

void Chain::keep_coordinates() {
  for (int j = 0; j < joint_count(); ++j) {
    if (!on_obstacle(j)) continue;
    if (gauges_.travel != Travel::none && !joints_[j]->surface()->slips())
      continue;  // a plate lets the rod slide
    if (!in_contact_) first_contact_ = j;
    last_contact_ = j;
    in_contact_ = true;
  }
  if (!in_contact_) first_contact_ = 0, last_contact_ = joint_count() - 1;
  const int gauge_joint = half() ? 0 : first_contact_;
  for (int j = 0; j < joint_count(); ++j) {
    std::vector<int> all, varied;
    for (int k = 0; k < joints_[j]->tangent(); ++k) {
      const bool along = gauges_.along && k == 0 && j == gauge_joint;
      const std::vector<int> fixed = joints_[j]->fixed_in_variations();
      if (!along && std::find(fixed.begin(), fixed.end(), k) == fixed.end()) varied.push_back(k);
      const bool held = j == gauge_joint && ((gauges_.height && k == joints_[j]->height_coordinate()) ||
                                             (gauges_.spin && k == joints_[j]->spin_coordinate()) || along);
      if (!held) all.push_back(k);
    }
    kept_.push_back(shares_place(j) ? kept_.back() : all);
    varied_.push_back(shares_place(j) ? varied_.back() : varied);
  }
  if (!half()) return;
  const std::vector<int> even = joints_[0]->even(*gauges_.symmetry);
  const auto is_even = [&](int k) { return std::find(even.begin(), even.end(), k) != even.end(); };
  for (const int k : varied_[0]) (is_even(k) ? even_ : odd_).push_back(k);
  std::erase_if(kept_[0], [&](int k) { return !is_even(k); });
}

double Chain::slide_share(int joint) const {
  if (joint == last_contact_) return half() || first_contact_ == last_contact_ ? 1.0 : 0.5;
  return joint == first_contact_ && !half() ? 0.5 : 0.0;
}

Chain::Numbering Chain::number(Purpose purpose, bool together) const {
  const bool equilibrium = purpose == Purpose::equilibrium, asymmetric = !half() || purpose == Purpose::odd;
  Numbering n;
  // Does a joint's place vary, in a variation? Along a line strands touch at every place of the first, each where the second is
  // nearest: that one's moves.
  const auto stays = [&](int j) {
    const int k = coupling_of_[j];
    if (k < 0 || !couplings_[k].along) return false;
    return couplings_[k].with_itself() ? purpose == Purpose::odd : couplings_[k].first == j;
  };
  const auto varies = [&](int j) {
    return joints_[j]->kind() == JointKind::touch && (locates(j) || purpose == Purpose::odd) && !stays(j);
  };
  for (int j = 0; j < joint_count(); ++j) {
    if (shares_place(j)) {
      n.coordinate.push_back(n.coordinate.back());
      n.location.push_back(n.location.back());
      continue;
    }
    n.coordinate.push_back(n.size);
    n.size += static_cast<Eigen::Index>(kept(purpose, j).size());
    // In a variation a touch keeps its location as a direction of maximum; the edge of a line stays where it is, because
    // moving it costs nothing to second order, as do touches of a line between strands. The half-turn keeps a touch at s = 0, but in odd variations.
    bool located = equilibrium ? locates(j) : varies(j);
    for (int k = j + 1; !located && k < joint_count() && shares_place(k); ++k) located = varies(k);
    if (!located && together && stays(j)) {
      if (n.together < 0) n.together = n.size++, ++n.constraints;
      n.location.push_back(n.together);
      continue;
    }
    n.location.push_back(located ? n.size++ : -1);
    n.constraints += located;
  }
  n.geometric = n.size;
  for (const Link& link : links_) {
    n.force.push_back(link.pull == 0 ? n.size : -1);
    if (link.pull == 0) {
      n.size += link.arc->forces();
      n.constraints += link.arc->forces();
    }
  }
  for (const Coupling& c : couplings_) {
    // An odd variation moves a place and its image alike: to first order the two keep their distance.
    const bool kept = purpose == Purpose::odd && c.with_itself();
    n.strand.push_back(kept ? -1 : n.size++);
    n.constraints += !kept;
  }
  const auto hold = [&](bool gauge, Eigen::Index& row) {
    if (!gauge) return;
    row = n.size++;
    ++n.constraints;
  };
  const bool spins = this->spins(purpose) && !equilibrium;
  hold((gauges_.knot ? !equilibrium : gauges_.slide && in_contact_) && asymmetric, n.slide);
  hold(gauges_.spin && spins, n.spin);
  hold(gauges_.height && spins, n.height);
  hold(gauges_.phase && spins, n.phase);
  return n;
}

double Chain::arclength(const VectorXd& x, const Loads& loads, int joint) const {
  if (locates(joint)) return x(joint_at_[joint] + joints_[joint]->ambient());
  return std::isinf(fixed_s_[joint]) ? fixed_s_[joint] : fixed_s_[joint] * loads.half_length;
}

void Chain::set_arclength(VectorXd& x, int joint, double s) const {
  if (!locates(joint)) return;
  x(joint_at_[joint] + joints_[joint]->ambient()) = s;
  if (is_contact(joint)) x(rest_at_[joint] + rest_of_s) = 0.0;
}

double Chain::length(const VectorXd& x, const Loads& loads, int link) const {
  const auto rest = [&](int j) { return is_contact(j) ? x(rest_at_[j] + rest_of_s) : 0.0; };
  return arclength(x, loads, link + 1) - arclength(x, loads, link) + (rest(link + 1) - rest(link));
}

contact::SmallVector Chain::rise(const VectorXd& x, const Placed& placed, int link) const {
  if (!is_contact(link) || !is_contact(link + 1)) return placed.right.x - placed.left.x;
  if (const obstacle::Surface* left = joints_[link]->surface(), *right = joints_[link + 1]->surface();
      left != right) {
    // A strand's touch and an edge beside it may come as near as two contacts of one obstacle; those of two obstacles do not.
    if (left && right) return placed.right.x - placed.left.x;
    const auto place = [&](int j) {
      const double* w = coordinates(x, j);
      const double* rest = x.data() + rest_at_[j] + rest_of_place;
      if (!joints_[j]->surface())
        return obstacle::LongVector3(Eigen::Vector3d(w).cast<long double>() +
                                     Eigen::Vector3d(rest).cast<long double>());
      return joints_[j]->surface()->place(joints_[j]->on_surface(w).cast<long double>() +
                                          Eigen::Vector2d(rest).cast<long double>());
    };
    return Eigen::Vector3d((place(link + 1) - place(link)).cast<double>());
  }
  const auto difference = [&](int k) {
    return coordinates(x, link + 1)[k] - coordinates(x, link)[k] +
           (x(rest_at_[link + 1] + rest_of_place + k) - x(rest_at_[link] + rest_of_place + k));
  };
  const int places = joints_[link]->places();
  if (!joints_[link]->surface()) return Eigen::Vector3d(difference(0), difference(1), difference(2));
  const Eigen::Vector2d step(difference(0), places > 1 ? difference(1) : 0.0);
  const Eigen::Index size = placed.left.x.size();
  if (size == places) {  // on the unrolled surface
    contact::SmallVector unrolled(size);
    for (int k = 0; k < places; ++k) unrolled(k) = step(k);
    return unrolled;
  }
  const Joint& joint = *joints_[link];
  return joint.surface()->rise(joint.on_surface(coordinates(x, link)), step).head(size);
}

double Chain::touch_force(const VectorXd& x, const Loads& loads, int joint) const {
  if (coupling_of_[joint] >= 0) return strand_force(x, coupling_of_[joint]);
  const VectorXd after = force(x, loads, joint);
  VectorXd before = after;
  if (joint > 0)
    before = end_force(x, loads, joint - 1);
  else
    before = -contact::image(*gauges_.symmetry).head(after.size()).cwiseProduct(after);
  return (before - after).dot(joints_[joint]->chart(coordinates(x, joint)).normal.head(after.size()));
}

VectorXd Chain::force(const VectorXd& x, const Loads& loads, int link) const {
  const Link& l = links_[link];
  if (l.pull == 0) return x.segment(force_at_[link], l.arc->forces());
  VectorXd n = VectorXd::Zero(l.arc->forces());
  const double difference = travel() == Travel::blocked ? x(slide_at_ + 1) : 0.0;
  const double tension = loads.tension + l.pull * difference;
  n(0) = tension * std::cos(0.5 * loads.angle);
  n(1) = l.pull * tension * std::sin(0.5 * loads.angle);
  return n;
}

VectorXd Chain::end_force(const VectorXd& x, const Loads& loads, int link) const {
  VectorXd n = force(x, loads, link);
  if (loads.weighs()) n -= length(x, loads, link) * weight_on(loads, link);
  return n;
}

VectorXd Chain::weight_on(const Loads& loads, int link) const {
  const Eigen::Vector3d weight = loads.weight();
  const obstacle::Surface* surface = links_[link].role == "line" ? joints_[link]->surface() : nullptr;
  if (!surface) return weight.head(links_[link].arc->forces());
  return surface->chart(Eigen::Vector2d::Zero()).tangents.transpose() * weight;  // of a plane
}

VectorXd Chain::force_by_travel(const Loads& loads, int link) const {
  const Link& l = links_[link];
  VectorXd n = VectorXd::Zero(l.arc->forces());
  if (l.pull == 0 || travel() != Travel::blocked) return n;
  n(0) = l.pull * std::cos(0.5 * loads.angle);
  n(1) = std::sin(0.5 * loads.angle);
  return n;
}

Chain::Placed Chain::place(const VectorXd& x, const Loads& loads, int link) const {
  Placed p;
  p.left = attachment(Purpose::equilibrium, x, loads, link, Side::right);
  p.right = attachment(Purpose::equilibrium, x, loads, link + 1, Side::left);
  p.n = force(x, loads, link);
  p.interior = interior(x, link);
  p.length = length(x, loads, link);
  p.friction = loads.friction;
  p.arm = loads.arm;
  p.compliance = loads.compliance;
  if (loads.weighs()) p.weight = weight_on(loads, link);
  if (travel() == Travel::free) p.travel = x(slide_at_ + 1);
  if (std::isinf(p.length)) p.length = tail_decay_lengths / std::sqrt(p.n.norm());
  // Between contacts the equations hold, analytically, for lengths past zero too, so that the event can be located
  // from both sides; only zero itself is singular and is stepped over. A tail must exist.
  constexpr double smallest = 1e-13;
  if (links_[link].pull != 0 && !(p.length > 0.0)) throw std::domain_error("a tail's length is not positive");
  if (std::abs(p.length) < smallest) p.length = std::copysign(smallest, p.length);
  return p;
}

VectorXd Chain::retract(const VectorXd& x, const VectorXd& dx) const {
  VectorXd out = x;
  std::array<double, contact::max_coordinates> step;
  for (int j = 0; j < joint_count(); ++j) {
    const Joint& joint = *joints_[j];
    joint.retract(coordinates(x, j), widened(dx.data() + numbering_.coordinate[j], kept_[j], step),
                  coordinates(out, j));
    const double ds = numbering_.location[j] >= 0 ? dx(numbering_.location[j]) : 0.0;
    if (is_contact(j))
      move_contact(x, j, step.data(), ds, out);
    else if (numbering_.location[j] >= 0)
      out(joint_at_[j] + joint.ambient()) += ds;
  }
  if (slide_at_ >= 0) out(slide_at_ + 1) += dx(numbering_.slide);
  for (std::size_t k = 0; k < couplings_.size(); ++k) out(strand_at_[k]) += dx(numbering_.strand[k]);
  if (slides_) {
    out(slide_at_) = 0.0;
    for (int j = first_contact_; j <= last_contact_; ++j)
      out(slide_at_) += slide_share(j) * out(joint_at_[j] + joints_[j]->ambient());
  }
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    if (links_[i].pull == 0)
      out.segment(force_at_[i], arc.forces()) += dx.segment(numbering_.force[i], arc.forces());
    if (arc.ambient() == 4) {
      for (int k = 0; k < arc.interior_nodes(); ++k)
        out.segment<4>(interior_at_[i] + 4 * k) =
            rod::retract(x.segment<4>(interior_at_[i] + 4 * k), dx.segment<3>(interior_row_[i] + 3 * k));
    } else {
      out.segment(interior_at_[i], arc.interior_ambient()) +=
          dx.segment(interior_row_[i], arc.interior_tangent());
    }
  }
  return out;
}

void Chain::move_contact(const VectorXd& x, int joint, const double* step, double ds, VectorXd& out) const {
  const Eigen::Index at = joint_at_[joint], rest = rest_at_[joint];
  const auto move = [&](Eigen::Index place, int k, double change) {
    add(x(place), x(rest + k), change, out(place), out(rest + k));
  };
  for (int k = 0; k < joints_[joint]->places(); ++k) move(at + k, rest_of_place + k, step[k]);
  if (locates(joint)) move(at + joints_[joint]->ambient(), rest_of_s, ds);
}

contact::Joint::Location Chain::location(const VectorXd& x, int j) const {
  // The neighbouring arcs' gradients at this joint: end of the arc before, start of the arc after.
  SmallVector left, right;
  if (j > 0) {
    const int d = links_[j - 1].arc->tangent();
    left = gradients_[j - 1].segment(d, d);
  }
  if (j < link_count()) right = gradients_[j].head(links_[j].arc->tangent());
  return joints_[j]->location(coordinates(x, j), left, right);
}

double Chain::nodal_norm(const VectorXd& dx) const {
  double largest = dx.head(geometric_size_).lpNorm<Eigen::Infinity>();
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    const int d = arc.node_tangent();
    for (int e = 1; e < arc.elements(); ++e)
      largest = std::max(largest,
                         dx.segment(interior_row_[i] + (e * arc.stages() - 1) * d, d).cwiseAbs().maxCoeff());
  }
  return largest;
}

VectorXd transfer_state(const Chain& from, const Chain& to, const VectorXd& x, const Loads& loads) {
  VectorXd out = VectorXd::Zero(to.ambient_size());
  const Eigen::Index dense = from.link_count() > 0 ? from.interior(x, 0) - x.data() : x.size();
  out.head(dense) = x.head(dense);
  for (int i = 0; i < from.link_count(); ++i) {
    if (to.link(i).arc->interior_nodes() == 0) continue;
    const VectorXd interior = from.link(i).arc->transfer(from.place(x, loads, i).point(), *to.link(i).arc);
    Eigen::Map<VectorXd>(to.interior(out, i), interior.size()) = interior;
  }
  return out;
}

}  // namespace windlass::chain
