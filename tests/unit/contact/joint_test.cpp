// Derivatives of the joints' attachments and location conditions, against differences.
#include "windlass/contact/joint.hpp"

#include <boost/test/unit_test.hpp>
#include <functional>

#include "windlass/contact/planar_joints.hpp"
#include "windlass/contact/plate_joints.hpp"
#include "windlass/contact/rim_joint.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/obstacle/plane.hpp"

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

/// A wall that is nothing special, and a rod on it whose section and natural shape are neither.
const obstacle::SurfacePointer& wall() {
  static const obstacle::SurfacePointer plane =
      std::make_shared<obstacle::Plane>(Eigen::Vector3d(0.3, -0.5, 0.8), 0.7);
  return plane;
}
const obstacle::SurfacePointer& plate() {
  static const obstacle::SurfacePointer plane =
      std::make_shared<obstacle::Plane>(Eigen::Vector3d::UnitZ(), 0.3);
  return plane;
}
std::shared_ptr<const obstacle::Rim> rim(double tube) {
  return std::make_shared<const obstacle::Rim>(1.3, 0.2, true, tube);
}
contact::spatial::Edge wall_edge(Side line) { return {line, 1.2, wall(), {0.8, 1.0, 1.9}, {0.2, -0.3, 0.4}}; }

contact::Loads some_loads() {
  contact::Loads loads;
  loads.tension = 1.3;
  loads.angle = 5.0;
  loads.half_length = 0.5;
  loads.shortening = 0.2;
  loads.twist = 1.1;
  loads.friction = 0.4;
  loads.travel = 0.3;
  loads.arm = 0.2;
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
      const VectorXd change = VectorXd(up.dq.transpose() * g + up.test().transpose() * f -
                                       down.dq.transpose() * g - down.test().transpose() * f) /
                              (2.0 * h);
      // Only the symmetric part is used: joint coordinates are plain numbers, whose second derivatives commute, or
      // frames, which carry no curvature here.
      const SmallMatrix whole = curvature;
      BOOST_TEST((change - VectorXd(whole.col(k))).norm() < bound);
    }
  }
}

/// On a cylinder that slips balance is tested with displacements on which its force does no work: with turns of a touch it is
/// that of friction's moment −arm N × (N + mu d) about the centre line.
void check_slip(const char* name, const Joint& joint, Side side, const Eigen::Vector3d& tangent) {
  const contact::Loads loads = some_loads();
  const VectorXd w = coordinates(joint);
  const obstacle::Chart here = joint.chart(w.data());
  const Eigen::Vector3d d = (Eigen::Vector3d::UnitZ() - loads.travel * tangent).normalized();
  const Eigen::Vector3d along = here.tangents * (here.tangents.transpose() * d);
  SmallVector work = joint.attach(side, w.data(), loads).test().transpose() *
                     SmallVector(here.normal + loads.friction * along);
  if (joint.kind() == contact::JointKind::touch) {
    const Eigen::Vector3d moment = -loads.arm * here.normal.cross(here.normal + loads.friction * d);
    work.tail<3>() += 2.0 * rod::directors(w.segment<4>(2)).transpose() * moment;
  }
  BOOST_TEST_CONTEXT(name) BOOST_TEST(work.norm() < 1e-14 + loads.friction * (1.0 - along.squaredNorm()));
}

void check_drag(const Joint& joint, Side side) {
  const contact::Loads loads = some_loads();
  const VectorXd w = coordinates(joint);
  const SmallVector g = SmallVector::LinSpaced(2, 0.7, -0.4);
  const auto at = [&](const VectorXd& place, const SmallVector& gradient) {
    return joint.drag(side, place.data(), loads, gradient).value();
  };
  for (int k = 0; k < joint.tangent(); ++k) {
    const SmallVector change =
        (at(moved(joint, w, k, h), g).value - at(moved(joint, w, k, -h), g).value) / (2.0 * h);
    BOOST_TEST((change - SmallVector(at(w, g).by_w.col(k))).norm() < bound);
  }
  for (int k = 0; k < 2; ++k) {
    SmallVector up = g, down = g;
    up(k) += h, down(k) -= h;
    const SmallVector change = (at(w, up).value - at(w, down).value) / (2.0 * h);
    BOOST_TEST((change - SmallVector(at(w, g).by_gradient.col(k))).norm() < bound);
  }
}

/// What a strand's push on a line that slips drags: with it the push does no work on the way e_r + mu d either.
/// @param free  coordinates of the place that are unknown: both, or the one round the axis
void check_drag_of_push(const Joint& joint, Eigen::Index free = 2) {
  const contact::Loads loads = some_loads();
  const VectorXd w = coordinates(joint);
  const Eigen::Vector3d push(0.7, -0.4, 0.9);
  const auto at = [&](const VectorXd& place, const Eigen::Vector3d& force) {
    return joint.drag_of_push(place.data(), loads, force).value();
  };
  const contact::Centreline line = joint.centreline(w.data());
  const obstacle::Chart here = joint.chart(w.data());
  const Eigen::Vector3d d = (Eigen::Vector3d::UnitZ() - loads.travel * line.t).normalized();
  const Eigen::Vector3d reaction = -push.dot(here.normal) * (here.normal + loads.friction * d);
  // Balance along the surface of push and reaction: rows of the coordinates of the place.
  const Eigen::Vector2d both = here.tangents.transpose() * (push + reaction);
  const SmallVector tested = SmallVector(line.dr.transpose() * push) + at(w, push).value;
  BOOST_TEST((both.head(free) - tested.head(free)).norm() < 1e-14);
  for (int k = 0; k < joint.tangent(); ++k) {
    const SmallVector change =
        (at(moved(joint, w, k, h), push).value - at(moved(joint, w, k, -h), push).value) / (2.0 * h);
    BOOST_TEST((change - SmallVector(at(w, push).by_w.col(k))).norm() < bound);
  }
  for (int k = 0; k < 3; ++k) {
    const SmallVector change = at(w, push + Eigen::Vector3d::Unit(k)).value - at(w, push).value;  // linear
    BOOST_TEST((change - SmallVector(at(w, push).by_gradient.col(k))).norm() < 1e-14);
  }
}

/// @param dimensions  of the force: 2 in the plane
void check_stretching(const char* name, const Joint& joint, int dimensions) {
  constexpr double compliance = 0.1;
  const VectorXd w = coordinates(joint);
  const SmallVector n = Eigen::Vector3d(1.7, -0.4, 0.3).head(dimensions);
  const auto value = [&](const VectorXd& at, const SmallVector& force) {
    return joint.stretching(at.data(), force, compliance).value().value;
  };
  const Joint::Stretching here = joint.stretching(w.data(), n, compliance).value();
  BOOST_TEST_CONTEXT(name) {
    for (int k = 0; k < joint.tangent(); ++k) {
      const double change = value(moved(joint, w, k, h), n) - value(moved(joint, w, k, -h), n);
      BOOST_TEST(std::abs(change / (2.0 * h) - here.by_w(k)) < bound);
    }
    for (int k = 0; k < dimensions; ++k) {
      SmallVector more = n;
      more(k) += 1.0;  // linear in the force
      BOOST_TEST(std::abs(value(w, more) - here.value - here.by_n(k)) < 1e-13);
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

BOOST_AUTO_TEST_CASE(joints_on_a_cylinder_that_slips) {
  using namespace contact::spatial;
  const Touch touch;
  VectorXd w = coordinates(touch);
  check_slip("touch", touch, Side::left, rod::directors(w.segment<4>(2)).col(2));
  for (const Side line : {Side::left, Side::right}) {
    const Edge edge(line, 1.2);
    check_drag(edge, line);
    const Side free = line == Side::left ? Side::right : Side::left;
    BOOST_TEST(!edge.drag(free, w.data(), some_loads(), SmallVector::Zero(3)).has_value());
    w = coordinates(edge);
    const obstacle::Chart here = edge.chart(w.data());
    check_slip("edge", edge, free, here.tangents * Eigen::Vector2d(std::cos(w[2]), std::sin(w[2])));
  }
  check_drag_of_push(Pressed(obstacle::unit_cylinder()));
  check_drag_of_push(FlatPressed(obstacle::unit_cylinder(), plate()), 1);
  BOOST_TEST(!Pressed(wall()).drag_of_push(w.data(), some_loads(), Eigen::Vector3d::UnitX()).has_value());
}

BOOST_AUTO_TEST_CASE(attachments_of_planar_joints) {
  using namespace contact::planar;
  check("touch", Touch(), {Side::left, Side::right});
  check("edge", Edge(Side::left, 1.2), {Side::left, Side::right});
  check_stretching("edge", Edge(Side::left, 1.2), 2);
  check("section of a line", SurfaceSection(), {Side::left, Side::right});
  check("section of a free arc", FreeSection(), {Side::left, Side::right});
  check("end", End(Side::left, false), {Side::left});
}

BOOST_AUTO_TEST_CASE(attachments_of_spatial_joints) {
  using namespace contact::spatial;
  check("touch", Touch(), {Side::left, Side::right});
  check("edge", Edge(Side::left, 1.2), {Side::left, Side::right});
  check("edge of a line to the right", Edge(Side::right, 1.2), {Side::left, Side::right});
  check("section of a line", SurfaceSection(), {Side::left, Side::right});
  check("section of a free arc", FreeSection(), {Side::left, Side::right});
  check("touch of a wall", Touch(wall()), {Side::left, Side::right});
  check("edge on a wall", wall_edge(Side::left), {Side::left, Side::right});
  check("section of a line on a wall", SurfaceSection(wall()), {Side::left, Side::right});
  check("stop on a line", Stopped(obstacle::unit_cylinder(), plate(), false), {Side::left, Side::right});
  for (const double tube : {0.0, 0.2})
    check("touch of a plate's edge", RimTouch(rim(tube)), {Side::left, Side::right});
  check("section on a plate", FlatSection(obstacle::unit_cylinder(), plate()), {Side::left, Side::right});
  check("touch on a plate", FlatTouch(obstacle::unit_cylinder(), plate()), {Side::left, Side::right});
  check("strand in a plate", FlatStrand(plate()), {Side::left, Side::right});
  check("strand on a line in a plate", FlatPressed(obstacle::unit_cylinder(), plate()),
        {Side::left, Side::right});
  for (const Side flat : {Side::left, Side::right}) {
    check("edge on a plate", FlatEdge(flat, 1.2, obstacle::unit_cylinder(), plate()),
          {Side::left, Side::right});
    check_stretching("edge on a plate", FlatEdge(flat, 1.2, obstacle::unit_cylinder(), plate()), 3);
    check("lift off a plate", LiftOff(flat, obstacle::unit_cylinder(), plate()), {Side::left, Side::right});
  }
  check("end", End(Side::left, false), {Side::left});
  check("end in a universal joint", HeldEnd(), {Side::left});
  for (const Side side : {Side::left, Side::right}) {
    check("end on a slider", GuidedEnd(side, std::make_unique<End>(side, false)), {side});
    check("clamped end on a slider", GuidedEnd(side, std::make_unique<End>(side, true)), {side});
    check("end in a universal joint on a slider", GuidedEnd(side, std::make_unique<HeldEnd>()), {side});
    check("end on a plate", EndOnPlate(side, std::make_unique<End>(side, false), plate()), {side});
    check("clamped end on a plate", EndOnPlate(side, std::make_unique<End>(side, true), plate()), {side});
    check("end in a universal joint on a plate", EndOnPlate(side, std::make_unique<HeldEnd>(), plate()),
          {side});
  }
  for (const bool under_thrust : {false, true})
    for (const bool pinned : {false, true})
      check("end of a free rod", FreeRodEnd(Side::left, under_thrust, pinned), {Side::left});
}

/// q and -q are one frame, but arcs interpolate quaternions of one sign: a joint takes over the one that it is given.
BOOST_AUTO_TEST_CASE(joints_on_surfaces_take_over_the_sign_of_a_quaternion) {
  using namespace contact::spatial;
  const auto check_sign = [](const char* name, const Joint& joint, const obstacle::Surface& surface) {
    const Eigen::Vector2d u(0.4, 0.1);
    for (const double twist : {0.0, M_PI, -M_PI, 2.0 * M_PI}) {
      contact::Place place;
      place.angle = u(0);
      place.r = surface.chart(u).r;
      place.q = surface_frame(surface.base_frame(u), 0.0, twist);
      VectorXd w = VectorXd::Zero(joint.ambient() + 1);
      joint.adopt(place, w.data());
      const SmallVector q = joint.attach(Side::left, w.data(), some_loads()).q;
      const double turned = std::remainder(q(1) - twist, 4.0 * M_PI);  // q: inclination and twist on the line
      BOOST_TEST(std::abs(turned) < 1e-12, name << ", twist " << twist << ": " << q(1));
    }
  };
  for (const obstacle::SurfacePointer& surface : {obstacle::unit_cylinder(), wall()}) {
    check_sign("section", SurfaceSection(surface), *surface);
    check_sign("edge", Edge(Side::left, 1.2, surface, {1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}), *surface);
  }
}

BOOST_AUTO_TEST_CASE(location_conditions) {
  check_location("planar touch", contact::planar::Touch(), 1);
  check_location("planar edge", contact::planar::Edge(Side::left, 1.2), 1);
  check_location("spatial touch", contact::spatial::Touch(), 3);
  using namespace contact::spatial;
  check_location("stop on a line", Stopped(obstacle::unit_cylinder(), plate(), false), 2);
  for (const double tube : {0.0, 0.2}) check_location("touch of a plate's edge", RimTouch(rim(tube)), 3);
  check_location("touch on a plate", FlatTouch(obstacle::unit_cylinder(), plate()), 3);
  check_location("edge on a plate", FlatEdge(Side::left, 1.2, obstacle::unit_cylinder(), plate()), 3);
  check_location("lift off a plate", LiftOff(Side::left, obstacle::unit_cylinder(), plate()), 2);
  check_location("spatial edge", contact::spatial::Edge(Side::left, 1.2), 3);
  check_location("spatial edge of a line to the right", contact::spatial::Edge(Side::right, 1.2), 3);
  check_location("touch of a wall", contact::spatial::Touch(wall()), 3);
  check_location("edge on a wall", wall_edge(Side::left), 3);
  check_location("edge of a line to the right on a wall", wall_edge(Side::right), 3);
}

BOOST_AUTO_TEST_CASE(surface_frames_and_coordinates_are_inverse) {
  for (const obstacle::SurfacePointer& surface : {obstacle::unit_cylinder(), wall()}) {
    const rod::Quaternion base = surface->base_frame({0.4, 0.1});
    const Eigen::Vector2d at =
        contact::spatial::surface_coordinates(contact::spatial::surface_frame(base, 0.3, -0.8), base);
    BOOST_TEST((at - Eigen::Vector2d(0.3, -0.8)).norm() < 1e-14);
  }
}

// At s = 0 a symmetry maps the joint to itself: what it keeps moves the rod there to other places that are their own images.
BOOST_AUTO_TEST_CASE(even_coordinates_keep_a_joint_its_own_image) {
  using namespace contact::spatial;
  const auto own_image = [](const Attachment& at, contact::Symmetry symmetry) {
    const Eigen::Vector3d image = contact::image(symmetry), r = at.x;
    const Eigen::Matrix3d d = rod::directors(Eigen::Vector4d(at.q));
    const Eigen::Vector3d turned = image.cwiseProduct(d.col(0)), tangent = -image.cwiseProduct(d.col(2));
    return (image.cwiseProduct(r) - r).norm() + (turned - d.col(0)).norm() + (tangent - d.col(2)).norm();
  };
  const auto check_even = [&](const char* name, const Joint& joint, contact::Symmetry symmetry) {
    contact::Place place;
    place.r = {0.0, -1.0, symmetry == contact::Symmetry::mirror ? -0.3 : 0.0};
    place.q = surface_frame(0.0, 0.0, 0.0);
    VectorXd w = VectorXd::Zero(joint.ambient() + 1);
    joint.adopt(place, w.data());
    const std::vector<int> even = joint.even(symmetry);
    for (int k = 0; k < joint.tangent(); ++k) {
      const bool kept = std::find(even.begin(), even.end(), k) != even.end();
      const double off =
          own_image(joint.attach(Side::right, moved(joint, w, k, 0.1).data(), some_loads()), symmetry);
      BOOST_TEST((off < 1e-14) == kept, name << ", coordinate " << k << ": off by " << off);
    }
  };
  for (const contact::Symmetry symmetry : {contact::Symmetry::half_turn, contact::Symmetry::mirror}) {
    check_even("section", FreeSection(), symmetry);
    check_even("touch", Touch(), symmetry);
  }
  check_even("touch of a plate", Touch(plate()), contact::Symmetry::mirror);
  check_even("touch on a plate", FlatTouch(obstacle::unit_cylinder(), plate()), contact::Symmetry::mirror);
}

// Space turns by ε about e_x, each section by σ ε about its tangent.
BOOST_AUTO_TEST_CASE(joints_turn_about_the_axis_of_a_free_rods_ends) {
  constexpr double epsilon = 1e-6, spin = -0.7;
  using rod::product, rod::rotation;
  const contact::spatial::FreeSection joint;
  const VectorXd w = coordinates(joint);
  const Attachment here = joint.attach(Side::right, w.data(), some_loads());
  const SmallVector motion = joint.turned(w.data(), 1.0, spin);
  const rod::Quaternion q = here.q;
  const rod::Quaternion turned = product(product(rotation(Eigen::Vector3d::UnitX(), epsilon), q),
                                         rotation(Eigen::Vector3d::UnitZ(), spin * epsilon));
  // First differences of a smooth motion: ε.
  BOOST_TEST((increment(q, turned) / epsilon - VectorXd(here.dq * motion)).norm() < 1e-5);
  const Eigen::Vector3d r = here.x, moved = Eigen::AngleAxisd(epsilon, Eigen::Vector3d::UnitX()) * r;
  BOOST_TEST(((moved - r) / epsilon - Eigen::Vector3d(here.dx * motion)).norm() < 1e-5);
}

BOOST_AUTO_TEST_SUITE_END()
