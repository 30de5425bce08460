#include "layer_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "windlass/rod/coupled_line_arc.hpp"

namespace windlass::equilibrium {

namespace {

/// An element in a layer is shorter than its width at the edge, over which a polynomial of degree 5 misses 2e-6 of exp(−x/w): with 1
/// forces of lines were off by up to 7e-8, with 0.7 by less than 1e-9 (R/r = 9, μ = 0.2, T from 0.45 to 0.3).
constexpr double part = 0.7;
/// Layers narrower than this part of a line are none.
constexpr double narrowest = 1e-9;

/// Length of an element that begins at a distance x from the edge: |p^(M)|^(1/M) goes as exp(−x/(M w)).
double element_at(double x, double width, int stages) {
  return part * width * std::exp(x / ((stages + 1) * width));
}

std::vector<double> turned(std::vector<double> nodes) {
  std::reverse(nodes.begin(), nodes.end());
  for (double& node : nodes) node = 1.0 - node;
  return nodes;
}

std::vector<double> fine_at_begin(const std::vector<double>& nodes, double width, int stages) {
  if (width < narrowest) return nodes;
  std::vector<double> out{0.0};
  std::size_t next = 1;  // of the coarse nodes, the first behind
  while (next < nodes.size()) {
    const double h = element_at(out.back(), width, stages);
    if (h >= nodes[next] - nodes[next - 1]) break;
    out.push_back(out.back() + h);
    while (next < nodes.size() && nodes[next] <= out.back()) ++next;
  }
  // No element much shorter than the one before.
  const double last = out.size() > 1 ? out.back() - out[out.size() - 2] : 0.0;
  if (next < nodes.size() && nodes[next] - out.back() < 0.5 * last && out.size() > 1) out.pop_back();
  if (out.back() >= 1.0) out.pop_back();
  for (; next < nodes.size(); ++next) out.push_back(nodes[next]);
  if (out.back() < 1.0) out.push_back(1.0);
  return out;
}

int elements_at_begin(const std::vector<double>& nodes, double width, int stages) {
  if (width < narrowest) return 0;
  int count = 0;
  for (std::size_t k = 1; k < nodes.size(); ++k)
    count += nodes[k] - nodes[k - 1] < 2.0 * element_at(nodes[k - 1], width, stages) &&
             element_at(nodes[k - 1], width, stages) < 2.0 / static_cast<double>(nodes.size());
  return count;
}

bool outgrown_at_begin(const std::vector<double>& nodes, double width, int stages) {
  if (width < narrowest) return false;
  constexpr double much = 1.5;
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const double wanted = element_at(nodes[k - 1], width, stages);
    if (wanted < 1.0 && nodes[k] - nodes[k - 1] > much * wanted) return true;
  }
  return false;
}

}  // namespace

Layers layers_of(const chain::Chain& chain, const Eigen::VectorXd& x, const contact::Loads& loads, int link) {
  const auto* line = dynamic_cast<const rod::CoupledLineArc*>(chain.link(link).arc.get());
  if (!line) return {};
  const chain::Chain::Placed placed = chain.place(x, loads, link);
  const auto [begin, end] = line->layers(placed.point());
  return {begin / std::abs(placed.length), end / std::abs(placed.length)};
}

std::vector<double> fine_in_layers(std::vector<double> nodes, const Layers& layers, int stages) {
  return turned(fine_at_begin(turned(fine_at_begin(nodes, layers.begin, stages)), layers.end, stages));
}

int elements_of_layers(const std::vector<double>& nodes, const Layers& layers, int stages) {
  return elements_at_begin(nodes, layers.begin, stages) +
         elements_at_begin(turned(nodes), layers.end, stages);
}

bool layers_outgrown(const std::vector<double>& nodes, const Layers& layers, int stages) {
  return outgrown_at_begin(nodes, layers.begin, stages) ||
         outgrown_at_begin(turned(nodes), layers.end, stages);
}

std::vector<chain::ArcMesh> with_layers(const chain::Chain& chain, std::vector<chain::ArcMesh> meshes,
                                        const Eigen::VectorXd& x, const contact::Loads& loads) {
  for (int i = 0; i < chain.link_count(); ++i)
    if (const Layers layers = layers_of(chain, x, loads, i); layers.begin > 0.0 || layers.end > 0.0)
      meshes[i].nodes = fine_in_layers(meshes[i].nodes, layers, meshes[i].stages);
  return meshes;
}

}  // namespace windlass::equilibrium
