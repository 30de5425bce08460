#pragma once

#include <optional>

#include "windlass/equilibrium/rod_problem.hpp"
#include "windlass/equilibrium/solution.hpp"

/// From a scene to a first equilibrium.
namespace windlass::equilibrium {

/// There is no equilibrium in contact: followed to the scene's loads, the rod lifts off on the way.
class NoContact : public NoEquilibrium {
 public:
  using NoEquilibrium::NoEquilibrium;
};

struct Started {
  std::shared_ptr<RodProblem> problem;
  Vector x, p;
  int newton_iterations = 0;
};

/// One equilibrium from nothing. The contact topology is an outcome: first the closed form's (a line contact where it
/// can exist, else a touch), then the state reached from a higher tension by continuation through all contact events, and
/// last, because it takes seconds where these take milliseconds, discovered_start().
/// @throws NoEquilibrium
Started cold_start(const scene::Scene& scene, bool spatial, bool half, const std::vector<std::string>& keys);

/// A state of the branch in the pull on which `cold_start` finds a knot, where it is found from nothing: from there it would be
/// followed to the scene's pull. nullopt: none, or other ways lead to this scene.
/// @param lower, upper  pulls between which it is wanted [natural units]
std::optional<Started> knot_between(const scene::Scene& scene, bool half, const std::string& key,
                                    double lower, double upper);

/// An equilibrium on the contacts that complementarity on a fixed mesh finds (discovery.hpp). nullopt where it finds none,
/// or Newton does not converge on them.
std::optional<Started> discovered_start(const scene::Scene& scene, bool spatial, bool half,
                                        const std::vector<std::string>& keys);

/// The state of a flat thin rod (half chain) with its strands pressed apart to the scene's radius: its crossings become
/// touches with its own image, and the radius grows through every event on the way. As it is where nothing crosses.
/// @param failure  why there is none
std::optional<Started> thicken(const Started& flat, const scene::Scene& scene, bool half,
                               const std::vector<std::string>& keys, std::string& failure);

/// A thick rod relaxed as a discrete rod with smooth contact (discrete_rod/thick_minimiser.hpp), polished on exact arcs with the
/// contacts read off it.
/// @param curve    corners of the half s >= 0 that it starts on; empty: a helix
/// @param failure  why there is none
std::optional<Started> relaxed_start(const scene::Scene& scene, const std::vector<Eigen::Vector3d>& curve,
                                     const std::vector<std::string>& keys, std::string& failure);

/// A place or a stretch of rod that presses on an obstacle, as a discrete rod shows it.
struct Pressing {
  double begin = 0.0, end = 0.0;  ///< arclength; of a place the same [ρ]
  int obstacle = 0;               ///< its place among the scene's
  bool line() const { return end > begin; }
};

/// The state of a dragged rod on the contacts that a discrete rod shows, polished on exact arcs, and on those that follow
/// until all hold.
/// @param pressing  by increasing s, apart from each other
/// @param failure   why there is none
std::optional<Started> dragged_on(const scene::Scene& scene, const chain::Profile& shape,
                                  const std::vector<Pressing>& pressing, const std::vector<std::string>& keys,
                                  std::string& failure);

/// The planar state as a state of the Kirchhoff rod (half or full chain): equal up to discretisation.
Started lift(RodProblem& planar, const Vector& x, const Vector& p, bool half);

/// Mesh of the mirror image of an arc, and of the two as one.
chain::ArcMesh reversed(const chain::ArcMesh& mesh);
chain::ArcMesh spanning(const chain::ArcMesh& right);
/// The full chain of a symmetric state. @throws NoEquilibrium
Started unfold(RodProblem& halved, const Vector& x, const Vector& p, int iterations);
/// The same before it is solved: exact to what the mesh's nodes, which are those of the half and their images, know.
Started image_on_full_chain(RodProblem& halved, const Vector& x, const Vector& p);
/// A state of a full chain on the half chain of a symmetry; nullopt where that does not map it to itself.
std::optional<Started> fold(RodProblem& whole, const Vector& x, const Vector& p, chain::Symmetry symmetry);

/// Tails as they can be: a formula where a finite tail without torsion or moment at its end leaves a line contact
/// (stages = 0; its angle to the pull is then below π, see rod::TailArc), a mesh elsewhere.
/// @param s  places of the joints
void choose_tails(std::vector<chain::ArcMesh>& meshes, const Topology& topology, const chain::RodKind& rod,
                  const contact::Loads& loads, const std::vector<double>& s);

/// The same state with every tail on a mesh: a spectrum weighs the tails' motion. nullopt where no tail is in closed form.
/// @throws NoEquilibrium
std::optional<Started> with_meshed_tails(RodProblem& problem, const Vector& x, const Vector& p);

/// The scene key of the load that is given: load.tension, or for struts ends.shortening or load.thrust.
std::string load_key(const scene::Scene& scene);

/// A strut whose ends are not pushed together at all is straight, and its thrust is undetermined (anything up to the
/// buckling load). Such a scene becomes the one under no thrust; any other is returned as it is.
scene::Scene determinate(scene::Scene scene);

/// equilibria() without the others. @throws NoEquilibrium
Solution solve(const scene::Scene& scene);

}  // namespace windlass::equilibrium
