#include "windlass/chain/topology.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "windlass/bvp/collocation_arc.hpp"
#include "windlass/contact/coupled_edge.hpp"
#include "windlass/contact/planar_joints.hpp"
#include "windlass/contact/plate_joints.hpp"
#include "windlass/contact/rim_joint.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/rod/closed_form_arcs.hpp"
#include "windlass/rod/coupled_line_arc.hpp"
#include "windlass/rod/dragged_line_arc.hpp"
#include "windlass/rod/extensible_density.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"
#include "windlass/rod/plate_line_arc.hpp"
#include "windlass/rod/weld_arc.hpp"

namespace windlass::chain {

using contact::Side;
namespace planar = contact::planar;
namespace spatial = contact::spatial;

namespace {

const char* word(Stretch stretch) {
  return stretch == Stretch::line ? "line" : stretch == Stretch::gap ? "gap" : "tail";
}

/// The section or touch that its symmetry maps to itself.
std::unique_ptr<Joint> symmetric_joint(const RodKind& rod, const Topology& t) {
  if (t.lies_flat(0))
    return std::make_unique<spatial::FlatSection>(rod.obstacles.pointer(t.obstacle(0)),
                                                  rod.obstacles.pointer(t.seat(0).flat));
  if (t.touches_flat(0))
    return std::make_unique<spatial::FlatTouch>(rod.obstacles.pointer(t.obstacle(0)),
                                                rod.obstacles.pointer(t.seat(0).flat));
  if (t.stretches.front() == Stretch::line && t.seat(0).stop >= 0)
    return std::make_unique<spatial::Stopped>(rod.obstacles.pointer(t.obstacle(0)),
                                              rod.obstacles.pointer(t.seat(0).stop), true);
  if (t.stretches.front() == Stretch::line) {
    if (rod.spatial)
      return std::make_unique<spatial::SurfaceSection>(rod.obstacles.pointer(t.obstacle(0)), t.symmetry);
    return std::make_unique<planar::SurfaceSection>();
  }
  if (t.mid_touch) {
    if (rod.spatial) return std::make_unique<spatial::Touch>(rod.obstacles.pointer(t.obstacle(0)));
    return std::make_unique<planar::Touch>();
  }
  if (rod.spatial) return std::make_unique<spatial::FreeSection>();
  return std::make_unique<planar::FreeSection>();
}

/// Is the tail a formula? An infinite one always is, a finite one where its mesh says so.
bool closed_form(const RodKind& rod, const ArcMesh& mesh) { return rod.infinite || mesh.stages == 0; }

/// Axis about which a clamped end is posed with a hinge, see spatial::FreeRodEnd: next but one to a line contact along the
/// clamp, of a rod whose arcs between bend about that axis only. States that leave the plane turn out of the clamp.
std::optional<Eigen::Vector3d> hinge_axis(const RodKind& rod, const Topology& t, Side arc_side) {
  const int last = static_cast<int>(t.stretches.size()) - 1, line = arc_side == Side::left ? last - 1 : 1;
  if (last < 1 || t.stretches[line] != Stretch::line || !rod.natural.isZero()) return std::nullopt;
  const obstacle::Surface& surface = rod.obstacles[t.obstacle(arc_side == Side::left ? last : 1)];
  if (surface.curvature() != 0.0 || !surface.endless_along_x()) return std::nullopt;
  return surface.chart(Eigen::Vector2d::Zero()).tangents.col(1);
}

std::unique_ptr<Joint> end_joint(const RodKind& rod, const Topology& t, const ArcMesh& tail, Side arc_side) {
  const EndKind kind = arc_side == Side::left ? rod.right : rod.left;
  if (rod.strut) {
    const bool clamped = kind == EndKind::clamped;
    return std::make_unique<spatial::FreeRodEnd>(arc_side, rod.under_thrust, !clamped,
                                                 clamped ? hinge_axis(rod, t, arc_side) : std::nullopt);
  }
  if (closed_form(rod, tail))
    return std::make_unique<planar::FarEnd>(rod.spatial ? 3 : 1, rod.spatial ? 3 : 2);
  const auto frame = [&]() -> std::unique_ptr<Joint> {
    if (kind == EndKind::spin_held) return std::make_unique<spatial::HeldEnd>();
    return std::make_unique<spatial::End>(arc_side, kind == EndKind::clamped);
  };
  const int joint = arc_side == Side::left ? static_cast<int>(t.stretches.size()) : 0;
  if (const int plate = t.end_touches(joint); plate > 0) {
    if (!rod.spatial || rod.guided) throw std::invalid_argument("no such end touches a plate");
    return std::make_unique<spatial::EndOnPlate>(arc_side, frame(), rod.obstacles.pointer(plate));
  }
  if (rod.guided) {
    if (!rod.spatial) throw std::invalid_argument("ends on sliders are computed with the Kirchhoff rod");
    return std::make_unique<spatial::GuidedEnd>(arc_side, frame());
  }
  if (rod.spatial) return frame();
  return std::make_unique<planar::End>(arc_side, kind == EndKind::clamped);
}

/// Joint between two stretches, one of which lies on a plate, too.
std::unique_ptr<Joint> plate_joint(const RodKind& rod, const Topology& t, int joint) {
  const Side flat = t.lies_flat(joint) ? Side::right : Side::left;
  const int line = flat == Side::right ? joint : joint - 1, other = flat == Side::right ? joint - 1 : joint;
  const obstacle::SurfacePointer &cylinder = rod.obstacles.pointer(t.obstacle(joint)),
                                 &plate = rod.obstacles.pointer(t.seat(line).flat);
  if (t.stretches[other] != Stretch::line)
    return std::make_unique<spatial::FlatEdge>(flat, rod.bending_stiffness, cylinder, plate);
  if (t.lies_flat(other) && t.seat(joint).strand == 0)
    throw std::invalid_argument("two line contacts cannot meet at a joint");
  if (t.lies_flat(other)) return std::make_unique<spatial::FlatPressed>(cylinder, plate);
  return std::make_unique<spatial::LiftOff>(flat, cylinder, plate);
}

/// Joint between two stretches, the first on the left, on an obstacle.
std::unique_ptr<Joint> contact_joint(const RodKind& rod, const Topology& t, int joint) {
  const Stretch left = t.stretches[joint - 1], right = t.stretches[joint];
  const Seat seat = t.seat(joint);
  const int obstacle = seat.obstacle;
  if (t.lies_flat(joint - 1) || t.lies_flat(joint)) return plate_joint(rod, t, joint);
  if (left == Stretch::line && right == Stretch::line && seat.strand != 0 && rod.spatial)
    return std::make_unique<spatial::Pressed>(rod.obstacles.pointer(obstacle));
  if (left == Stretch::line && right == Stretch::line && seat.stop >= 0 && rod.spatial)
    return std::make_unique<spatial::Stopped>(rod.obstacles.pointer(obstacle),
                                              rod.obstacles.pointer(seat.stop), seat.middle);
  if (left == Stretch::line && right == Stretch::line)
    throw std::invalid_argument("two line contacts cannot meet at a joint");
  if (left != Stretch::line && right != Stretch::line) {
    if (seat.strand != 0 && seat.flat >= 0)
      return std::make_unique<spatial::FlatStrand>(rod.obstacles.pointer(seat.flat));
    if (seat.strand != 0) return std::make_unique<spatial::Strand>();
    if (t.touches_flat(joint))
      return std::make_unique<spatial::FlatTouch>(rod.obstacles.pointer(obstacle),
                                                  rod.obstacles.pointer(seat.flat));
    if (auto rim = rod.spatial ? obstacle::as_rim(rod.obstacles.pointer(obstacle)) : nullptr)
      return std::make_unique<spatial::RimTouch>(std::move(rim));
    if (rod.spatial) return std::make_unique<spatial::Touch>(rod.obstacles.pointer(obstacle));
    return std::make_unique<planar::Touch>();
  }
  if (seat.strand != 0) throw std::invalid_argument("no strand presses on the edge of a line contact");
  const Side line = left == Stretch::line ? Side::left : Side::right;
  if (rod.coupled && rod.obstacles[obstacle].slips())
    return std::make_unique<spatial::CoupledEdge>(line, rod.bending_stiffness,
                                                  rod.obstacles.pointer(obstacle));
  if (rod.spatial)
    return std::make_unique<spatial::Edge>(line, rod.bending_stiffness, rod.obstacles.pointer(obstacle),
                                           rod.bending_stiffness * rod.stiffness.cwiseInverse(), rod.natural);
  return std::make_unique<planar::Edge>(line, rod.bending_stiffness * (1.0 - rod.natural_curvature()),
                                        rod.bending_stiffness);
}

std::unique_ptr<Arc> free_arc(const RodKind& rod, const ArcMesh& mesh) {
  const rod::PlanarDensity planar{rod.bending_stiffness, rod.natural_curvature()};
  const rod::KirchhoffDensity spatial{rod.stiffness, rod.natural};
  const auto meshed = [&](const auto& density) {
    return bvp::make_collocation_arc(density, mesh.nodes, mesh.stages);
  };
  if (rod.stretches())
    return rod.spatial ? meshed(rod::Extensible<rod::KirchhoffDensity>{spatial})
                       : meshed(rod::Extensible<rod::PlanarDensity>{planar});
  return rod.spatial ? meshed(spatial) : meshed(planar);
}

std::unique_ptr<Arc> make_arc(const RodKind& rod, Stretch stretch, int obstacle, const ArcMesh& mesh,
                              bool rightward) {
  if (stretch == Stretch::line) {
    if (!rod.spatial && rod.stretches())
      return std::make_unique<rod::ExtensiblePlanarLineArc>(rod.bending_stiffness, rod.natural_curvature());
    if (!rod.spatial)
      return std::make_unique<rod::PlanarLineArc>(rod.bending_stiffness, rod.natural_curvature());
    if (rod.coupled && rod.obstacles[obstacle].slips())
      return std::make_unique<rod::CoupledLineArc>(
          rod::SurfaceDensity{rod.bending_stiffness, rod.stiffness(2)}, mesh.nodes, mesh.stages);
    if (rod.travel != Travel::none && rod.obstacles[obstacle].slips())
      return std::make_unique<rod::DraggedLineArc>(
          rod::SurfaceDensity{rod.bending_stiffness, rod.stiffness(2)}, mesh.nodes, mesh.stages);
    return rod::make_line_arc(rod.obstacles[obstacle], rod.material(), mesh.nodes, mesh.stages);
  }
  if (stretch == Stretch::tail && closed_form(rod, mesh)) {
    if (!rod.infinite && (rod.holds_an_end() || !rod.isotropic_straight()))
      throw std::invalid_argument(
          "a finite tail in closed form needs a free end and an isotropic, straight rod");
    if (rod.stretches()) throw std::invalid_argument("no tail in closed form stretches");
    using End = rod::TailArc::End;
    return std::make_unique<rod::TailArc>(rod.spatial ? 3 : 2, rod.bending_stiffness, rightward,
                                          rod.infinite ? End::infinite : End::moment_free);
  }
  return free_arc(rod, mesh);
}

/// Parity, under the half-turn, of a turn of the whole rod that costs nothing: a flat rod on isolated touches turns about
/// the pulls if they lie along one line, or about their direction, the normal of its mid-point, if they are parallel. Under the
/// mirror it is the other one.
/// Ends that cannot spin turn with their rod only about one line.
std::optional<contact::Parity> neutral_turn(const RodKind& rod, const Topology& t) {
  if (rod.guided) return std::nullopt;
  const double half_turns = rod.pull_angle / M_PI, whole = std::round(half_turns);
  constexpr double nearly = 1e-5;  // there too the turn costs too little to be told from rounding
  if (!(std::abs(half_turns - whole) < nearly)) return std::nullopt;
  const std::vector<Stretch>& all = t.stretches;
  if (std::find(all.begin(), all.end(), Stretch::line) != all.end()) return std::nullopt;
  for (int j = 0; j < static_cast<int>(all.size()); ++j)
    if (t.touches_flat(j)) return std::nullopt;  // the plate holds it
  if (std::remainder(whole, 2.0) == 0.0)
    return rod.holds_an_end() && !rod.isotropic_straight() ? std::nullopt
                                                           : std::optional(contact::Parity::odd);
  return rod.holds_an_end() ? std::nullopt : std::optional(contact::Parity::even);
}

/// Does a contact of a strut with one of the obstacles, not with another strand, meet a condition?
template <class Condition>
bool any_on_obstacle(const RodKind& rod, const Topology& t, const Condition& condition) {
  if (!t.contact()) return false;
  const int count = static_cast<int>(t.stretches.size());
  for (int j = t.half && t.stretches.front() != Stretch::line && !t.mid_touch ? 1 : !t.half; j < count; ++j)
    if (t.seat(j).strand == 0 && condition(rod.obstacles[t.obstacle(j)])) return true;
  return false;
}

/// Does the rod touch an obstacle that does not let it move along the axis?
bool on_plate(const Topology& t) {
  const int last = static_cast<int>(t.stretches.size());
  if (t.end_touches(0) > 0 || t.end_touches(last) > 0) return true;
  for (int j = t.half ? 0 : 1; j < last; ++j)
    if (t.lies_flat(j) || t.touches_flat(j) || (t.seat(j).strand == 0 && t.pushed_by(j) > 0)) return true;
  return false;
}

/// Which rigid motions cost nothing and are held, and how; see Chain::Gauges.
Chain::Gauges gauges(const RodKind& rod, const Topology& t) {
  Chain::Gauges g;
  if (t.half) g.symmetry = t.symmetry;
  if (rod.strut) {
    const bool touched = any_on_obstacle(rod, t, [](const obstacle::Surface&) { return true; });
    const bool pinned = rod.left != EndKind::clamped && rod.right != EndKind::clamped;
    g.along =
        rod.under_thrust && !rod.weighs[0] &&
        !any_on_obstacle(rod, t, [](const obstacle::Surface& surface) { return !surface.endless_along_x(); });
    g.spin = pinned && rod.isotropic_straight();
    // A shape turns about the axis of its ends while each section turns back about its tangent, to keep clamped ends.
    const bool upright = !rod.weighs[1] && !rod.weighs[2];  // nothing pulls it to a side
    if (!touched && upright && (rod.isotropic_straight() || pinned))
      g.phase = rod.isotropic_straight() ? -1.0 : 0.0;
    g.knot = rod.knotted && !touched && !t.couplings().empty();
    return g;
  }
  g.height = floats(rod, t);
  g.travel = rod.spatial ? rod.travel : Travel::none;
  g.spin = rod.spatial && !rod.holds_an_end() && rod.isotropic_straight();
  g.slide = true;
  return g;
}

}  // namespace

bool stands_free(const RodKind& rod) {
  return rod.spatial && !rod.strut && rod.travel == Travel::none && !rod.guided;
}

bool floats(const RodKind& rod, const Topology& topology) { return stands_free(rod) && !on_plate(topology); }

bool Topology::contact() const { return mid_touch || stretches.size() > 1; }

Topology unfolded(const Topology& t) {
  if (!t.half) return t;
  const int skipped =
      t.mid_touch ? 0 : 1;  // the first stretch spans both halves, or the mid-point is a joint
  Topology whole{{t.stretches.rbegin(), t.stretches.rend()}, false, false};
  whole.stretches.insert(whole.stretches.end(), t.stretches.begin() + skipped, t.stretches.end());
  if (t.on.empty()) return whole;
  whole.on.assign(t.on.rbegin(), t.on.rend() - 1);
  for (int j = 1; j < static_cast<int>(whole.on.size());
       ++j) {  // of a line its beginning says that it lies flat
    const int link = static_cast<int>(t.stretches.size()) - 1 - j;
    if (t.stretches[link] == Stretch::line)
      whole.on[j].flat = t.seat(link).flat;
    else if (whole.stretches[j - 1] == Stretch::line)
      whole.on[j].flat = -1;
  }
  const Strands strands(t);
  const int shift = static_cast<int>(t.on.size());
  for (int j = 0; j < static_cast<int>(whole.on.size()); ++j) {
    Seat& seat = whole.on[j];
    if (seat.part > 0.0) seat.part = 1.0 - seat.part;
    seat.shares = -seat.shares;
    // A line with the own image is one of two strands now; another has an image of its own.
    const int line = strands.line_of(static_cast<int>(t.on.size()) - 1 - j);
    if (seat.line != 0 && line >= 0)
      seat.line =
          strands.lines()[line].own_image() ? -seat.line : seat.line + (seat.line > 0 ? shift : -shift);
  }
  whole.on.insert(whole.on.end(), t.on.begin() + skipped, t.on.end());
  // Each contact between strands has an image; the two of a mirrored pair change partners, the one with its own image has
  // none. Of joints from −L/2 the left half's come first.
  const int ids = static_cast<int>(whole.on.size());
  for (const Coupling& c : t.couplings()) {
    if (c.with_itself()) continue;
    const int strand = std::abs(t.on[c.first].strand);
    const auto right = [&](int joint) { return ids - static_cast<int>(t.on.size()) + joint; };
    const auto left = [&](int joint) { return ids - 1 - right(joint); };
    const int other = strand + ids;  // the image's number
    whole.on[right(c.first)].strand = strand;
    whole.on[c.mirrored ? left(c.second) : right(c.second)].strand = strand;
    whole.on[left(c.first)].strand = other;
    whole.on[c.mirrored ? right(c.second) : left(c.second)].strand = other;
  }
  return whole;
}

Topology folded(const Topology& whole, Symmetry symmetry) {
  if (whole.half) throw std::invalid_argument("a half chain is not folded again");
  const std::size_t count = whole.stretches.size(), first = count / 2;
  Topology out;
  out.symmetry = symmetry;
  out.mid_touch = count % 2 == 0;
  out.stretches.assign(whole.stretches.begin() + static_cast<std::ptrdiff_t>(first), whole.stretches.end());
  if (!whole.on.empty()) out.on.assign(whole.on.begin() + static_cast<std::ptrdiff_t>(first), whole.on.end());
  // A free section at the middle touches nothing.
  if (!out.on.empty() && !out.mid_touch && out.stretches.front() != Stretch::line) out.on.front() = {};
  return out;
}

std::vector<Coupling> Topology::couplings() const {
  std::vector<Coupling> out;
  const Strands strands(*this);
  for (int j = 0; j < static_cast<int>(on.size()); ++j) {
    const int other = strands.partner(j);
    if (other < j) continue;
    Coupling c{j, other, other == j || on[other].strand != on[j].strand};
    c.along = strands.line_of(j) >= 0;
    if (strands.laid(other)) std::swap(c.first, c.second);
    if (strands.laid(c.first)) {
      const auto [begin, end] = strands.between(c.first);
      c.begin = begin, c.end = end, c.part = on[c.first].part;
      c.placed = on[c.first].shares != 0;
    }
    out.push_back(c);
  }
  return out;
}

std::string Topology::text() const {
  const Topology whole = unfolded(*this);
  const std::vector<Stretch>& all = whole.stretches;
  const Strands strands(whole);
  const auto named = [&](const char* contact, std::size_t joint) {
    const int obstacle = contact == std::string_view("line") ? whole.obstacle(static_cast<int>(joint))
                                                             : whole.pushed_by(static_cast<int>(joint));
    return obstacle == 0 ? std::string(contact) : std::string(contact) + ":" + std::to_string(obstacle + 1);
  };
  std::string text;
  const auto end = [&](int joint) { return "end:" + std::to_string(whole.end_touches(joint) + 1); };
  if (whole.end_touches(0) > 0) text += end(0) + " ";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int link = static_cast<int>(i);
    if (i > 0 && strands.inside_line(link)) continue;  // of a line its ends are named
    const bool touch = i > 0 && (all[i] == Stretch::line) == (all[i - 1] == Stretch::line);
    const bool strand = i > 0 && whole.seat(static_cast<int>(i)).strand != 0;
    if (i > 0)
      text += !touch   ? " "
              : strand ? whole.touches_flat(link) ? " " + named("cross", i) + " " : " cross "
                       : " " + named("touch", i) + " ";
    if (const int line = strands.line_along(link); line >= 0)
      text += all[i] == Stretch::line && !strands.lines()[line].on_obstacles ? "lines on" : "lines";
    else
      text += all[i] == Stretch::line ? named(word(all[i]), i) : word(all[i]);
  }
  if (const int last = static_cast<int>(all.size()); whole.end_touches(last) > 0) text += " " + end(last);
  return text;
}

bool Topology::operator==(const Topology& other) const {
  if (stretches != other.stretches || half != other.half || mid_touch != other.mid_touch) return false;
  if (half && symmetry != other.symmetry) return false;
  for (int j = 0; j <= static_cast<int>(stretches.size()); ++j)
    if (seat(j).obstacle != other.seat(j).obstacle || seat(j).stop != other.seat(j).stop ||
        seat(j).middle != other.seat(j).middle || seat(j).flat != other.seat(j).flat)
      return false;
  return couplings() == other.couplings();
}

std::unique_ptr<Chain> build_chain(const RodKind& rod, const Topology& t,
                                   const std::vector<ArcMesh>& meshes) {
  if (rod.strut && !rod.spatial) throw std::invalid_argument("free rods are computed with the Kirchhoff rod");
  const std::vector<Stretch>& all = t.stretches;
  const int count = static_cast<int>(all.size());
  const double end = rod.infinite ? std::numeric_limits<double>::infinity() : 1.0;
  const auto mesh_of = [&](int i) { return meshes.empty() ? ArcMesh{} : meshes.at(i); };
  std::vector<std::unique_ptr<Joint>> joints;
  std::vector<double> fixed(count + 1, 0.0);
  std::vector<Link> links;
  const Strands strands(t);
  if (!t.half) fixed.front() = -end;
  fixed.back() = end;
  for (int i = 0; i <= count; ++i) {
    if (i == 0)
      joints.push_back(t.half ? symmetric_joint(rod, t) : end_joint(rod, t, mesh_of(0), Side::right));
    else
      joints.push_back(i == count ? end_joint(rod, t, mesh_of(count - 1), Side::left)
                                  : contact_joint(rod, t, i));
    if (i == count) break;
    const bool leftward = i == 0 && !t.half;
    Link link;
    link.arc = t.lies_flat(i) ? std::make_unique<rod::PlateLineArc>(rod.bending_stiffness, rod.stiffness(2))
                              : make_arc(rod, all[i], t.obstacle(i), mesh_of(i), !leftward);
    link.role = word(all[i]);
    if (strands.welded(i)) link.weld = true, link.arc = std::make_unique<rod::WeldArc>(*link.arc);
    const bool held = rod.strut || rod.guided || t.end_touches(leftward ? 0 : count) > 0;
    if (all[i] == Stretch::tail && !held) link.pull = leftward ? -1 : 1;
    links.push_back(std::move(link));
  }
  auto chain = std::make_unique<Chain>(std::move(joints), std::move(fixed), std::move(links), gauges(rod, t),
                                       t.couplings());
  if (auto parity = neutral_turn(rod, t)) {
    const bool other = t.half && !contact::reverses_height(t.symmetry);
    if (other) parity = *parity == contact::Parity::odd ? contact::Parity::even : contact::Parity::odd;
    chain->expect_neutral_turn(*parity);
  }
  return chain;
}

}  // namespace windlass::chain
