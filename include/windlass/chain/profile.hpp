#pragma once

#include <vector>

#include "windlass/chain/chain.hpp"
#include "windlass/chain/topology.hpp"
#include "windlass/rod/line_contact.hpp"

/// A chain's state as a curve in space: what events, output, and guesses for other topologies read.
namespace windlass::chain {

/// One arc sampled at its Lagrange points. World frame, dimensionless; shapes as in equilibrium::ArcRecord.
struct Piece {
  Stretch stretch = Stretch::tail;
  int obstacle = 0;  ///< of a line
  int stride = 1;    ///< samples an element: polynomials of this degree run through stride + 1 samples
  VectorXd s;
  Eigen::Matrix3Xd r, n, m;
  Eigen::Matrix4Xd q;
  VectorXd angle;        ///< unrolled place round the axis, 0 at the south pole [rad]
  VectorXd heading;      ///< unrolled angle of the tangent's projection to e_x [rad]
  VectorXd p;            ///< contact force per length
  VectorXd inclination;  ///< of the tangent to the plane of the cylinder's section [rad]
  double force = 0.0;    ///< ∫ p ds
  bool weld = false;     ///< of no length, between touches at one place
  /// Of a line that carries no pressure, see rod::buckling_margin.
  std::optional<double> buckling;

  double length() const { return s(s.size() - 1) - s(0); }
};

/// A contact joint as seen from outside.
struct Contact {
  int joint = 0;
  int obstacle = 0;   ///< −1: another strand of the rod
  int coupling = -1;  ///< of the chain's couplings, with another strand
  bool edge = false;
  double s = 0.0, angle = 0.0, z = 0.0;                      ///< angle: unrolled, round e_z
  Eigen::Vector3d r, normal;                                 ///< outward; of two strands: away from the other
  Eigen::Vector3d surface_normal = Eigen::Vector3d::Zero();  ///< of the obstacle, outward
  double force = 0.0;  ///< outward on the rod; >= 0 where the contact holds
  double layer = 0.0;  ///< at an edge, force of a layer of the line's pressure there; >= 0 likewise
  /// g'' at a touch, >= 0; of two strands the least curvature of their distance as either place moves.
  double gap_curvature = 0.0;
  /// Of two strands: G″ of G(s) = min |r(s) − r₂(s₂)| over the other's place, and how fast that goes along with s.
  double gap_second = 0.0, place_ratio = 0.0;
  /// Of a strand that lies on an obstacle where another presses on it: the obstacle's force, outward.
  std::optional<double> reaction;
};

struct Profile {
  std::vector<Piece> pieces;      ///< in the order of the chain's links
  std::vector<Contact> contacts;  ///< in the order of the chain's joints
  obstacle::Set obstacles;
  rod::Material material;
  double radius = 0.0;                       ///< of the rod, 0: its strands pass through each other [ρ]
  double unit_length = 1.0;                  ///< see RodKind
  double travelled = 0.0;                    ///< τ or ω on a cylinder that slips along the rod, see Travel
  bool stands_free = false, floats = false;  ///< see the functions of these names
  bool ends_held = false;  ///< in their places, or to lines: a strut's, and those on sliders

  /// The contact at a joint; nullptr: there is none.
  const Contact* contact_at(int joint) const;
  double begin() const { return pieces.front().s(0); }
  double end() const { return pieces.back().s(pieces.back().s.size() - 1); }
  /// Interpolated state at arclength s (clamped to the profile).
  struct At : contact::Place {
    Eigen::Vector3d n, m;
  };
  At at(double s) const;
};

/// Curvature vector of the centre line at a sample, d²r/ds² in its own arclength.
Eigen::Vector3d curvature(const rod::Material& material, const Piece& piece, Eigen::Index sample);

Profile profile(const Chain& chain, const Topology& topology, const RodKind& rod, const VectorXd& x,
                const Loads& loads);

/// Has no arc a length below zero?
bool in_order(const Profile& profile);

/// How far apart the centre lines of two states are where it is most, at the joints of the first.
double farthest(const Profile& one, const Profile& other);

/// Sum of the sizes of all contact forces of the whole rod (both halves for a half chain).
double total_contact_force(const Profile& profile, const Topology& topology);
/// The same without sampling free arcs.
double total_contact_force(const Chain& chain, const Topology& topology, const RodKind& rod,
                           const VectorXd& x, const Loads& loads);

}  // namespace windlass::chain
