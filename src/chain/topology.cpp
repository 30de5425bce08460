#include "windlass/chain/topology.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "windlass/contact/planar_joints.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/rod/closed_form_arcs.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"
#include "windlass/rod/surface_density.hpp"

namespace windlass::chain {

using contact::Side;
namespace planar = contact::planar;
namespace spatial = contact::spatial;

namespace {

const char* word(Stretch stretch) {
  return stretch == Stretch::line ? "line" : stretch == Stretch::gap ? "gap" : "tail";
}

std::unique_ptr<Joint> first_joint(const RodKind& rod, const Topology& t) {
  const bool held = rod.clamped || rod.strut || !rod.isotropic_straight();
  if (t.right.front() == Stretch::line) {
    if (rod.spatial) return std::make_unique<spatial::MidLine>(held);
    return std::make_unique<planar::MidLine>();
  }
  if (t.mid_touch) {
    if (rod.spatial) return std::make_unique<spatial::MidTouch>(held);
    return std::make_unique<planar::MidTouch>();
  }
  if (!rod.spatial) return std::make_unique<planar::MidGap>();
  // A strut's ends are held in space: z is no rigid motion, nor is x unless both ends are free to move under the thrust.
  return std::make_unique<spatial::MidGap>(spatial::MidGap::OddFreedom{
      rod.strut && !rod.under_thrust, rod.strut, held, rod.strut && rod.isotropic_straight()});
}

std::unique_ptr<Joint> marker(const RodKind& rod, const Topology& t) {
  const bool held = rod.clamped || rod.strut || !rod.isotropic_straight();
  if (t.mid_touch) {
    if (rod.spatial) return std::make_unique<spatial::MarkerTouch>(held);
    return std::make_unique<planar::MarkerTouch>();
  }
  if (t.right.front() == Stretch::line) {
    if (rod.spatial) return std::make_unique<spatial::MarkerLine>(held);
    return std::make_unique<planar::MidLine>();
  }
  if (rod.spatial) return std::make_unique<spatial::MarkerGap>(held, rod.strut && !rod.under_thrust);
  return std::make_unique<planar::MarkerGap>();
}

/// Is the tail a formula? An infinite one always is, a finite one where its mesh says so.
bool closed_form(const RodKind& rod, const ArcMesh& mesh) { return rod.infinite || mesh.stages == 0; }

std::unique_ptr<Joint> end_joint(const RodKind& rod, const ArcMesh& tail, Side arc_side) {
  if (rod.strut) return std::make_unique<spatial::StrutEnd>(arc_side, rod.under_thrust);
  if (closed_form(rod, tail))
    return std::make_unique<planar::FarEnd>(rod.spatial ? 3 : 1, rod.spatial ? 3 : 2);
  if (rod.spatial) return std::make_unique<spatial::End>(arc_side, rod.clamped);
  return std::make_unique<planar::End>(arc_side, rod.clamped);
}

/// Joint between two stretches, the first on the left.
std::unique_ptr<Joint> contact_joint(const RodKind& rod, Stretch left, Stretch right) {
  if (left == Stretch::line && right == Stretch::line)
    throw std::invalid_argument("two line contacts cannot meet at a joint");
  if (left != Stretch::line && right != Stretch::line) {
    if (rod.spatial) return std::make_unique<spatial::Touch>();
    return std::make_unique<planar::Touch>();
  }
  const Side line = left == Stretch::line ? Side::left : Side::right;
  if (rod.spatial) return std::make_unique<spatial::Edge>(line, rod.bending_stiffness);
  return std::make_unique<planar::Edge>(line, rod.bending_stiffness);
}

std::unique_ptr<Arc> make_arc(const RodKind& rod, Stretch stretch, const ArcMesh& mesh, bool rightward) {
  if (stretch == Stretch::line) {
    if (!rod.spatial) return std::make_unique<rod::PlanarLineArc>(rod.bending_stiffness);
    if (!rod.isotropic_straight())
      throw std::invalid_argument("a line contact needs an isotropic, naturally straight rod");
    const rod::SurfaceDensity density{rod.bending_stiffness, rod.stiffness(2)};
    return bvp::make_collocation_arc(density, mesh.nodes, mesh.stages);
  }
  if (stretch == Stretch::tail && closed_form(rod, mesh)) {
    if (!rod.infinite && (rod.clamped || !rod.isotropic_straight()))
      throw std::invalid_argument(
          "a finite tail in closed form needs a free end and an isotropic, straight rod");
    using End = rod::TailArc::End;
    return std::make_unique<rod::TailArc>(rod.spatial ? 3 : 2, rod.bending_stiffness, rightward,
                                          rod.infinite ? End::infinite : End::moment_free);
  }
  if (!rod.spatial)
    return bvp::make_collocation_arc(rod::PlanarDensity{rod.bending_stiffness}, mesh.nodes, mesh.stages);
  return bvp::make_collocation_arc(rod::KirchhoffDensity{rod.stiffness, rod.natural}, mesh.nodes,
                                   mesh.stages);
}

/// Parity, under the half-turn, of a turn of the whole rod that costs nothing: a flat rod on isolated touches turns about
/// the pulls if they lie along one line, or about their direction, the normal of its mid-point, if they are parallel. A line
/// contact alone is about to become isolated touches. Clamped ends turn with their rod only about one line.
std::optional<contact::Parity> neutral_turn(const RodKind& rod, const Topology& t) {
  const double half_turns = rod.pull_angle / M_PI, whole = std::round(half_turns);
  constexpr double nearly = 1e-5;  // there too the turn costs too little to be told from rounding
  if (!(std::abs(half_turns - whole) < nearly)) return std::nullopt;
  const std::vector<Stretch> all = stretches(t);
  const auto has = [&](Stretch kind) { return std::find(all.begin(), all.end(), kind) != all.end(); };
  if (has(Stretch::line) && has(Stretch::gap)) return std::nullopt;
  if (std::remainder(whole, 2.0) == 0.0)
    return rod.clamped && !rod.isotropic_straight() ? std::nullopt : std::optional(contact::Parity::odd);
  return rod.clamped ? std::nullopt : std::optional(contact::Parity::even);
}

}  // namespace

std::vector<Stretch> stretches(const Topology& t) {
  std::vector<Stretch> all;
  if (!t.half) all.assign(t.left.rbegin(), t.left.rend());
  all.insert(all.end(), t.right.begin(), t.right.end());
  return all;
}

bool Topology::contact() const { return mid_touch || right.size() > 1 || left.size() > 1; }

void Topology::set_micro_gaps(std::vector<MicroGaps> gaps) {
  const bool some = std::any_of(gaps.begin(), gaps.end(), [](const MicroGaps& g) { return g.any(); });
  micro_gaps = some ? std::move(gaps) : std::vector<MicroGaps>{};
}

namespace {

/// Words of a stretch read outward from the mid-point. The one that begins there is said without its part beyond.
std::vector<std::string> words_of(Stretch stretch, const MicroGaps& gaps, bool from_mid) {
  std::vector<std::string> words{word(stretch)};
  if (gaps.begin && !from_mid) words.insert(words.begin(), {"touch", "gap"});
  for (int k = 0; k < gaps.inside; ++k) words.insert(words.end(), {"gap", "line"});
  if (gaps.end) words.insert(words.end(), {"gap", "touch"});
  return words;
}

}  // namespace

std::string Topology::text() const {
  const std::vector<Stretch>& other = half ? right : left;
  const int marker = half ? 0 : static_cast<int>(left.size());
  std::vector<std::string> words;
  const auto add = [&](const std::vector<Stretch>& side, bool outward) {
    for (std::size_t k = 0; k < side.size(); ++k) {
      const std::size_t i = outward ? k : side.size() - 1 - k;
      const bool on_left = !half && !outward, at_mid = i == 0 && !mid_touch;
      const int link = on_left ? marker - 1 - static_cast<int>(i) : marker + static_cast<int>(i);
      const MicroGaps gaps = on_left ? micro_gaps_of(link).reversed() : micro_gaps_of(link);
      std::vector<std::string> own = words_of(side[i], gaps, at_mid);
      if (outward && at_mid) {  // the first stretch spans both halves
        words.insert(words.end(), own.begin() + 1, own.end());
        continue;
      }
      if (outward && i > 0 && side[i] != Stretch::line && side[i - 1] != Stretch::line)
        words.push_back("touch");
      if (!outward) std::reverse(own.begin(), own.end());
      words.insert(words.end(), own.begin(), own.end());
      if (!outward && at_mid && gaps.begin) words.insert(words.end(), {"gap", "line"});
      if (!outward && i > 0 && side[i] != Stretch::line && side[i - 1] != Stretch::line)
        words.push_back("touch");
    }
  };
  add(other, false);
  if (mid_touch) words.push_back("touch");
  add(right, true);
  std::string text;
  for (const auto& w : words) text += (text.empty() ? "" : " ") + w;
  return text;
}

std::unique_ptr<Chain> build_chain(const RodKind& rod, const Topology& t,
                                   const std::vector<ArcMesh>& meshes) {
  if (rod.strut && !rod.spatial) throw std::invalid_argument("struts are computed with the Kirchhoff rod");
  const std::vector<Stretch> all = stretches(t);
  const double end = rod.infinite ? std::numeric_limits<double>::infinity() : 1.0;
  const int left_count = t.half ? 0 : static_cast<int>(t.left.size());
  const auto mesh_of = [&](std::size_t i) { return meshes.empty() ? ArcMesh{} : meshes.at(i); };
  std::vector<std::unique_ptr<Joint>> joints;
  std::vector<double> fixed;
  std::vector<Link> links;
  for (int i = 0; i <= static_cast<int>(all.size()); ++i) {
    if (t.half && i == 0) {
      joints.push_back(first_joint(rod, t));
      fixed.push_back(0.0);
    } else if (i == 0 || i == static_cast<int>(all.size())) {
      joints.push_back(
          end_joint(rod, mesh_of(i == 0 ? 0 : all.size() - 1), i == 0 ? Side::right : Side::left));
      fixed.push_back(i == 0 ? -end : end);
    } else if (!t.half && i == left_count) {
      joints.push_back(marker(rod, t));
      fixed.push_back(0.0);
    } else {
      joints.push_back(contact_joint(rod, all[i - 1], all[i]));
      fixed.push_back(0.0);
    }
    if (i == static_cast<int>(all.size())) break;
    Link link;
    link.arc = make_arc(rod, all[i], mesh_of(i), i >= left_count);
    link.role = word(all[i]);
    if (all[i] == Stretch::tail && !rod.strut) link.pull = i >= left_count ? 1 : -1;
    links.push_back(std::move(link));
  }
  auto chain = std::make_unique<Chain>(std::move(joints), std::move(fixed), std::move(links));
  if (const auto parity = neutral_turn(rod, t)) chain->expect_neutral_turn(*parity);
  return chain;
}

}  // namespace windlass::chain
