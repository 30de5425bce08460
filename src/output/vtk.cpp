#include "windlass/output/vtk.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sheet.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/rod_curve.hpp"

namespace windlass::output {

namespace fs = std::filesystem;
using Eigen::Vector3d;

namespace {

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += format_number(value) + " ";
  return text;
}

std::string numbers(const std::vector<Vector3d>& values) {
  std::string text;
  for (const Vector3d& v : values) fmt::format_to(std::back_inserter(text), "{} {} {} ", v.x(), v.y(), v.z());
  return text;
}

template <class Values>
std::string array(const char* name, const Values& values) {
  const int width = std::is_same_v<Values, std::vector<Vector3d>> ? 3 : 1;
  return fmt::format(
      "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n{}\n"
      "</DataArray>\n",
      name, width, numbers(values));
}

/// Cells of `size` points each.
std::string cells(const char* kind, const std::vector<int>& connectivity, int size) {
  std::string text =
      fmt::format("<{}>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n", kind);
  for (const int point : connectivity) text += std::to_string(point) + " ";
  text += "\n</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n";
  for (std::size_t end = 1; size > 0 && end * size <= connectivity.size(); ++end)
    text += std::to_string(end * static_cast<std::size_t>(size)) + " ";
  return text + fmt::format("\n</DataArray>\n</{}>\n", kind);
}

std::string field(const std::vector<std::pair<const char*, double>>& values) {
  std::string text = "<FieldData>\n";
  for (const auto& [name, value] : values)
    text += fmt::format(
        "<DataArray type=\"Float64\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n",
        name, format_number(value));
  return text + "</FieldData>\n";
}

struct Counts {
  std::size_t points = 0, vertices = 0, lines = 0, polygons = 0;
};

std::string poly_data(const std::string& fields, const Counts& counts, const std::string& content) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<PolyData>\n{}<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n{}</Piece>\n</PolyData>\n</VTKFile>\n",
      fields, counts.points, counts.vertices, counts.lines, counts.polygons, content);
}

std::string points(const std::vector<Vector3d>& places) {
  return "<Points>\n" + array("Points", places) + "</Points>\n";
}

std::string fields_of(const equilibrium::Solution& solution, const scene::Scene& scene) {
  std::vector<std::pair<const char*, double>> values;
  if (solution.has_cylinder)
    values = {{"T", solution.T}, {"phi", solution.phi}, {"R_tot", solution.R_tot}};
  else
    values = {{"end_force", solution.end_force}, {"shortening", solution.shortening}};
  values.emplace_back("rod_radius", scene.rod_radius);
  if (scene.units) {
    values.emplace_back("unit_length_mm", scene.units->length * 1e3);
    values.emplace_back("unit_force_N", scene.units->force);
  }
  return field(values);
}

std::string rod_text(const RodCurve& curve, const equilibrium::Solution& solution, double rod_radius,
                     const std::string& fields) {
  std::vector<Vector3d> d1, d2, d3;
  std::vector<double> contact;
  std::vector<int> along;
  for (std::size_t i = 0; i < curve.s.size(); ++i) {
    const Eigen::Matrix3d frame = curve.q[i].toRotationMatrix();
    d1.push_back(frame.col(0)), d2.push_back(frame.col(1)), d3.push_back(frame.col(2));
    contact.push_back(solution.arcs[curve.arc[i]].kind == equilibrium::ArcKind::line ? 1.0 : 0.0);
    along.push_back(static_cast<int>(i));
  }
  const std::string data = "<PointData Scalars=\"pressure\" Vectors=\"d3\">\n" + array("s", curve.s) +
                           array("pressure", curve.p) + array("contact", contact) +
                           array("radius", std::vector<double>(curve.s.size(), rod_radius)) +
                           array("d1", d1) + array("d2", d2) + array("d3", d3) + array("force", curve.n) +
                           array("moment", curve.m) + "</PointData>\n";
  return poly_data(fields, {curve.s.size(), 0, 1, 0},
                   data + points(curve.r) + cells("Lines", along, static_cast<int>(along.size())));
}

std::string forces_text(const std::vector<PointForce>& forces, double rod_radius, const std::string& fields) {
  std::vector<Vector3d> places, touched, vectors;
  std::vector<double> sizes, s, strand, partner;
  std::vector<int> vertices;
  for (const PointForce& force : forces) {
    places.push_back(force.r), vectors.push_back(force.size * force.direction);
    sizes.push_back(force.size), s.push_back(force.s);
    touched.push_back(force.r - rod_radius * force.direction);
    strand.push_back(force.partner ? 1.0 : 0.0), partner.push_back(force.partner.value_or(force.s));
    vertices.push_back(static_cast<int>(vertices.size()));
  }
  const std::string data = "<PointData Scalars=\"size\" Vectors=\"force\">\n" + array("s", s) +
                           array("size", sizes) + array("force", vectors) + array("touched", touched) +
                           array("strand", strand) + array("partner_s", partner) + "</PointData>\n";
  return poly_data(fields, {places.size(), places.size(), 0, 0},
                   data + points(places) + cells("Verts", vertices, 1));
}

}  // namespace

VtkRod vtk_rod(const equilibrium::Solution& solution, const scene::Scene& scene) {
  const std::string fields = fields_of(solution, scene);
  double length = 0.0;
  for (const auto& arc : solution.arcs)
    if (arc.s.size() > 0) length += arc.s.tail<1>()[0] - arc.s[0];
  const RodCurve curve = dense_curve(solution, std::min(0.05, length / 200.0));
  return {rod_text(curve, solution, scene.rod_radius, fields),
          forces_text(point_forces(solution), scene.rod_radius, fields)};
}

std::string vtk_cylinder(const scene::Scene& scene, double low, double high) {
  constexpr int around = 96;
  const double radius = 1.0 - scene.rod_radius;
  std::vector<Vector3d> places, normals;
  std::vector<int> quads;
  for (int k = 0; k <= around; ++k) {
    const double angle = 2.0 * M_PI * k / around;
    const Vector3d normal(std::cos(angle), std::sin(angle), 0.0);
    for (const double z : {low, high})
      places.push_back(radius * normal + z * Vector3d::UnitZ()), normals.push_back(normal);
    if (k < around)
      for (const int corner : {0, 2, 3, 1}) quads.push_back(2 * k + corner);
  }
  return poly_data("", {places.size(), 0, 0, around},
                   "<PointData Normals=\"Normals\">\n" + array("Normals", normals) + "</PointData>\n" +
                       points(places) + cells("Polys", quads, 4));
}

std::string vtk_walls(const obstacle::Set& obstacles, const Eigen::AlignedBox3d& box, double rod_radius) {
  std::vector<Vector3d> places, normals;
  std::vector<int> quads;
  for (int o = 0; o < obstacles.size(); ++o)
    for (const Vector3d& corner : sheet_of(obstacles[o], box, rod_radius)) {
      quads.push_back(static_cast<int>(places.size()));
      places.push_back(corner), normals.push_back(obstacles[o].normal(corner));
    }
  return poly_data("", {places.size(), 0, 0, quads.size() / 4},
                   "<PointData Normals=\"Normals\">\n" + array("Normals", normals) + "</PointData>\n" +
                       points(places) + cells("Polys", quads, 4));
}

namespace {

std::string data_set(std::size_t time, int part, const char* title, const std::string& file) {
  return fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", time,
                     part, title, file);
}

/// Height of the part of the rod near the cylinder; tails run far beyond.
void include_height(const equilibrium::Solution& solution, double& low, double& high) {
  for (const auto& arc : solution.arcs)
    for (Eigen::Index i = 0; i < arc.s.size(); ++i)
      if (arc.r.col(i).head<2>().norm() < 1.5)
        low = std::min(low, arc.r(2, i) - 1.0), high = std::max(high, arc.r(2, i) + 1.0);
}

}  // namespace

fs::path export_vtk(const Run& run, const scene::Scene& scene, const std::vector<std::string>& names,
                    const fs::path& folder, const std::string& stem) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError("cannot make the folder " + folder.string() + ": " + error.message());
  std::string sets;
  double low = -1.0, high = 1.0;
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const equilibrium::Solution solution = run.points.get(names[k]);
    if (solution.arcs.empty()) throw OutputError("the point " + names[k] + " holds no rod to export");
    const VtkRod rod = vtk_rod(solution, scene);
    replace_file(folder / ("rod-" + names[k] + ".vtp"), std::string_view(rod.rod));
    sets += data_set(k, 0, "rod", "rod-" + names[k] + ".vtp");
    const bool beside_obstacles = scene.has_cylinder || !scene.walls.empty();
    if (beside_obstacles || scene.self_contact) {
      replace_file(folder / ("forces-" + names[k] + ".vtp"), std::string_view(rod.forces));
      sets += data_set(k, 1, "forces", "forces-" + names[k] + ".vtp");
    }
    if (!beside_obstacles) continue;
    sets += scene.has_cylinder ? data_set(k, 2, "cylinder", "cylinder.vtp")
                               : data_set(k, 2, "walls", "walls.vtp");
    include_height(solution, low, high);
    for (const auto& arc : solution.arcs)
      for (Eigen::Index i = 0; i < arc.r.cols(); ++i) box.extend(Vector3d(arc.r.col(i)));
  }
  if (scene.has_cylinder)
    replace_file(folder / "cylinder.vtp", std::string_view(vtk_cylinder(scene, low, high)));
  else if (!scene.walls.empty())
    replace_file(folder / "walls.vtp",
                 std::string_view(vtk_walls(obstacle::obstacles_of(scene), box, scene.rod_radius)));
  const fs::path collection = folder / (stem + ".pvd");
  replace_file(collection,
               std::string_view("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                                "byte_order=\"LittleEndian\">\n<Collection>\n" +
                                sets + "</Collection>\n</VTKFile>\n"));
  return collection;
}

}  // namespace windlass::output
