// The files ParaView reads, parsed again as XML.
#include "windlass/output/vtk.hpp"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <boost/test/unit_test.hpp>
#include <sstream>

#include "support/temporary_folder.hpp"
#include "synthetic_run.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"
#include "windlass/output/error.hpp"
#include "windlass/rod/capstan.hpp"

namespace {

using namespace windlass;
using Tree = boost::property_tree::ptree;
constexpr double T = 1.0, phi = 2 * std::numbers::pi;

Tree parse(const std::string& text) {
  std::istringstream stream(text);
  Tree tree;
  boost::property_tree::read_xml(stream, tree);
  return tree.get_child("VTKFile");
}

std::vector<double> numbers(const Tree& node) {
  std::istringstream stream(node.data());
  return {std::istream_iterator<double>(stream), {}};
}

/// The array of that name in a part of the piece.
std::vector<double> array(const Tree& piece, const char* part, const std::string& name) {
  for (const auto& [tag, node] : piece.get_child(part))
    if (tag == "DataArray" && node.get<std::string>("<xmlattr>.Name") == name) return numbers(node);
  BOOST_FAIL("no array " << name);
  return {};
}

const Tree& piece_of(const Tree& file) { return file.get_child("PolyData.Piece"); }

std::size_t count(const Tree& piece, const char* what) {
  return piece.get<std::size_t>(std::string("<xmlattr>.NumberOf") + what);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(vtk)

BOOST_AUTO_TEST_CASE(the_centreline_carries_the_state) {
  const auto scene = test::capstan_scene(T, phi);
  const Tree file = parse(output::vtk_rod(test::planar_capstan(T, phi), scene).rod);
  BOOST_TEST(file.get<std::string>("<xmlattr>.type") == "PolyData");
  const Tree& piece = piece_of(file);
  const std::size_t points = count(piece, "Points");
  BOOST_TEST(count(piece, "Lines") == 1u);
  BOOST_TEST(array(piece, "Lines", "connectivity").size() == points);
  BOOST_TEST(array(piece, "Lines", "offsets").back() == static_cast<double>(points));
  const auto r = array(piece, "Points", "Points"), s = array(piece, "PointData", "s"),
             p = array(piece, "PointData", "pressure"), contact = array(piece, "PointData", "contact"),
             d1 = array(piece, "PointData", "d1"), d3 = array(piece, "PointData", "d3"),
             n = array(piece, "PointData", "force"), m = array(piece, "PointData", "moment");
  for (const auto* vector : {&r, &d1, &d3, &n, &m}) BOOST_TEST(vector->size() == 3 * points);
  for (const auto* scalar : {&s, &p, &contact}) BOOST_TEST(scalar->size() == points);
  double pressed = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3d tangent(d3[3 * i], d3[3 * i + 1], d3[3 * i + 2]),
        other(d1[3 * i], d1[3 * i + 1], d1[3 * i + 2]), force(n[3 * i], n[3 * i + 1], n[3 * i + 2]),
        moment(m[3 * i], m[3 * i + 1], m[3 * i + 2]);
    BOOST_TEST(std::abs(tangent.norm() - 1.0) < 1e-12);
    BOOST_TEST(std::abs(tangent.dot(other)) < 1e-12);
    // H = m²/2 + n·d3 = T along the whole rod, up to the frames between samples 0.2 ρ apart: 0.2²/8.
    BOOST_TEST(std::abs(0.5 * moment.squaredNorm() + force.dot(tangent) - T) < 5e-3);
    if (i > 0) pressed += 0.5 * (p[i] + p[i - 1]) * (s[i] - s[i - 1]);
    if (contact[i] == 1.0) BOOST_TEST(std::abs(std::hypot(r[3 * i], r[3 * i + 1]) - 1.0) < 1e-4);
  }
  BOOST_TEST(pressed == 2.0 * rod::capstan::pressure(T) * rod::capstan::phi_star(T, phi),
             boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(point_forces_are_vertices_with_vectors) {
  const Tree file = parse(output::vtk_rod(test::planar_capstan(T, phi), test::capstan_scene(T, phi)).forces);
  const Tree& piece = piece_of(file);
  BOOST_TEST(count(piece, "Points") == 2u);
  BOOST_TEST(count(piece, "Verts") == 2u);
  const auto force = array(piece, "PointData", "force"), place = array(piece, "Points", "Points");
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Map<const Eigen::Vector3d> f(&force[3 * i]), r(&place[3 * i]);
    BOOST_TEST(f.norm() == rod::capstan::edge_force(T), boost::test_tools::tolerance(1e-12));
    BOOST_TEST(f.normalized().dot(r) == 1.0,
               boost::test_tools::tolerance(1e-12));  // outward, on the cylinder
  }
  for (const auto& [tag, node] : file.get_child("PolyData.FieldData"))
    if (node.get<std::string>("<xmlattr>.Name") == "T") BOOST_TEST(numbers(node).at(0) == T);
}

BOOST_AUTO_TEST_CASE(a_thick_rod_carries_its_radius_and_says_what_strands_touch) {
  auto scene = test::capstan_scene(T, phi);
  scene.rod_radius = 0.25;
  auto solution = test::planar_capstan(T, phi);
  auto &first = solution.joints[1], &second = solution.joints[2];  // as if the two edges touched each other
  first.partner = 2, second.partner = 1, first.strand_force = second.strand_force = 0.125;
  const output::VtkRod rod = output::vtk_rod(solution, scene);
  const Tree line = parse(rod.rod), forces = parse(rod.forces);
  for (const double radius : array(piece_of(line), "PointData", "radius")) BOOST_TEST(radius == 0.25);
  const Tree& piece = piece_of(forces);
  const auto strand = array(piece, "PointData", "strand"), partner = array(piece, "PointData", "partner_s"),
             s = array(piece, "PointData", "s"), size = array(piece, "PointData", "size"),
             place = array(piece, "Points", "Points"), touched = array(piece, "PointData", "touched");
  BOOST_TEST_REQUIRE(strand.size() == 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Map<const Eigen::Vector3d> r(&place[3 * i]), surface(&touched[3 * i]);
    BOOST_TEST((r - surface).norm() == 0.25, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(partner[i] == (strand[i] == 1.0 ? -s[i] : s[i]));
    if (strand[i] == 1.0) BOOST_TEST(size[i] == 0.125);
  }
}

BOOST_AUTO_TEST_CASE(the_cylinder_is_closed_and_leaves_room_for_the_rod) {
  auto scene = test::capstan_scene(T, phi);
  scene.rod_radius = 0.25;
  const Tree file = parse(output::vtk_cylinder(scene, -2.0, 3.0));
  const Tree& piece = piece_of(file);
  const auto r = array(piece, "Points", "Points"), corners = array(piece, "Polys", "connectivity");
  BOOST_TEST(corners.size() == 4 * count(piece, "Polys"));
  for (std::size_t i = 0; i < r.size(); i += 3)
    BOOST_TEST(std::abs(std::hypot(r[i], r[i + 1]) - 0.75) < 1e-12);
  for (const double corner : corners) BOOST_TEST(corner < static_cast<double>(count(piece, "Points")));
}

BOOST_AUTO_TEST_CASE(walls_are_rectangles_beside_the_rod) {
  auto scene = test::capstan_scene(T, phi);
  scene.has_cylinder = false;
  scene.walls = {{{0.0, 1.0, 0.0}, 0.05}, {{0.0, -1.0, 0.0}, 0.05}};
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.5, -0.05, 0.0), Eigen::Vector3d(0.5, 0.05, 0.0));
  const Tree file = parse(output::vtk_walls(obstacle::obstacles_of(scene), box, 0.01));
  const Tree& piece = piece_of(file);
  const auto r = array(piece, "Points", "Points"), normals = array(piece, "PointData", "Normals");
  BOOST_TEST_REQUIRE(count(piece, "Polys") == 2u);
  BOOST_TEST_REQUIRE(count(piece, "Points") == 8u);
  double least = 1.0, most = -1.0;
  for (std::size_t i = 0; i < r.size(); i += 3) {
    BOOST_TEST(std::abs(std::abs(r[i + 1]) - 0.06) < 1e-15);
    BOOST_TEST(std::abs(normals[i + 1]) == 1.0);
    least = std::min(least, r[i]), most = std::max(most, r[i]);
  }
  BOOST_TEST(least <= -0.5);
  BOOST_TEST(most >= 0.5);
}

BOOST_AUTO_TEST_CASE(a_collection_names_the_files_of_a_branch) {
  const test::TemporaryFolder temporary;
  test::write_synthetic_run(temporary / "run");
  const output::Run run = output::read_run(temporary / "run");
  const auto scene = test::capstan_scene(5.0, phi);
  const auto file = output::export_vtk(run, scene, {"BP1", "2-3"}, temporary / "vtk", "branch");
  const Tree tree = parse(output::read_file(file));
  std::size_t sets = 0;
  for (const auto& [tag, node] : tree.get_child("Collection")) {
    if (tag != "DataSet") continue;
    ++sets;
    BOOST_TEST(node.get<double>("<xmlattr>.timestep") < 2.0);
    BOOST_TEST(std::filesystem::exists(temporary / "vtk" / node.get<std::string>("<xmlattr>.file")));
  }
  BOOST_TEST(sets == 6u);
  BOOST_CHECK_THROW(output::export_vtk(run, scene, {"BP7"}, temporary / "vtk", "x"), output::OutputError);
}

BOOST_AUTO_TEST_SUITE_END()
