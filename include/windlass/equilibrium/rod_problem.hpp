#pragma once

#include <array>
#include <continuation/problem.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "windlass/chain/guess.hpp"
#include "windlass/chain/profile.hpp"
#include "windlass/chain/topology.hpp"
#include "windlass/equilibrium/snes_newton.hpp"
#include "windlass/obstacle/scene_obstacles.hpp"
#include "windlass/scene/scene.hpp"

/// Equilibria of a rod as the continuation library sees them.
namespace windlass::equilibrium {

struct ContactEvent;

using chain::Topology;
using continuation::Vector;

/// No equilibrium of the asked kind exists or was found; the message says which and why.
class NoEquilibrium : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Loads of a scene, and the rod it describes.
contact::Loads loads_of(const scene::Scene& scene);
chain::RodKind rod_of(const scene::Scene& scene, bool spatial);

/// One contact topology on one mesh. Parameters p are the scene keys given at construction, in that order.
class RodProblem final : public continuation::Problem {
 public:
  /// @param scene  in natural units (scene::natural)
  /// @param keys   dotted scene keys that p holds, e.g. {"load.tension", "load.angle"}
  RodProblem(scene::Scene scene, bool spatial, Topology topology, std::vector<chain::ArcMesh> meshes,
             std::vector<std::string> keys);

  Eigen::Index size() const override { return chain_->size(); }
  Vector residual(const Vector& x, const Vector& p) override;
  /// Closure of an arc of length ℓ < 1 in units of ℓ²: what an error there does to the arc's curvature.
  double residual_norm(const Vector& f) const override;
  void factor(const Vector& x, const Vector& p, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c,
              const Eigen::MatrixXd& d) override;
  Vector solve(const Vector& f, const Vector& g) override { return chain_->solve(f, g); }
  Vector solve_transposed(const Vector& f, const Vector& g) override { return chain_->solve(f, g, true); }
  /// Negative directions among those this chain can follow: a half chain counts even variations only, since its own
  /// equations stay regular where an odd mode becomes unstable. Reads the last factorisation.
  int index(const Vector& x, const Vector& p) override;
  /// Of a half chain: negative odd variations, which break the half-turn. Reads the last factorisation, after index().
  int breaking_index(const Vector& x, const Vector& p) override;
  /// The full chain of a half chain's state.
  std::optional<continuation::Unrestricted> unrestricted(const Vector& x, const Vector& p) override;
  /// Negative directions of the whole rod, both parities. Factors anew unless the last factorisation was made here.
  int total_index(const Vector& x, const Vector& p);
  /// The chain, its factors those made at this state; they are made anew unless the last ones were made there.
  const chain::Chain& factored(const Vector& x, const Vector& p);
  int determinant_sign() override { return chain_->determinant_sign(); }
  Vector retract(const Vector& x, const Vector& dx) const override { return chain_->retract(x, dx); }
  Vector parameter_derivative(const Vector& x, const Vector& p, Eigen::Index k) override;
  double inner(const Vector& a, const Vector& b) const override;
  Vector dual(const Vector& a) const override;
  std::vector<continuation::EventFunction> events(const Vector& x, const Vector& p) override;
  std::optional<continuation::Transition> transition(std::size_t which, const Vector& x,
                                                     const Vector& p) override;
  std::optional<continuation::Transition> resettled(const Vector& last, const Vector& last_p, const Vector& x,
                                                    const Vector& ahead) override;
  /// Lays touches inside lines between strands anew where they are too few, and adapts the mesh.
  std::optional<Vector> adapt(const Vector& x, const Vector& p) override;
  std::optional<Vector> adapt_mesh(const Vector& x, const Vector& p);
  std::optional<Vector> carried_over(const continuation::Problem& before, const Vector& x,
                                     const Vector& p) override;
  Vector fingerprint(const Vector& x, const Vector& p) override;
  continuation::BorderedNewton* newton() override { return &newton_; }
  std::shared_ptr<continuation::Problem> clone() const override;

  /// Relative error of R_tot (strut: end force): the change under one Newton step with one more stage an element.
  /// Asked again for the same state it answers from memory.
  double error_estimate(const Vector& x, const Vector& p);
  /// Remeshes until error_estimate() is below the scene's tolerance, or `rounds` are used; returns the new state.
  /// @throws NoEquilibrium if Newton fails on a refined mesh
  Vector refine(Vector x, const Vector& p, int rounds = 6);
  /// Solves from a guess at fixed p, in at most `most` corrections.
  /// @returns iterations used, or −1: no convergence, a singular matrix, or an iterate out of the domain
  int polish(Vector& x, const Vector& p, int most = 25);
  /// The same with borders; only a part of every correction is taken.
  continuation::CorrectorReport solve_from_guess(const continuation::Borders& borders,
                                                 continuation::Iterate& iterate, int most,
                                                 const SnesNewton::Part& part);
  /// Lets a full chain slide along itself until nothing holds it: Newton in the gauge's place c for λ(c) = 0, which stays
  /// well conditioned where sliding costs next to nothing. Done when λ is below 1e-10 of the pulls.
  bool settle(Vector& x, const Vector& p) override;
  /// A mode that is soft only while the rod is held against sliding along itself: see Chain::Gauges.
  std::string unsettled(const Vector& x, const Vector& dx) const override;
  /// d²Π/dδ² of a slide of the whole rod along itself; see Chain::sliding_stiffness.
  double sliding_stiffness(const Vector& x, const Vector& p);

  /// A turn of the whole rod; see Chain::expect_neutral_turn.
  continuation::Matrix neutral_motions(const Vector& x, const Vector& p) override;

  chain::Profile profile(const Vector& x, const Vector& p);
  /// Arclengths of the chain's joints; the ends of infinite tails where `shape`, the state's profile, ends.
  std::vector<double> joint_places(const Vector& x, const Vector& p, const chain::Profile& shape);
  contact::Loads loads(const Vector& p);
  Vector parameters() const;  ///< p of the scene itself
  scene::Scene scene_at(const Vector& p) const;
  /// Units of p and x: what they are multiplied with to give the user's numbers.
  const scene::Units& units() const { return scene_.solved_in; }
  /// A value of the parameter as the user knows it; differences of it likewise.
  double as_given(double p, std::size_t k = 0) const;

  const chain::Chain& chain() const { return *chain_; }
  chain::Chain& chain_to_factor() { return factored_x_.resize(0), *chain_; }
  const Topology& topology() const { return topology_; }
  const chain::RodKind& rod() const { return rod_; }
  const std::vector<chain::ArcMesh>& meshes() const { return meshes_; }
  const std::vector<std::string>& keys() const { return keys_; }
  bool spatial() const { return spatial_; }
  /// Are its equations built for these contacts, with the moment of the friction and the stretch that the scene asks for?
  bool admits(const Topology& topology) const { return !missing_on(topology); }
  /// The key of what is not built for these contacts; null: nothing.
  const char* missing_on(const Topology& topology) const;
  /// Does the friction of a cylinder that slides have a moment about the centre line, or may it get one?
  bool coupled() const;
  /// Does friction turn or stretch the rod along lines, or may it, so that their pressure has layers?
  bool layered() const;
  /// Does the cylinder slip along the rod? Its force then has no potential, and no index counts anything.
  bool dragged() const { return chain_->dragged(); }
  double last_error() const { return last_error_; }
  /// What earlier calls leave behind for later ones; a copy needs it to answer as this problem would.
  struct Memory {
    int index = -1, breaking_index = -1;
    double error = 0.0, nodal_floor = 0.0, error_floor = 0.0;
    bool slides = false;
    int sliding_off = 0;
    std::optional<int> sliding_reference;  ///< none before the first state counted while it slides
  };
  Memory memory() const {
    return {index_,       breaking_index_, last_error_,  nodal_floor_,
            error_floor_, slides_,         sliding_off_, sliding_reference_};
  }
  void remember(const Memory& memory) {
    index_ = memory.index;
    breaking_index_ = memory.breaking_index;
    last_error_ = memory.error;
    nodal_floor_ = memory.nodal_floor;
    error_floor_ = memory.error_floor;
    let_slide(memory.slides);
    sliding_off_ = memory.sliding_off;
    if (slides_) sliding_reference_ = memory.sliding_reference;
  }

  /// Quantity whose relative error is controlled: R_tot, or a strut's end force.
  double target(const chain::Chain& chain, const Vector& x, const contact::Loads& loads) const;

 private:
  /// Is this key one of those that the parameters are?
  bool varies(const char* key) const;
  /// What follows an event: its state, or where none is found a guess of the first that may follow.
  std::optional<continuation::Transition> after_event(const ContactEvent& event, const chain::Profile& shape,
                                                      const Vector& x, const Vector& p);
  void rebuild();
  /// Negative directions of one parity; counted once a state. The last factorisation, if it was not, was made there.
  /// Of eigenvalues whose sign rounding has made as many are counted as brings the count closest to `last`; −1: none.
  int count(const Vector& x, const Vector& p, contact::Parity parity, int last = -1);
  bool degenerate(const Vector& x, const contact::Loads& at) const;
  /// Of a dragged half chain: the sign of det J on odd motions, up to a factor of the mesh; 0: singular.
  int breaking_sign(const Vector& x, const Vector& p);
  /// Are the tails so short that they resist sliding by more than rounding?
  bool slides_freely(const Vector& x, const Vector& p);
  /// Lets the rod slide, or holds it, as its tails ask for. @returns whether its equations have changed
  bool choose_sliding(const Vector& x, const Vector& p);
  void let_slide(bool freely);
  /// Counts what sliding adds to the directions that may slide: all of a full chain, the odd ones of a half.
  void count_sliding(const Vector& x, const contact::Loads& at);
  /// Errors divided by what is allowed: of the target by the tolerance, of the nodes by the certificate's level.
  double excess(const Vector& x, const Vector& p);
  double nodal_goal() const;
  double bearable() const;  ///< nodal error that certificates, which see three times that, still pass
  /// After a refinement that asked for less than `error_before`.
  void note_rounding(double error_before);
  std::vector<chain::ArcMesh> new_meshes(const Vector& x, const contact::Loads& loads, double growth) const;
  std::optional<Vector> remeshed_where_needed(const Vector& x, const Vector& p);
  /// The state with the touches inside its lines between strands laid anew, where they are too few or far too many; nullopt, and nothing
  /// is changed, where they are not, or Newton fails.
  std::optional<Vector> laid_where_needed(const Vector& x, const Vector& p);
  /// The state on `meshes`, which replace the present ones. @throws NoEquilibrium if Newton fails there
  Vector carried_to(std::vector<chain::ArcMesh> meshes, const Vector& x, const Vector& p);
  /// The same; nullopt, and nothing is changed, where Newton fails or, with `within`, the errors there are too large.
  std::optional<Vector> moved_to(std::vector<chain::ArcMesh> meshes, const Vector& x, const Vector& p,
                                 bool within);

  /// Is this load not zero, or may it be?
  bool asks_for(double contact::Loads::*field) const;
  /// Does the rod lie in a plane by such contacts alone? The moment of the friction is then added on recording.
  bool flat(const Topology& topology) const;

  scene::Scene scene_;
  bool spatial_;
  Topology topology_;
  std::vector<chain::ArcMesh> meshes_;
  std::vector<std::string> keys_;
  chain::RodKind rod_;
  obstacle::MovingPlate second_plate_;  ///< among rod_'s obstacles, if there is one
  contact::Loads base_;
  std::vector<double contact::Loads::*> fields_;  ///< where each parameter lives; null: rebuilds the rod
  SnesNewton newton_;
  std::unique_ptr<chain::Chain> chain_, finer_;  ///< finer_: one more stage, for the error estimate
  std::vector<std::pair<Eigen::Index, double>>
      closures_;                    ///< rows and lengths of the last residual's short arcs
  Vector factored_x_, factored_p_;  ///< where chain_ was factored last; empty: unknown
  struct Counts {
    Vector x, p;                             ///< where; empty: nowhere
    std::array<int, 2> negative = {-1, -1};  ///< even, odd; −1: not counted
    std::array<int, 2> rounded = {0, 0};     ///< more may be: eigenvalues whose sign is rounding's
  } counts_;
  int index_ = -1, breaking_index_ = -1;  ///< last counts at a sound point
  bool slides_ = false;                   ///< see Chain::let_slide
  /// Negative directions that sliding adds to the count, and what that is less than 1 where the rod would slide off along itself:
  /// it goes on where the rod is let to slide, or no longer.
  int sliding_off_ = 0;
  std::optional<int> sliding_reference_;
  double last_error_ = 0.0;                       ///< relative, of the target
  double nodal_error_ = 0.0;                      ///< of frames and places at element ends
  double nodal_floor_ = 0.0, error_floor_ = 0.0;  ///< what refinement did not reduce of them: rounding
  double drift_floor_ = 0.0;          ///< what denser touches did not reduce of the drift of H, and of slopes
  Vector estimated_x_, estimated_p_;  ///< the state the two belong to
};

}  // namespace windlass::equilibrium
