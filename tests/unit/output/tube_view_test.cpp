// A thick rod in a picture: nearer strands over farther ones, at the right width.
#include "windlass/output/tube_view.hpp"

#include <boost/test/unit_test.hpp>
#include <sstream>

namespace {

using namespace windlass::output;
using Eigen::Vector3d;

/// Straight strands one after the other, from -1 to 1 along a direction at some height.
struct Strand {
  Vector3d along;
  double z;
};

RodCurve curve_of(const std::vector<Strand>& strands) {
  RodCurve curve;
  for (std::size_t k = 0; k < strands.size(); ++k)
    for (int i = 0; i <= 20; ++i) {
      const double s = -1.0 + 0.1 * i;
      curve.s.push_back(3.0 * static_cast<double>(k) + s);
      curve.r.push_back(s * strands[k].along + strands[k].z * Vector3d::UnitZ());
      curve.q.push_back(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), strands[k].along));
      curve.arc.push_back(k);
    }
  return curve;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(tube_view)

BOOST_AUTO_TEST_CASE(nearer_strands_are_drawn_later) {
  const RodCurve curve = curve_of({{Vector3d::UnitX(), 0.4}, {Vector3d::UnitY(), -0.4}});
  const auto colour = [&](std::size_t place) { return static_cast<unsigned>(curve.arc[place]); };
  for (const double side : {1.0, -1.0}) {
    const View view{side * Vector3d::UnitZ(), Vector3d::UnitX(), side * Vector3d::UnitY()};
    const auto pieces = tube_pieces(curve, 0.2, view, colour);
    for (std::size_t i = 1; i < pieces.size(); ++i) BOOST_TEST(pieces[i].depth >= pieces[i - 1].depth);
    BOOST_TEST(pieces.back().colour == (side > 0.0 ? 0u : 1u));
  }
}

BOOST_AUTO_TEST_CASE(sides_are_a_radius_from_the_centre_line_and_shared) {
  const RodCurve curve = curve_of({{Vector3d(1.0, 1.0, 0.5).normalized(), 0.0}});
  const auto pieces = tube_pieces(curve, 0.2, View::from(0.3, 0.4), [](std::size_t) { return free_rod; });
  BOOST_TEST(pieces.size() == 20u);
  int ends = 0;
  for (const TubePiece& piece : pieces) {
    for (const auto& side : piece.side) {
      BOOST_TEST(side.norm() == 0.2, boost::test_tools::tolerance(1e-12));
      BOOST_TEST(std::abs(side.dot(piece.centre[1] - piece.centre[0])) < 1e-12);
    }
    for (const double rest : piece.rest) ends += rest < 1e-12 ? 1 : 0;
    // edge, body, strip: four corners each
    std::istringstream text(tube_polygons(piece, stroke_of(0.2, 6.0)));
    int corners = 0;
    for (std::string line; std::getline(text, line);) corners += line.empty() ? 0 : 1;
    BOOST_TEST(corners == 12);
  }
  BOOST_TEST(ends == 2);
}

BOOST_AUTO_TEST_CASE(slender_rods_can_be_seen_and_pressures_have_the_colours_of_the_palette) {
  BOOST_TEST(stroke_of(0.3, 6.0).radius == 0.3);
  BOOST_TEST(stroke_of(1e-4, 6.0).radius > 0.01);
  BOOST_TEST(stroke_of(0.0, 6.0).radius == 0.0);
  BOOST_TEST(pressure_colour(0.0) == 0xfde725u);
  BOOST_TEST(pressure_colour(1.0) == 0x57106eu);
  BOOST_TEST(pressure_colour(1.1) == 0x57106eu);
}

BOOST_AUTO_TEST_SUITE_END()
