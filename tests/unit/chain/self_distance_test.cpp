// Closest approach of a rod to itself, on curves whose own is known.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "windlass/chain/self_distance.hpp"

using namespace windlass::chain;
using Eigen::Vector3d;
namespace tt = boost::test_tools;

namespace {

struct Jet {
  Vector3d r, t, k;
};
using Path = std::function<Jet(double s)>;

/// Samples of a curve given by arclength; six a unit, like the Lagrange points of an element.
Piece piece(const Path& arc, double begin, double end, int elements) {
  Piece out;
  out.stride = 6;
  const Eigen::Index count = 6 * elements + 1;
  out.s = VectorXd::LinSpaced(count, begin, end);
  out.r.resize(3, count), out.m.resize(3, count), out.n.setZero(3, count), out.q.resize(4, count);
  out.p.setZero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Jet at = arc(out.s(i));
    const Vector3d d1 = at.t.unitOrthogonal();
    Eigen::Matrix3d frame;
    frame << d1, at.t.cross(d1), at.t;
    const Eigen::Quaterniond q(frame);
    out.r.col(i) = at.r;
    out.q.col(i) << q.w(), q.x(), q.y(), q.z();
    out.m.col(i) = at.t.cross(at.k);  // of a rod of stiffness 1: t' = u × t
  }
  return out;
}

Profile profile(const Path& arc, double begin, double end, int elements) {
  Profile out;
  out.pieces.push_back(piece(arc, begin, end, elements));
  return out;
}

Path helix(double psi) {
  return [=](double s) {
    const double a = std::cos(psi) * s, c = std::cos(psi);
    return Jet{{std::sin(a), -std::cos(a), std::sin(psi) * s},
               {c * std::cos(a), c * std::sin(a), std::sin(psi)},
               c * c * Vector3d(-std::sin(a), std::cos(a), 0.0)};
  };
}

Path line(const Vector3d& from, const Vector3d& along, double s0) {
  return [=](double s) { return Jet{from + (s - s0) * along, along, Vector3d::Zero()}; };
}

/// Distance of the neighbouring turns of a helix: d² = 4 sin²(cΔ/2) + (Δ sin ψ)², stationary in Δ near k turns.
double turn_distance(double psi, int k) {
  const double c = std::cos(psi), s = std::sin(psi);
  double low = (2 * k - 1) * M_PI / c + 1e-3, high = 2 * k * M_PI / c;
  for (int i = 0; i < 200; ++i) {
    const double d = 0.5 * (low + high);
    (c * std::sin(c * d) + s * s * d < 0.0 ? low : high) = d;
  }
  return std::hypot(2.0 * std::sin(0.5 * c * low), s * low);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(self_distances)

BOOST_AUTO_TEST_CASE(turns_of_a_helix) {
  for (const double psi : {0.02, 0.05, 0.1}) {
    const auto found = self_distance(profile(helix(psi), -10.0, 10.0, 24), 0.0);
    BOOST_REQUIRE(found.has_value());
    // The quintic between samples h = 0.14 apart is h⁶/46080 = 1e-10 off.
    BOOST_TEST(found->distance == turn_distance(psi, 1), tt::tolerance(1e-8));
    // With a radius of more than 2, one turn is no longer than a neighbour's place; the next counts.
    const auto second = self_distance(profile(helix(psi), -10.0, 10.0, 24), 2.05);
    BOOST_REQUIRE(second.has_value());
    BOOST_TEST(second->distance == turn_distance(psi, 2), tt::tolerance(1e-8));
  }
}

BOOST_AUTO_TEST_CASE(open_and_closed_rings) {
  const double gap = 0.6, length = 2.0 * M_PI - gap;
  const auto open = self_distance(profile(helix(0.0), -0.5 * length, 0.5 * length, 12), 0.0);
  BOOST_REQUIRE(open.has_value());
  BOOST_TEST(open->distance == 2.0 * std::sin(0.5 * gap), tt::tolerance(1e-10));
  BOOST_TEST(open->s1 == -0.5 * length);
  BOOST_TEST(open->s2 == 0.5 * length);
  const auto closed = self_distance(profile(helix(0.0), -M_PI, M_PI, 12), 0.0);
  BOOST_REQUIRE(closed.has_value());
  BOOST_TEST(closed->distance < 1e-10);
}

BOOST_AUTO_TEST_CASE(tails_that_cross) {
  // Three quarters of a turn: the tangents at its ends cross at distance |tan(3π/4)| = 1 from it, at any length of tails.
  const double half = 0.75 * M_PI;
  for (const double tail : {3.0, 30.0, 3000.0}) {
    const Jet a = helix(0.0)(-half), b = helix(0.0)(half);
    Profile out;
    out.pieces.push_back(piece(line(a.r, a.t, -half), -half - tail, -half, 7));
    out.pieces.push_back(piece(helix(0.0), -half, half, 10));
    out.pieces.push_back(piece(line(b.r, b.t, half), half, half + tail, 7));
    const auto found = self_distance(out, 0.0);
    BOOST_REQUIRE(found.has_value());
    BOOST_TEST(found->distance < 1e-12 * tail);
    BOOST_TEST(found->s1 == -half - 1.0, tt::tolerance(1e-10));
    BOOST_TEST(found->s2 == half + 1.0, tt::tolerance(1e-10));
    // To a tube too thick for the loop the crossing is its own neighbourhood, and beyond the legs only part.
    BOOST_TEST(!self_distance(out, 3.0).has_value());
  }
}

BOOST_AUTO_TEST_CASE(parallel_legs) {
  const double quarter = 0.5 * M_PI;
  const Jet a = helix(0.0)(-quarter), b = helix(0.0)(quarter);
  Profile out;
  out.pieces.push_back(piece(line(a.r, a.t, -quarter), -quarter - 5.0, -quarter, 4));
  out.pieces.push_back(piece(helix(0.0), -quarter, quarter, 8));
  out.pieces.push_back(piece(line(b.r, b.t, quarter), quarter, quarter + 5.0, 4));
  const auto found = self_distance(out, 0.0);
  BOOST_REQUIRE(found.has_value());
  BOOST_TEST(found->distance == 2.0, tt::tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(rods_that_do_not_come_back) {
  BOOST_TEST(!self_distance(profile(line(Vector3d::Zero(), Vector3d::UnitX(), 0.0), -20, 20, 8), 0.0));
  BOOST_TEST(!self_distance(profile(helix(0.0), -0.25 * M_PI, 0.25 * M_PI, 4), 0.1));
  BOOST_TEST(!self_distance(profile(helix(1.2), -20, 20, 60), 0.0));  // steeper than it could return
}

BOOST_AUTO_TEST_CASE(random_curves_against_all_pairs) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (int curve = 0; curve < 12; ++curve) {
    // A tangent that wanders over the sphere, of arclength by construction; position by Simpson's rule.
    double c[4][4];
    for (auto& row : c)
      for (double& value : row) value = normal(random);
    const auto direction = [&](double s) {
      const auto wave = [&](int i) {
        return c[i][0] * std::sin(0.7 * s + c[i][1]) + c[i][2] * std::cos(1.1 * s + c[i][3]);
      };
      const double azimuth = 1.3 * s + wave(0), rise = 0.5 * wave(1);
      return Vector3d(std::cos(rise) * std::cos(azimuth), std::cos(rise) * std::sin(azimuth), std::sin(rise));
    };
    constexpr int elements = 40, fine = 16;
    constexpr double length = 16.0, h = length / (6 * elements);
    std::vector<Vector3d> places{Vector3d::Zero()};
    for (int k = 0; k < 6 * elements; ++k) {
      Vector3d r = places.back();
      for (int j = 0; j < fine; ++j) {
        const double a = k * h + j * h / fine, w = h / fine;
        r += w / 6.0 * (direction(a) + 4.0 * direction(a + 0.5 * w) + direction(a + w));
      }
      places.push_back(r);
    }
    const Path arc = [&](double s) {
      constexpr double e = 1e-5;
      return Jet{places[static_cast<std::size_t>(std::lround(s / h))], direction(s),
                 (direction(s + e) - direction(s - e)) / (2.0 * e)};
    };
    const auto found = self_distance(profile(arc, 0.0, length, elements), 0.0);
    double least = std::numeric_limits<double>::infinity();
    const int last = 6 * elements;
    const auto d = [&](int i, int j) { return (places[j] - places[i]).norm(); };
    for (int i = 0; i <= last; ++i)
      for (int j = i + 12; j <= last; ++j) {
        bool lowest = true;
        for (const auto& [a, b] : {std::pair{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}})
          lowest = lowest && (a < 0 || b > last || d(a, b) >= d(i, j));
        if (lowest) least = std::min(least, d(i, j));
      }
    BOOST_REQUIRE(found.has_value() == std::isfinite(least));
    if (!found) continue;
    BOOST_TEST(found->distance <= least + 1e-9);
    BOOST_TEST(found->distance >= least - h);  // a pair of samples lies within h/2 of each of the two places
  }
}

BOOST_AUTO_TEST_SUITE_END()
