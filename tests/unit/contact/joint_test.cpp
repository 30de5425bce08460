// Derivatives of the joints' attachments and location conditions, against differences.
#include "windlass/contact/joint.hpp"

#include <boost/test/unit_test.hpp>
#include <functional>

#include "windlass/contact/planar_joints.hpp"
#include "windlass/contact/spatial_joints.hpp"

namespace {

using namespace windlass;
using contact::Attachment;
using contact::Joint;
using contact::Side;
using contact::SmallMatrix;
using contact::SmallVector;
using Eigen::VectorXd;

constexpr double h = 1e-5;      // central differences: h² and 1e-16/h,
constexpr double bound = 1e-9;  // entries of order one

contact::Loads some_loads() {
  contact::Loads loads;
  loads.tension = 1.3;
  loads.angle = 5.0;
  loads.half_length = 0.5;
  loads.shortening = 0.2;
  loads.twist = 1.1;
  return loads;
}

/// Coordinates of a joint in a rod that lies somewhere with some frame, moved off symmetric values.
VectorXd coordinates(const Joint& joint) {
  contact::Place place;
  place.r = {0.3, -0.9, 0.2};
  place.angle = 0.4;
  place.heading = 0.7;
  place.q = contact::spatial::surface_frame(0.4, 0.3, 0.2);
  VectorXd w = VectorXd::Zero(joint.ambient() + 1), out = w;
  joint.adopt(place, w.data());
  const VectorXd step = VectorXd::LinSpaced(joint.tangent() + 1, 0.05, 0.15);
  joint.retract(w.data(), step.data(), out.data());
  return out;
}

VectorXd moved(const Joint& joint, const VectorXd& w, int k, double by) {
  VectorXd out = w, step = VectorXd::Zero(joint.tangent() + 1);
  step(k) = by;
  joint.retract(w.data(), step.data(), out.data());
  return out;
}

/// Increment from configuration a to b: half the rotation vector for frames.
VectorXd increment(const contact::Coordinates& a, const contact::Coordinates& b) {
  if (a.size() != 4) return b - a;
  const rod::Quaternion q = rod::product(rod::conjugate(a), b);
  return q.tail<3>() / q(0);
}

void check(const char* name, const Joint& joint, std::vector<Side> sides) {
  const contact::Loads loads = some_loads();
  const VectorXd w = coordinates(joint);
  for (const Side side : sides) {
    const auto attach = [&](const VectorXd& at) { return joint.attach(side, at.data(), loads); };
    const Attachment here = attach(w);
    const SmallVector g = SmallVector::LinSpaced(here.dq.rows(), 0.7, -0.4),
                      f = SmallVector::LinSpaced(here.x.size(), -0.6, 0.9);
    SmallMatrix curvature = SmallMatrix::Zero(joint.tangent(), joint.tangent());
    joint.curvature(side, w.data(), loads, g, f, curvature);
    BOOST_TEST_CONTEXT(name << (side == Side::left ? ", left" : ", right"))
    for (int k = 0; k < joint.tangent(); ++k) {
      const Attachment up = attach(moved(joint, w, k, h)), down = attach(moved(joint, w, k, -h));
      BOOST_TEST((increment(down.q, up.q) / (2.0 * h) - VectorXd(here.dq.col(k))).norm() < bound);
      BOOST_TEST((VectorXd(up.x - down.x) / (2.0 * h) - VectorXd(here.dx.col(k))).norm() < bound);
      const VectorXd change = VectorXd(up.dq.transpose() * g + up.dx.transpose() * f -
                                       down.dq.transpose() * g - down.dx.transpose() * f) /
                              (2.0 * h);
      // Only the symmetric part is used: joint coordinates are plain numbers, whose second derivatives commute, or
      // frames, which carry no curvature here.
      const SmallMatrix whole = curvature;
      BOOST_TEST((change - VectorXd(whole.col(k))).norm() < bound);
    }
  }
}

void check_location(const char* name, const Joint& joint, int tangent) {
  const VectorXd w = coordinates(joint);
  const SmallVector left = SmallVector::LinSpaced(tangent, 0.3, 0.8),
                    right = SmallVector::LinSpaced(tangent, -0.5, 0.6);
  const Joint::Location here = joint.location(w.data(), left, right);
  BOOST_TEST_CONTEXT(name) {
    for (int k = 0; k < joint.tangent(); ++k) {
      const double change = joint.location(moved(joint, w, k, h).data(), left, right).value -
                            joint.location(moved(joint, w, k, -h).data(), left, right).value;
      BOOST_TEST(std::abs(change / (2.0 * h) - here.by_w(k)) < bound);
    }
    for (Eigen::Index k = 0; k < here.by_gradient.size(); ++k) {
      SmallVector l = left, r = right;
      (here.side == Side::left ? l : r)(k) += 1.0;  // linear in the gradient
      BOOST_TEST(std::abs(joint.location(w.data(), l, r).value - here.value - here.by_gradient(k)) < 1e-13);
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(joints)

BOOST_AUTO_TEST_CASE(attachments_of_planar_joints) {
  using namespace contact::planar;
  check("touch", Touch(), {Side::left, Side::right});
  check("edge", Edge(Side::left, 1.2), {Side::left, Side::right});
  check("mid gap", MidGap(), {Side::right});
  check("marker gap", MarkerGap(), {Side::left, Side::right});
  check("end", End(Side::left, false), {Side::left});
}

BOOST_AUTO_TEST_CASE(attachments_of_spatial_joints) {
  using namespace contact::spatial;
  check("touch", Touch(), {Side::left, Side::right});
  check("touch at the mid-point", MarkerTouch(true), {Side::left, Side::right});
  check("the same, spin held", MarkerTouch(false), {Side::left, Side::right});
  check("edge", Edge(Side::left, 1.2), {Side::left, Side::right});
  check("edge of a line to the right", Edge(Side::right, 1.2), {Side::left, Side::right});
  check("mid line", MidLine(true), {Side::right});
  check("marker line", MarkerLine(true), {Side::left, Side::right});
  check("marker gap", MarkerGap(true), {Side::left, Side::right});
  check("marker gap of a strut", MarkerGap(true, true), {Side::left, Side::right});
  check("mid gap", MidGap({}), {Side::right});
  check("mid touch", MidTouch(true), {Side::right});
  check("end", End(Side::left, false), {Side::left});
  check("strut end", StrutEnd(Side::left, true), {Side::left});
}

BOOST_AUTO_TEST_CASE(location_conditions) {
  check_location("planar touch", contact::planar::Touch(), 1);
  check_location("planar edge", contact::planar::Edge(Side::left, 1.2), 1);
  check_location("spatial touch", contact::spatial::Touch(), 3);
  check_location("planar touch at the mid-point", contact::planar::MarkerTouch(), 1);
  check_location("spatial touch at the mid-point", contact::spatial::MarkerTouch(true), 3);
  check_location("the same, spin held", contact::spatial::MarkerTouch(false), 3);
  check_location("spatial edge", contact::spatial::Edge(Side::left, 1.2), 3);
  check_location("spatial edge of a line to the right", contact::spatial::Edge(Side::right, 1.2), 3);
}

BOOST_AUTO_TEST_CASE(surface_frames_and_coordinates_are_inverse) {
  const Eigen::Vector3d at =
      contact::spatial::surface_coordinates(contact::spatial::surface_frame(0.4, 0.3, -0.8), 0.4);
  BOOST_TEST((at - Eigen::Vector3d(0.4, 0.3, -0.8)).norm() < 1e-14);
}

BOOST_AUTO_TEST_CASE(the_phase_spring_holds_the_turn_about_the_struts_axis_and_nothing_else) {
  using contact::spatial::MidGap;
  const MidGap joint(MidGap::OddFreedom{true, true, true, true});
  const double w[2] = {0.3, 0.8};
  const Attachment odd = joint.attach_odd(w, some_loads());
  SmallMatrix spring = SmallMatrix::Zero(odd.dq.cols(), odd.dq.cols());
  joint.curvature_odd(w, SmallVector::Zero(3), spring);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(spring)};
  BOOST_TEST(std::abs(eigen.eigenvalues()(2)) < 1e-9 * eigen.eigenvalues()(3));  // rank one
  const SmallVector turn = eigen.eigenvectors().col(3);
  // The whole shape turned by ε about e_x, each section spun back by ε about its tangent.
  constexpr double epsilon = 1e-6;
  using rod::product, rod::rotation;
  const rod::Quaternion q = odd.q;
  const rod::Quaternion turned = product(product(rotation(Eigen::Vector3d::UnitX(), epsilon), q),
                                         rotation(Eigen::Vector3d::UnitZ(), -epsilon));
  Eigen::Matrix<double, 6, 1> expected, got;
  expected << increment(q, turned) / epsilon, Eigen::Vector3d::UnitX().cross(Eigen::Vector3d(odd.x));
  got << Eigen::Vector3d(odd.dq * turn), Eigen::Vector3d(odd.dx * turn);
  BOOST_TEST(std::abs(std::abs(got.normalized().dot(expected.normalized())) - 1.0) < 1e-9);
  // A straight strut does not move in that turn and feels no spring: it may bow in every plane.
  const double straight[2] = {0.0, 0.0};
  spring.setZero();
  joint.curvature_odd(straight, SmallVector::Zero(3), spring);
  BOOST_TEST(spring.norm() == 0.0);
}

BOOST_AUTO_TEST_SUITE_END()
