#pragma once

#include <vector>

#include "windlass/chain/chain.hpp"
#include "windlass/chain/topology.hpp"

/// Meshes of lines that slip with the moment of their friction (rod/coupled_line_arc.hpp): their pressure has layers where it flows
/// in, as exp(−x/|w|) at a distance x from the edge, which are narrow beside all else.
namespace windlass::equilibrium {

/// Widths |w| of the layers at an arc's ends, over its length; 0: there is none.
struct Layers {
  double begin = 0.0, end = 0.0;
};
Layers layers_of(const chain::Chain& chain, const Eigen::VectorXd& x, const contact::Loads& loads, int link);

/// The mesh, finer where there are layers: equal error an element, as of a tail.
std::vector<double> fine_in_layers(std::vector<double> nodes, const Layers& layers, int stages);
/// Elements that a mesh has for its layers alone.
int elements_of_layers(const std::vector<double>& nodes, const Layers& layers, int stages);
/// Are the elements there too long by much?
bool layers_outgrown(const std::vector<double>& nodes, const Layers& layers, int stages);

/// All of a chain's.
std::vector<chain::ArcMesh> with_layers(const chain::Chain& chain, std::vector<chain::ArcMesh> meshes,
                                        const Eigen::VectorXd& x, const contact::Loads& loads);

}  // namespace windlass::equilibrium
