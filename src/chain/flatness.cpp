#include <algorithm>

#include "windlass/chain/chain.hpp"
#include "windlass/rod/quaternion.hpp"

/// Flat rods in space. The plane z = 0 is a plane of symmetry, so the equations of a flat rod split into those in the
/// plane and those out of it. The second may be singular, where a turn of the rod costs nothing, and are not needed.

namespace windlass::chain {

namespace {

constexpr int frame = 4, surface = 2;  // ambient configurations: a unit quaternion; inclination and twist

/// The far end of a closed-form tail has no frame: q = 0.
double off_plane(const Eigen::Map<const Eigen::VectorXd>& q) {
  if (q.isZero(0.0)) return 0.0;
  if (q.size() == surface) return q.array().sin().abs().maxCoeff();  // either side up, either way along
  const Eigen::Matrix3d r = rod::directors(Eigen::Map<const Eigen::Vector4d>(q.data()));
  return std::max(std::abs(r(2, 0)), std::abs(r(2, 2)));
}

}  // namespace

std::vector<Eigen::Index> Chain::out_of_plane() const {
  std::vector<Eigen::Index> out;
  for (int j = 0; j < joint_count(); ++j) {
    const std::vector<int> odd = joints_[j]->out_of_plane();
    for (std::size_t k = 0; k < kept_[j].size(); ++k)
      if (std::find(odd.begin(), odd.end(), kept_[j][k]) != odd.end())
        out.push_back(numbering_.coordinate[j] + static_cast<Eigen::Index>(k));
  }
  for (int i = 0; i < link_count(); ++i) {
    const Arc& arc = *links_[i].arc;
    if (arc.ambient() != frame && arc.ambient() != surface) continue;
    if (links_[i].pull == 0) out.push_back(numbering_.force[i] + arc.forces() - 1);  // n_z
    for (int k = 0; k < arc.interior_nodes(); ++k)
      for (int c = 0; c < arc.tangent(); ++c)
        if (arc.ambient() == surface || c != 1)  // d₂ is the plane's normal
          out.push_back(interior_row_[i] + k * arc.tangent() + c);
  }
  return out;
}

bool Chain::is_flat(const std::vector<Placed>& placed, double within) const {
  if (outside_.empty()) return false;
  for (const auto& joint : joints_)
    if (joint->surface() && !joint->surface()->keeps_flat()) return false;
  for (int i = 0; i < link_count(); ++i) {
    const Placed& p = placed[i];
    const int size = links_[i].arc->ambient();
    if (size != frame && size != surface) continue;
    const auto flat = [&](const double* q) {
      return off_plane(Eigen::Map<const Eigen::VectorXd>(q, size)) < within;
    };
    for (const contact::Attachment* at : {&p.left, &p.right})
      if (std::abs(at->x(at->x.size() - 1)) > within || !flat(at->q.data())) return false;
    if (std::abs(p.n(p.n.size() - 1)) > within) return false;
    for (int k = 0; k < links_[i].arc->interior_nodes(); ++k)
      if (!flat(p.interior + k * size)) return false;
  }
  return true;
}

bool Chain::may_turn(contact::Parity parity, const VectorXd& x, const Loads& loads, double within) const {
  if (!neutral_turn_ || (half() && *neutral_turn_ != parity)) return false;
  std::vector<Placed> placed;
  for (int i = 0; i < link_count(); ++i) placed.push_back(place(x, loads, i));
  return is_flat(placed, within);
}

double Chain::outside(const Eigen::Ref<const VectorXd>& f) const {
  double largest = 0.0;
  for (const Eigen::Index at : outside_) largest = std::max(largest, std::abs(f(at)));
  return largest;
}

}  // namespace windlass::chain
