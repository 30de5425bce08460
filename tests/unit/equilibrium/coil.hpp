#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "windlass/bvp/collocation_arc.hpp"
#include "windlass/chain/chain.hpp"
#include "windlass/contact/planar_joints.hpp"
#include "windlass/contact/spatial_joints.hpp"
#include "windlass/rod/closed_form_arcs.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"
#include "windlass/rod/surface_density.hpp"

/// Half of a coil with one line contact and a tail free of moment, with the exact planar state of infinite tails as
/// its first guess: the chain the solver tests share.
namespace windlass::test {

struct Coil {
  chain::Chain chain;
  Eigen::VectorXd x;
  contact::Loads loads;
};

inline contact::Loads coil_loads(double tension, double angle = 2.0 * std::numbers::pi) {
  contact::Loads loads;
  loads.tension = tension;
  loads.angle = angle;
  loads.half_length = 15.0;
  return loads;
}

/// Calls f(k, θ) for every interior node k of the tail, an arc of `elements` graded elements with `stages` stages.
template <class F>
void each_tail_node(const contact::Loads& loads, const std::vector<double>& mesh, int stages, F&& f) {
  const double beta = std::acos(1.0 - 0.5 / loads.tension), contact_end = 0.5 * loads.angle - beta;
  const Eigen::VectorXd lobatto = bvp::lobatto_points(stages);
  const int last = static_cast<int>(mesh.size() - 1) * stages;
  for (int k = 1; k < last; ++k) {
    const int e = k / stages, i = k % stages;
    const double sigma = mesh[e] + (i ? (mesh[e + 1] - mesh[e]) * lobatto(i) : 0.0);
    const double d = sigma * (loads.half_length - contact_end);
    f(k - 1,
      0.5 * loads.angle - 4.0 * std::atan(std::tan(beta / 4.0) * std::exp(-std::sqrt(loads.tension) * d)));
  }
}

inline std::vector<double> graded(int elements, double power) {
  std::vector<double> mesh;
  for (int i = 0; i <= elements; ++i) mesh.push_back(std::pow(static_cast<double>(i) / elements, power));
  return mesh;
}

inline Coil planar_coil(double tension, int elements = 12, int stages = 6) {
  using namespace contact::planar;
  const contact::Loads loads = coil_loads(tension);
  const std::vector<double> mesh = graded(elements, 1.5);
  std::vector<std::unique_ptr<contact::Joint>> joints;
  joints.push_back(std::make_unique<SurfaceSection>());
  joints.push_back(std::make_unique<Edge>(contact::Side::left));
  joints.push_back(std::make_unique<End>(contact::Side::left, false));
  std::vector<chain::Link> links;
  links.push_back({std::make_unique<rod::PlanarLineArc>(), "line", 0});
  links.push_back({bvp::make_collocation_arc(rod::PlanarDensity{}, mesh, stages), "tail", 1});
  Coil coil{chain::Chain(std::move(joints), {0.0, 0.0, 1.0}, std::move(links),
                         {.symmetry = contact::Symmetry::half_turn, .slide = true, .phase = {}}),
            {},
            loads};
  const double contact_end = 0.5 * loads.angle - std::acos(1.0 - 0.5 / tension);
  coil.x = Eigen::VectorXd::Zero(coil.chain.ambient_size());
  *coil.chain.coordinates(coil.x, 1) = contact_end;
  coil.chain.set_arclength(coil.x, 1, contact_end);
  *coil.chain.coordinates(coil.x, 2) = 0.5 * loads.angle;
  *coil.chain.force(coil.x, 0) = tension + 0.5;
  double* tail = coil.chain.interior(coil.x, 1);
  each_tail_node(loads, mesh, stages, [&](int k, double theta) { tail[k] = theta; });
  return coil;
}

inline Coil spatial_coil(double tension, int elements = 12, int stages = 6) {
  using namespace contact::spatial;
  const contact::Loads loads = coil_loads(tension);
  const std::vector<double> mesh = graded(elements, 1.5);
  std::vector<std::unique_ptr<contact::Joint>> joints;
  joints.push_back(std::make_unique<SurfaceSection>());
  joints.push_back(std::make_unique<Edge>(contact::Side::left, 1.0));
  joints.push_back(std::make_unique<End>(contact::Side::left, false));
  std::vector<chain::Link> links;
  links.push_back(
      {bvp::make_collocation_arc(rod::SurfaceDensity{}, graded(elements / 2, 1.0), stages), "line", 0});
  links.push_back({bvp::make_collocation_arc(rod::KirchhoffDensity{}, mesh, stages), "tail", 1});
  Coil coil{chain::Chain(std::move(joints), {0.0, 0.0, 1.0}, std::move(links),
                         {.symmetry = contact::Symmetry::half_turn,
                          .height = true,
                          .spin = true,
                          .slide = true,
                          .phase = {}}),
            {},
            loads};
  const double contact_end = 0.5 * loads.angle - std::acos(1.0 - 0.5 / tension);
  coil.x = Eigen::VectorXd::Zero(coil.chain.ambient_size());
  *coil.chain.coordinates(coil.x, 1) = contact_end;
  coil.chain.set_arclength(coil.x, 1, contact_end);
  Eigen::Map<Eigen::Vector4d>(coil.chain.coordinates(coil.x, 2)) = surface_frame(0.5 * loads.angle, 0.0, 0.0);
  *coil.chain.force(coil.x, 0) = tension + 0.5;
  double* tail = coil.chain.interior(coil.x, 1);
  each_tail_node(loads, mesh, stages, [&](int k, double theta) {
    Eigen::Map<Eigen::Vector4d>(tail + 4 * k) = surface_frame(theta, 0.0, 0.0);
  });
  return coil;
}

}  // namespace windlass::test
