#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <vector>

/// Obstacles: what the centre line of a rod must stay outside of.
namespace windlass::obstacle {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Quaternion = Eigen::Vector4d;  ///< w, x, y, z; body → world
/// To the long double of the machine, where differences of places count.
using LongVector2 = Eigen::Matrix<long double, 2, 1>;
using LongVector3 = Eigen::Matrix<long double, 3, 1>;

/// A surface about one of its points, in its coordinates u = (u₀, u₁).
struct Chart {
  Vector3d r;                            ///< X(u)
  Eigen::Matrix<double, 3, 2> tangents;  ///< ∂X/∂u_i
  Vector3d normal;                       ///< N, outward: towards the rod
  Eigen::Matrix2d bend;                  ///< h_ij = ∂N/∂u_i·∂X/∂u_j
  Eigen::Matrix2d second(const Vector3d& f) const { return -f.dot(normal) * bend; }  ///< f·∂²X/∂u_i∂u_j
  Vector2d normal_slope(const Vector3d& f) const {                                   ///< f·∂N/∂u_i
    return bend * Vector2d(tangents.col(0).dot(f), tangents.col(1).dot(f));
  }
};

/// One rigid obstacle that can be developed into a plane.
///
/// The centre line stays where gap(r) >= 0; a contact force λ >= 0 pushes it along N = ∇gap. Its chart is isometric, the
/// lines of principal curvature first: |∂X/∂u_i| = 1, N = ∂X/∂u₀ × ∂X/∂u₁, ∂²X/∂u_i∂u_j = −h_ij N, ∂N/∂u_i = h_ij ∂X/∂u_j,
/// with h = diag(curvature, 0).
class Surface {
 public:
  virtual ~Surface() = default;

  virtual double gap(const Vector3d& r) const = 0;        ///< distance, < 0 inside [ρ]
  virtual Vector3d normal(const Vector3d& r) const = 0;   ///< ∇gap
  virtual Matrix3d hessian(const Vector3d& r) const = 0;  ///< ∇∇gap [1/ρ]

  virtual Chart chart(const Vector2d& u) const = 0;
  /// X(u + step) − X(u), to the digits of `step`.
  virtual Vector3d rise(const Vector2d& u, const Vector2d& step) const = 0;
  /// X(u), to the digits of u.
  virtual LongVector3 place(const LongVector2& u) const = 0;
  /// Coordinates of a place on the surface. @param turn  its unrolled angle round e_z, 0 at the south pole [rad]
  virtual Vector2d coordinates(const Vector3d& r, double turn) const = 0;
  /// The unrolled angle round e_z of X(u).
  virtual double turn(const Vector2d& u) const = 0;
  /// Frame of a rod that lies along u₀: d₁ = N, d₂ = −∂X/∂u₁, d₃ = ∂X/∂u₀.
  virtual Quaternion base_frame(const Vector2d& u) const = 0;
  /// Normal curvature along u₀, h₀₀ [1/ρ]; along u₁ there is none.
  virtual double curvature() const = 0;

  /// Distance from e_z up to which it reaches [ρ].
  virtual double outer_radius() const { return std::numeric_limits<double>::infinity(); }

  /// May it move along +e_z while the rod stands, so that it slips along the rod (Loads::friction)?
  virtual bool slips() const { return false; }

  /// Is it its own mirror image under z → −z? A flat rod then stays flat on it.
  virtual bool keeps_flat() const = 0;
  /// Is it its own image under any translation along e_x?
  virtual bool endless_along_x() const = 0;

  /// Of a flat one, to draw it: the corners of a rectangle on it, as wide as the box and beside it. Nothing for others.
  virtual std::vector<Vector3d> sheet(const Eigen::AlignedBox3d& box) const {
    return (void)box, std::vector<Vector3d>();
  }
};

using SurfacePointer = std::shared_ptr<const Surface>;

/// The obstacles of a scene; a contact names its own by the place in this list.
class Set {
 public:
  Set() = default;
  explicit Set(std::vector<SurfacePointer> all)
      : all_(std::make_shared<const std::vector<SurfacePointer>>(std::move(all))) {}
  int size() const { return all_ ? static_cast<int>(all_->size()) : 0; }
  const Surface& operator[](int i) const { return *all_->at(i); }
  const SurfacePointer& pointer(int i) const { return all_->at(i); }

 private:
  std::shared_ptr<const std::vector<SurfacePointer>> all_;
};

}  // namespace windlass::obstacle
