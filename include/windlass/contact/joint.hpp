#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "windlass/bvp/arc.hpp"
#include "windlass/contact/symmetry.hpp"
#include "windlass/obstacle/surface.hpp"

/// Joints: the places where arcs meet (contacts, ends, the symmetry point).
///
/// A joint owns a few coordinates w (for a touch: place on its obstacle and frame). It tells each neighbouring arc
/// its end configuration q(w) and position X(w). Balance of force and moment at the joint is then stationarity of
/// the chain's Lagrangian with respect to w; where the joint sits along the rod (arclength s, unknown for contacts)
/// is fixed by a location condition: tangency at a touch, continuous curvature at the edge of a line contact.
namespace windlass::contact {

inline constexpr int max_coordinates = 6;
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Loads and lengths at which a chain is evaluated; the continuation parameters live here.
struct Loads {
  double tension = 1.0;      ///< T [EI/ρ²]
  double angle = 0.0;        ///< phi [rad]
  double half_length = 0.0;  ///< from the mid-point to an end [ρ]; unused with an infinite tail
  double thrust = 0.0;       ///< strut: compressive end force
  double shortening = 0.0;   ///< strut: end shortening / length
  double twist = 0.0;        ///< strut: relative end rotation about e_x [rad]
  double radius = 0.0;       ///< of the rod: its strands keep 2r apart [ρ]
  double friction = 0.0;     ///< mu of the cylinder that slips along the rod, towards +e_z; 0: it stands
  double arm = 0.0;          ///< of the friction about the centre line, 0: it has no moment [ρ]
  double travel = 0.0;       ///< ω: the rod runs along itself at ω times the cylinder's speed
  double compliance = 0.0;   ///< 1/EA of a rod that stretches [ρ²/EI]
  double weight_x = 0.0, weight_y = 0.0, weight_z = 0.0;  ///< known force per length [EI/ρ³]
  Eigen::Vector3d weight() const { return {weight_x, weight_y, weight_z}; }
  double guide_offset = 1.0, guide_height = 0.0;  ///< of the lines that ends on sliders move along [ρ]
  bool weighs() const { return weight_x != 0.0 || weight_y != 0.0 || weight_z != 0.0; }
};

enum class Side { left, right };  ///< the arc that ends here, the arc that starts here
enum class JointKind { end, touch, edge, section, infinity };
enum class Parity { even, odd };

/// How one arc's end hangs on the joint: configuration q and position X with first derivatives.
struct Attachment {
  Coordinates q;   ///< ambient configuration
  SmallMatrix dq;  ///< tangent × coordinates
  SmallVector x;   ///< position conjugate to the arc's n
  SmallMatrix dx;  ///< forces × coordinates
  /// Displacements that the contact's force does no work on, which balance is tested with: normal to e_r + mu d where a
  /// cylinder slips. forces × coordinates; nothing: dx.
  std::optional<SmallMatrix> tested = {};
  const SmallMatrix& test() const { return tested ? *tested : dx; }
  /// Of these sizes, all zero.
  static Attachment zero(int ambient, int tangent, int forces, int coordinates) {
    return {Coordinates::Zero(ambient), SmallMatrix::Zero(tangent, coordinates), SmallVector::Zero(forces),
            SmallMatrix::Zero(forces, coordinates)};
  }
};

/// State of a rod at one place, from which a joint can take its coordinates.
struct Place {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  Eigen::Vector4d q = Eigen::Vector4d::UnitX();  ///< frame, body → world
  double angle = 0.0;                            ///< unrolled place round the axis [rad]
  double heading = 0.0;                          ///< unrolled angle of the tangent's projection to e_x [rad]
};

/// The centre line at a joint: place and tangent, and how they change with the degrees of freedom (3 × tangent).
struct Centreline {
  Eigen::Vector3d r, t;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, max_coordinates> dr, dt;
};

class Joint {
 public:
  virtual ~Joint() = default;
  virtual JointKind kind() const = 0;
  virtual int ambient() const = 0;                ///< stored coordinates
  virtual int tangent() const = 0;                ///< degrees of freedom
  virtual bool locates() const { return false; }  ///< is the arclength of this joint unknown?
  /// Contacts: change of the first coordinate on the obstacle with the arclength, as the rod slides along itself.
  virtual double slide(const double* w) const { return (void)w, 1.0; }

  virtual Attachment attach(Side side, const double* w, const Loads& loads) const = 0;

  /// Adds ∂/∂w' of (dqᵀ g_q + dXᵀ f) at frozen g_q, f: the second derivatives of the attachment. tangent × tangent.
  virtual void curvature(Side side, const double* w, const Loads& loads, const SmallVector& g_q,
                         const SmallVector& f, SmallMatrix& out) const {
    (void)side, (void)w, (void)loads, (void)g_q, (void)f, (void)out;
  }

  /// What the friction at the edge of a line contact takes of the line's own force along the normal, which is not conjugate
  /// to any coordinate: a term of the balance equations, and its derivatives.
  struct Drag {
    SmallVector value;        ///< tangent
    SmallMatrix by_w;         ///< tangent × tangent
    SmallMatrix by_gradient;  ///< tangent × tangent of the line
  };
  /// @param g  action gradient of the line with respect to its configuration here
  virtual std::optional<Drag> drag(Side side, const double* w, const Loads& loads,
                                   const SmallVector& g) const {
    return (void)side, (void)w, (void)loads, (void)g, std::nullopt;
  }

  /// What slips takes, too, of another strand's force on the joint: mu times what of it goes straight to the obstacle. A term of
  /// the balance equations like Drag, `by_gradient` its derivative with that force (tangent × 3).
  /// @param force  in the Lagrangian's sign, that against what pushes
  virtual std::optional<Drag> drag_of_push(const double* w, const Loads& loads,
                                           const Eigen::Vector3d& force) const {
    return (void)w, (void)loads, (void)force, std::nullopt;
  }

  /// Degrees of freedom that move a flat rod out of its plane z = 0: zero, by symmetry, as long as nothing pushes.
  virtual std::vector<int> out_of_plane() const { return {}; }

  /// Location condition c(w, g_q) = 0, g_q the action gradient of the free arc at this end.
  struct Location {
    double value = 0.0;
    Side side = Side::right;  ///< whose gradient it uses
    SmallVector by_w;         ///< tangent
    SmallVector by_gradient;  ///< tangent of the arc's configuration (empty: not used)
  };
  /// @param g_left, g_right  action gradients of the neighbouring arcs with respect to their configuration here
  virtual Location location(const double* w, const SmallVector& g_left, const SmallVector& g_right) const {
    (void)w, (void)g_left, (void)g_right;
    return {};
  }

  /// What the stretch of the rod adds to the location condition, and its derivatives.
  struct Stretching {
    double value = 0.0;
    SmallVector by_w;  ///< tangent
    SmallVector by_n;  ///< forces
  };
  /// @param n  force here in the arc on Location::side
  virtual std::optional<Stretching> stretching(const double* w, const SmallVector& n,
                                               double compliance) const {
    return (void)w, (void)n, (void)compliance, std::nullopt;
  }

  /// What the moment of a point force's friction adds to the location condition, and its derivatives.
  struct Lift {
    double value = 0.0;
    SmallVector by_w;  ///< tangent
    double by_travel = 0.0;
  };
  virtual std::optional<Lift> lift(const double* w, const Loads& loads) const {
    return (void)w, (void)loads, std::nullopt;
  }
  /// Place of a contact's force among the coordinates, −1: it is none; and what of it flows into the line's pressure.
  virtual int force_coordinate() const { return -1; }
  virtual double flux(const double* w, const Loads& loads) const { return (void)w, (void)loads, 0.0; }

  /// Derivative of the dead potential −F·X with w, for joints that carry a load themselves (strut ends).
  virtual SmallVector dead_load(const double* w, const Loads& loads) const {
    (void)w, (void)loads;
    return SmallVector::Zero(tangent());
  }

  /// Degrees of freedom that a symmetry keeps where it maps the joint to itself, at s = 0; it reverses the others.
  virtual std::vector<int> even(Symmetry symmetry) const { return (void)symmetry, std::vector<int>(); }
  /// The degrees of freedom that translate the rod along the axis and spin it about its tangent, −1: none.
  virtual int height_coordinate() const { return -1; }
  virtual int spin_coordinate() const { return -1; }

  /// Change of the degrees of freedom as the whole rod turns about e_x by `turn` and every section about its tangent by
  /// `spin` [rad]; see Chain::phase_motion.
  virtual SmallVector turned(const double* w, double turn, double spin) const {
    return (void)w, (void)turn, (void)spin, SmallVector::Zero(tangent());
  }

  /// Degrees of freedom of the equilibrium equations that the rod itself does not have: variations leave them out.
  virtual std::vector<int> fixed_in_variations() const { return {}; }
  /// How far an end posed without its clamp has turned out of it [rad]: zero at an equilibrium; see FreeRodEnd.
  virtual double out_of_clamp(const double* w) const { return (void)w, 0.0; }

  /// Joints that another strand of the rod may press on (chain::Coupling).
  virtual Centreline centreline(const double* w) const {
    (void)w;
    throw std::logic_error("no strand presses on this joint");
  }
  /// Adds f·∂²r/∂w∂w'. tangent × tangent.
  virtual void place_curvature(const double* w, const Eigen::Vector3d& f, SmallMatrix& out) const {
    (void)w, (void)f, (void)out;
  }
  /// Leading coordinates that are lengths or angles of a place, whose small differences count: see Chain's rests.
  virtual int places() const { return 0; }

  virtual void retract(const double* w, const double* dw, double* out) const = 0;

  /// Coordinates of this joint when the rod there is as given: a guess.
  virtual void adopt(const Place& place, double* w) const = 0;

  /// Contacts: the obstacle, and the place there in the coordinates of its chart, which are the joint's first.
  virtual const obstacle::Surface* surface() const { return nullptr; }
  virtual Eigen::Vector2d on_surface(const double* w) const { return (void)w, Eigen::Vector2d::Zero(); }
  obstacle::Chart chart(const double* w) const { return surface()->chart(on_surface(w)); }
};

}  // namespace windlass::contact
