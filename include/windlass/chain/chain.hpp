#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "windlass/bvp/arc.hpp"
#include "windlass/chain/block.hpp"
#include "windlass/chain/block_factors.hpp"
#include "windlass/chain/coupling.hpp"
#include "windlass/contact/joint.hpp"

/// A rod as a chain of arcs and joints: assembly, factorisation and solution of its equilibrium equations.
namespace windlass::chain {

using bvp::Arc;
using contact::Joint;
using contact::Loads;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One arc of a chain with the data that make it part of it.
struct Link {
  std::unique_ptr<Arc> arc;
  std::string role;   ///< "line", "gap" or "tail"
  int pull = 0;       ///< 0: n unknown; ±1: n is the dead pull of the right end / minus the left one's
  bool weld = false;  ///< of no length: the joints at its ends are one place, with the same unknowns
};

/// What lets a rod rest on a cylinder that slips along it (PHYSICS, "Steady sliding"): an unknown in the place of the force
/// that holds the rod against sliding along itself, for that slide now costs friction.
enum class Travel {
  none,     ///< the cylinder stands
  blocked,  ///< τ: the right end is pulled by T + τ, the left one by T − τ
  free      ///< ω: equal pulls, the rod runs along itself
};

/// Layout of a chain's unknowns.
///
/// State x (ambient): for each joint its coordinates and, where it locates itself, its arclength s; where sliding is held,
/// the place c and the holding force λ (Gauges); for each link with unknown n that n; then the interior configurations of
/// every arc. Increments dx follow the same order with tangent sizes, less what gauges and symmetry keep (and c, which is
/// given). The first block (joints and forces, `dense_size()`) couples the arcs; the rest is condensed arc by arc.
///
/// Contacts of the rod with itself couple any two joints; each has its force λ in the state, after the gauge's.
///
/// Places of contacts, their arclengths and coordinates on the cylinder, are kept to twice the digits of a double: each has
/// a rest beside it in the state. The forces in an arc of length ℓ between two contacts follow from the difference of their
/// places, divided by ℓ³: to full precision in arcs that have just opened, too.
///
/// Count of equations, the same as of unknowns: a joint gives one balance equation a coordinate and one location
/// condition if it locates; sliding gives its gauge for λ; a link with unknown n gives dim(n) closure equations X_b − X_a = ∫ d ds; an arc gives its
/// interior collocation equations.
class Chain {
 public:
  /// Rigid motions that cost nothing, and what holds them. At an equilibrium nothing pulls along them, so that a coordinate
  /// and its equation may be left out (translation, spin), or the motion's generator be added to the matrix (phase). In
  /// variations, whose eigenvalues must not prefer one side, the mean spin of the outermost contacts is held instead.
  /// Sliding of the rod along itself costs T exp(−2√(T/B) L_tail) or so, next to nothing for long tails: the mean arclength of the
  /// outermost contacts is held, ½(s_first + s_last) = c, by forces λ/2 round the cylinder at these two. They are zero at
  /// an equilibrium; see RodProblem::settle.
  struct Gauges {
    /// Of a half chain: it maps the first joint to itself, at s = 0, and holds that one's odd motions.
    std::optional<contact::Symmetry> symmetry = {};
    bool height = false;  ///< translation along the axis
    bool along = false;   ///< translation along e_x (both ends of a free rod under a dead thrust)
    bool spin = false;    ///< turn of every section about its tangent
    bool slide = false;
    bool knot = false;  ///< the same of a knot round nothing, in variations alone: see knot_slide.cpp
    Travel travel = Travel::none;
    std::optional<double> phase;  ///< turn of the rod by α about e_x, with a spin of phase·α
  };

  /// @param joints  links.size() + 1 of them; fixed_s gives the arclength of joints that do not locate themselves,
  ///                as a multiple of loads.half_length (−1, 0 or 1); an infinite tail's far joint counts as ±infinity.
  Chain(std::vector<std::unique_ptr<Joint>> joints, std::vector<double> fixed_s, std::vector<Link> links,
        const Gauges& gauges, std::vector<Coupling> couplings = {});

  Eigen::Index ambient_size() const { return ambient_size_; }
  Eigen::Index size() const { return size_; }
  Eigen::Index dense_size() const { return dense_size_; }
  /// Length of the leading part of an increment that holds joint coordinates and arclengths.
  Eigen::Index geometric_size() const { return geometric_size_; }
  /// Row of a joint's location condition, and place of its arclength in an increment; −1: it does not locate itself.
  Eigen::Index arclength_row(int joint) const { return numbering_.location[joint]; }
  /// First of a link's closure equations, and place of its unknown force in an increment; −1: the force is given.
  Eigen::Index closure_row(int link) const { return numbering_.force[link]; }
  bool is_contact(int joint) const {
    return joints_[joint]->kind() == contact::JointKind::touch ||
           joints_[joint]->kind() == contact::JointKind::edge;
  }
  /// Does it touch an obstacle, and not another strand of the rod?
  bool on_obstacle(int joint) const { return is_contact(joint) && joints_[joint]->surface() != nullptr; }
  const std::vector<Coupling>& couplings() const { return couplings_; }
  /// Of a joint, its place among the couplings; −1: none.
  int coupling_of(int joint) const { return coupling_of_[joint]; }
  /// Is a joint at the place of the one before, with its unknowns?
  bool shares_place(int joint) const { return joint > 0 && links_[joint - 1].weld; }
  /// Does a joint touch along a line between strands?
  bool along_strand(int joint) const {
    return coupling_of_[joint] >= 0 && couplings_[coupling_of_[joint]].along;
  }
  /// Force λ of a coupling.
  double strand_force(const VectorXd& x, int coupling) const { return x(strand_at_[coupling]); }
  double& strand_force(VectorXd& x, int coupling) const { return x(strand_at_[coupling]); }
  /// The two strands at a coupling, the second as it is seen from the first.
  struct Crossing {
    Coupling coupling;
    contact::Centreline first, second;
    Eigen::Vector3d direction;  ///< e
    double distance = 0.0;      ///< |D|
    /// Direction of the force on a joint, one of the two.
    Eigen::Vector3d push_on(int joint) const {
      return joint == coupling.first ? direction : Eigen::Vector3d(-coupling.image().cwiseProduct(direction));
    }
  };
  Crossing crossing(const VectorXd& x, int coupling) const;
  /// Is the arclength of this joint unknown?
  bool locates(int joint) const { return joints_[joint]->locates() && !(half() && joint == 0); }
  /// Does a gauge hold the rod against sliding along itself in the equilibrium equations?
  bool holds_slide() const { return slide_at_ >= 0; }
  /// Place c of that gauge [ρ], and the force λ that it needs [EI/ρ²].
  double& slide_place(VectorXd& x) const { return x(slide_at_); }
  /// Where the tails are short enough to resist, sliding is an unknown like others: λ = 0 is the equation in place of the
  /// gauge, and c what comes of it. A load that turns where the rod would slide off is then a fold.
  void let_slide(bool freely) { slides_ = freely && slide_at_ >= 0; }
  bool slides() const { return slides_; }
  double slide_place(const VectorXd& x) const { return x(slide_at_); }
  double holding_force(const VectorXd& x) const {
    return holds_slide() && gauges_.travel == Travel::none ? x(slide_at_ + 1) : 0.0;
  }
  /// Does a cylinder slip along the rod?
  bool dragged() const { return gauges_.travel != Travel::none; }
  /// τ or ω, see Travel; none on a half chain: the mirror turns a way along the rod round, and they vanish.
  Travel travel() const { return half() ? Travel::none : gauges_.travel; }
  double travelled(const VectorXd& x) const { return travel() == Travel::none ? 0.0 : x(slide_at_ + 1); }
  void set_travelled(VectorXd& x, double value) const {
    if (travel() != Travel::none) x(slide_at_ + 1) = value;
  }
  /// Length of a link: the difference of its ends' arclengths, without loss of digits where they are close.
  double length(const VectorXd& x, const Loads& loads, int link) const;
  /// Row of the gauge, and place of λ in an increment.
  Eigen::Index slide_row() const { return numbering_.slide; }
  /// Share of joint j in the gauge: ½, ½; 1 where one contact is all there is.
  double slide_share(int joint) const;
  int joint_count() const { return static_cast<int>(joints_.size()); }
  int link_count() const { return static_cast<int>(links_.size()); }
  const Joint& joint(int j) const { return *joints_[j]; }
  const Link& link(int i) const { return links_[i]; }

  // Views of a state.
  const double* coordinates(const VectorXd& x, int joint) const { return x.data() + joint_at_[joint]; }
  double* coordinates(VectorXd& x, int joint) const { return x.data() + joint_at_[joint]; }
  double arclength(const VectorXd& x, const Loads& loads, int joint) const;
  void set_arclength(VectorXd& x, int joint, double s) const;
  VectorXd force(const VectorXd& x, const Loads& loads, int link) const;
  /// The same where the link ends: less by its weight. Not of links that slip.
  VectorXd end_force(const VectorXd& x, const Loads& loads, int link) const;
  /// Outward point force on the rod at a touch, from the forces on its two sides; on the half-turn's axis the other side
  /// is the image of this one.
  double touch_force(const VectorXd& x, const Loads& loads, int joint) const;
  /// Force of a layer of pressure at the edge of a line.
  double edge_layer(const VectorXd& x, const Loads& loads, int joint) const {
    return joints_[joint]->flux(coordinates(x, joint), loaded(x, loads, joint));
  }
  double* force(VectorXd& x, int link) const { return x.data() + force_at_[link]; }
  double* interior(VectorXd& x, int link) const { return x.data() + interior_at_[link]; }
  const double* interior(const VectorXd& x, int link) const { return x.data() + interior_at_[link]; }

  /// Everything needed to evaluate one arc; keeps the attachments alive.
  struct Placed {
    contact::Attachment left, right;
    VectorXd n;
    const double* interior = nullptr;
    double length = 0.0, friction = 0.0, travel = 0.0, compliance = 0.0, arm = 0.0;
    VectorXd weight = {};  ///< conjugate to n; empty: none
    bvp::ArcPoint point() const {
      return {left.q.data(),
              right.q.data(),
              interior,
              n.data(),
              length,
              friction,
              travel,
              compliance,
              weight.size() > 0 ? weight.data() : nullptr,
              arm};
    }
  };
  /// @throws std::domain_error if a tail's length is not positive.
  Placed place(const VectorXd& x, const Loads& loads, int link) const;

  VectorXd retract(const VectorXd& x, const VectorXd& dx) const;
  VectorXd residual(const VectorXd& x, const Loads& loads) const;

  /// Factors [J B; Cᵀ D] at (x, loads); B, C: size()×k, D: k×k. @throws std::runtime_error if singular.
  void factor(const VectorXd& x, const Loads& loads, const MatrixXd& b, const MatrixXd& c, const MatrixXd& d);
  /// A turn of the whole rod may cost nothing while it is flat: about e_x if it is odd under the half-turn, about e_y if even.
  /// Its eigenvalue then does not count as negative, and where it makes the matrix singular (a half chain's only if the turn
  /// is even) solutions have no part along it.
  void expect_neutral_turn(contact::Parity parity) { neutral_turn_ = parity; }
  /// That turn as an increment of unit size, where the rod is flat or nearly so; empty: none.
  VectorXd nearly_neutral_turn(const VectorXd& x, const Loads& loads) const;
  /// A flat rod that nothing pushes out of its plane stays there, exactly, however little that would cost.
  VectorXd solve(const VectorXd& f, const VectorXd& g, bool transposed = false) const;
  int determinant_sign() const { return determinant_sign_; }

  /// Number of negative directions of the second variation on the active contacts, by inertia of the factorisation
  /// made by the last factor() at (x, loads); `odd` counts the variations of the other parity at a symmetry point.
  int index(const VectorXd& x, const Loads& loads, contact::Parity parity) const {
    return inertia(x, loads, parity).negative;
  }
  struct Inertia {
    int negative = 0;
    bool near_rounding =
        false;  ///< a pivot is so small that rounding may have made its sign; see Variation::doubt
  };
  Inertia inertia(const VectorXd& x, const Loads& loads, contact::Parity parity) const;

  /// Eigenvalues of variations smaller than this are the zero of an arc that is about to buckle by itself; 0: no such
  /// arc [EI/ρ²].
  double neutral_size(const VectorXd& x, const Loads& loads) const;

  /// Second derivative of the energy with a slide δ of the whole rod along itself, everything else at rest under its
  /// contacts: d²Π/dδ² [EI/ρ³], from the last factor() at (x, loads). Zero without a slide to hold.
  double sliding_stiffness(const VectorXd& x, const Loads& loads) const;

  /// The second variation as a sparse symmetric matrix with its metric, for the spectrum. Size: see `constraints`.
  struct SecondVariation {
    Eigen::SparseMatrix<double> matrix;  ///< symmetric, indefinite (multipliers)
    Eigen::SparseMatrix<double>
        metric;           ///< ∫ |δ(rotation)|² ds; zero for multipliers and mere shifts of a touch
    int constraints = 0;  ///< negative directions owed to multipliers and to touch locations
  };
  SecondVariation second_variation(const VectorXd& x, const Loads& loads, contact::Parity parity) const;

  /// Of a dragged state: its linearisation with the contacts held that are active, edges where they are, and the metric of
  /// variations. Neither symmetric nor definite; multipliers and locations weigh nothing.
  struct DraggedVariation {
    Eigen::SparseMatrix<double> matrix, metric;
  };
  DraggedVariation dragged_variation(const VectorXd& x, const Loads& loads) const;

  /// Largest entry of an increment at the joints and at element ends, where collocation is superconvergent.
  double nodal_norm(const VectorXd& dx) const;

  /// The increment's part of a vector of that space (zero where the two differ: odd coordinates), to draw a mode.
  VectorXd as_increment(const VectorXd& variation, contact::Parity parity) const;

  /// ∂F/∂x without condensation, for libraries that want a matrix and for tests. Exact at an equilibrium; elsewhere
  /// it lacks the commutators of interior frames, which are proportional to the residual there.
  Eigen::SparseMatrix<double> jacobian(const VectorXd& x, const Loads& loads) const;

 private:
  friend class Linearisation;
  friend class Variation;
  /// Which unknowns the dense block holds: those of equilibrium, or those of a variation at fixed contact edges.
  enum class Purpose { equilibrium, even, odd };
  /// Does the chain start at a symmetry point, so that variations of the other parity are to be counted too?
  bool half() const { return gauges_.symmetry.has_value(); }
  /// Do variations of this purpose include translations along the axis, turns about e_x and spins?
  bool spins(Purpose purpose) const {
    return !half() || contact::reverses_height(*gauges_.symmetry) == (purpose == Purpose::odd);
  }
  /// One arc's share of the dense block.
  struct Local {
    std::vector<Eigen::Index> dofs;  ///< places of the local unknowns in the dense block
    MatrixXd columns;                ///< ends × dofs: change of the arc's ends per unknown
    MatrixXd rows;                   ///< ends × dofs: weights of the end equations in each dense equation
  };
  /// Places of joint coordinates, of arclengths (the unknowns of location conditions), of forces, and of what the gauges of
  /// sliding and phase add, in a dense block.
  struct Numbering {
    std::vector<Eigen::Index> coordinate, location, force, strand;  ///< −1 where absent
    Eigen::Index slide = -1, spin = -1, height = -1, phase = -1;
    Eigen::Index together = -1;  ///< the place of all touches that move along the rod alike
    Eigen::Index size = 0, geometric = 0;
    int constraints = 0;  ///< multipliers and touch locations: one negative direction each
  };

  /// @param together  of variations: touches that stay where they are move along the rod, all alike
  Numbering number(Purpose purpose, bool together = false) const;
  void couple();
  void keep_coordinates();
  /// Coordinates of a joint that vary.
  const std::vector<int>& kept(Purpose purpose, int joint) const {
    if (purpose == Purpose::equilibrium) return kept_[joint];
    if (half() && joint > 0) return varied_[joint];
    return purpose == Purpose::odd ? odd_ : half() ? even_ : varied_[joint];
  }
  /// Motion of the phase gauge as an increment: dense block, then interiors.
  VectorXd phase_motion(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                        const Loads& loads) const;
  bool holds_knot(const Numbering& numbering) const { return gauges_.knot && numbering.slide >= 0; }
  /// What the gauge of a knot holds, a linear form over dense block and interiors: one for a slide by a unit of length.
  VectorXd slid_by(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads) const;
  /// How much the rod is stretched where a cylinder slips along it at a joint, and its derivatives.
  struct StretchAt {
    double value = 1.0;  ///< λ = 1 + k n·t, n the mean of the forces on the two sides where it is free
    contact::SmallVector by_w = {};  ///< tangent
    contact::SmallVector by_n = {};  ///< with the force of either side, 3
    std::vector<int> links = {};     ///< of the free sides
  };
  StretchAt stretch_at(const VectorXd& x, const Loads& loads, int joint) const;
  /// The loads with the speed of the rod along itself at a joint, where ω is an unknown; valid until the next call.
  const Loads& loaded(const VectorXd& x, const Loads& loads, int joint) const {
    if (travel() != Travel::free) return loads;
    with_travel_ = loads;
    with_travel_.travel = x(slide_at_ + 1);
    if (loads.compliance != 0.0) with_travel_.travel *= stretch_at(x, loads, joint).value;
    return with_travel_;
  }
  /// n where a link ends.
  contact::SmallVector force_at_end(const VectorXd& x, const Loads& loads, int link,
                                    const contact::SmallVector& n, const bvp::EndsVector& gradient) const;
  /// Weight of a link a length, conjugate to its n.
  VectorXd weight_on(const Loads& loads, int link) const;
  /// Adds how n falls with a link's length to what its end takes of it.
  void add_weight(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
                  int link, Block& dense) const;
  /// What the stretch of the rod adds to a joint's location condition; `side` as in Joint::Location.
  std::optional<Joint::Stretching> stretching(const VectorXd& x, const Loads& loads, int joint,
                                              contact::Side side) const;
  void add_stretching(const VectorXd& x, const Loads& loads, int joint, Block& dense) const;
  /// Adds a joint's terms to its balance equations, of the coordinates that vary.
  void add_kept(const contact::SmallVector& by_w, int joint, VectorXd& f) const;
  /// What the joint on one side of a link takes of a line's own normal force; see Joint::drag.
  std::optional<Joint::Drag> drag_at(const VectorXd& x, const Loads& loads, int link,
                                     contact::Side side) const;
  /// The loads with the pull at an end, T ± τ where τ is an unknown.
  Loads pulled(const VectorXd& x, const Loads& loads, int joint) const;
  /// Change of a given pull's n with τ; zero for other links.
  VectorXd force_by_travel(const Loads& loads, int link) const;
  /// Adds the change with τ or ω of what a joint takes from the arc on one side to the travel's column.
  void add_travel(const VectorXd& x, const Loads& loads, int link, contact::Side side,
                  const contact::SmallVector& gradient, const contact::SmallVector& force,
                  Block& dense) const;
  contact::Attachment attachment(Purpose purpose, const VectorXd& x, const Loads& loads, int joint,
                                 contact::Side side) const;
  Local local(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
              int link) const;
  /// Dense terms that do not come from an arc's condensed Hessian: curvature of attachments, closure, location.
  void add_joint_terms(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
                       int link, const bvp::EndsVector& gradient, Block& dense) const;
  void add_locations(const VectorXd& x, const Loads& loads, Block& dense) const;
  contact::SmallVector by_pull(const VectorXd& x, const Loads& loads, int end) const;
  void add_pulled(const VectorXd& x, const Loads& loads, Block& dense) const;
  /// Rows that hold a dragged rod against sliding along itself in variations.
  VectorXd held_at_ends(const VectorXd& x, const Loads& loads) const;
  VectorXd held_at_contacts(const VectorXd& x) const;
  void add_gauges(const Numbering& numbering, Purpose purpose, const VectorXd& x, Block& dense) const;
  /// An unknown of a dense block that acts on an arc's interior.
  struct Coupled {
    Eigen::Index row;
    VectorXd along;  ///< interior_tangent
  };
  /// The same, `along` reduced to the arc's ends, and K⁻¹ of it in the interior.
  struct Border {
    Eigen::Index row;
    VectorXd reduced, solved;
  };
  /// Adds to a dense block what is left of such unknowns when the arc's interior is condensed.
  static std::vector<Border> add_borders(const Arc& arc, const Local& local,
                                         const std::vector<Coupled>& coupled, Block& dense);
  /// One more unknown of the dense block for each direction that the arc's factors hold; see bvp::Held.
  static std::vector<Coupled> held_by(const Arc& arc, Block& dense);
  /// The dense block of a variation, interiors condensed by the arcs' last factorisations; symmetric.
  Block condensed_variation(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                            const Loads& loads, const std::vector<const Arc*>& arcs,
                            const std::vector<bvp::EndsMatrix>& condensed) const;
  std::vector<const Arc*> arcs() const;
  /// Is this the arc between a clamp and a line along it, which is about to buckle by itself, at any load
  /// (contact::spatial::FreeRodEnd)? Or that between a clamp and a touch where the line begins, free of moment at both
  /// ends? Its mode, zero at both ends, costs nothing to second order: a pivot of the interior alone is zero, with a sign
  /// that the mesh makes.
  bool neutral(const VectorXd& x, const Loads& loads, int link) const;
  /// The neutral arc as factored where it is this much shorter: the mode then costs 2·1e-6 of the thrust, thousands of
  /// times what mesh and state make of the zero (1e-8, PHYSICS "Struts between walls"), and other modes change by as
  /// little.
  static constexpr double shortened_by = 1e-6;
  std::unique_ptr<Arc> shortened(const VectorXd& x, const Loads& loads, int link,
                                 bvp::EndsMatrix& condensed) const;
  /// What one arc, condensed, adds to that block at its local unknowns.
  MatrixXd condensed_share(Purpose purpose, const Local& local, const Arc& arc,
                           const bvp::EndsMatrix& condensed, int link) const;
  contact::Joint::Location location(const VectorXd& x, int joint) const;
  /// Of the couplings: their forces and conditions, to a residual; their derivatives, to a dense block.
  void add_strand_forces(const VectorXd& x, const Loads& loads, VectorXd& f) const;
  void add_couplings(Purpose purpose, const Numbering& numbering, const VectorXd& x, Block& dense) const;
  /// Adds what those forces drag where the cylinder slips: to a residual, and its derivatives to the equilibrium's block.
  void add_dragged_pushes(const VectorXd& x, const Loads& loads, VectorXd& f) const;
  void add_dragged_pushes(const VectorXd& x, const Loads& loads, Block& dense) const;
  /// X_b − X_a of a link's ends.
  contact::SmallVector rise(const VectorXd& x, const Placed& placed, int link) const;
  /// Adds to a contact's place, rests included.
  void move_contact(const VectorXd& x, int joint, const double* step, double ds, VectorXd& out) const;
  /// Condensed Hessian plus the part that is antisymmetric because frames do not commute.
  static bvp::EndsMatrix with_commutator(const Arc& arc, const bvp::EndsMatrix& symmetric,
                                         const bvp::EndsVector& gradient);
  /// Map from a dense block and the interiors to one arc's list (interior, ends).
  Eigen::SparseMatrix<double> scatter(const MatrixXd& ends, const Local& local, Eigen::Index dense,
                                      int link) const;
  Eigen::SparseMatrix<double> material_metric(const Numbering& numbering, const Placed& placed,
                                              const Eigen::SparseMatrix<double>& map, int link) const;
  Eigen::SparseMatrix<double> sparse_hessian(Purpose purpose, const Placed& placed, int link) const;
  Block variation_matrix(Purpose purpose, const Numbering& numbering, const VectorXd& x,
                         const Loads& loads) const;

  static constexpr double flat_to = 1e-9;  ///< rounding [ρ, rad]
  /// Places in an increment that move a flat rod out of its plane.
  std::vector<Eigen::Index> out_of_plane() const;
  /// @param within  [ρ, rad]
  bool is_flat(const std::vector<Placed>& placed, double within) const;
  /// May a variation of this parity be a turn of the whole rod that costs nothing? Only while the rod is flat.
  bool may_turn(contact::Parity parity, const VectorXd& x, const Loads& loads, double within = flat_to) const;
  /// Axis of the turn, and the spin of every section about its tangent that keeps clamped ends in their clamps meanwhile.
  struct Turn {
    Eigen::Vector3d axis;
    double spin;
  };
  Turn turn_to_expect(const VectorXd& x, const Loads& loads) const;
  /// A turn of the rod on the unknowns of joints and forces, by a unit angle.
  VectorXd turn_of_joints(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
                          const Turn& turn) const;
  /// The turn that costs nothing, of unit size, on the unknowns of a dense block and those that hold directions; empty where
  /// there is none, or the block resists it. With its square the block is regular, all else as before.
  /// @param asked  borders between the two
  VectorXd neutral_turn(Purpose purpose, const Numbering& numbering, const VectorXd& x, const Loads& loads,
                        const Block& dense, Eigen::Index asked = 0) const;
  /// Largest entry of a vector at those places.
  double outside(const Eigen::Ref<const VectorXd>& f) const;

  void reduce(VectorXd& f, bool transposed) const;
  void expand(VectorXd& f, bool transposed) const;
  /// K⁻¹ f on the interiors alone, given a vector already reduced; the dense part is zero.
  VectorXd interior_solve(VectorXd reduced, bool transposed) const;

  std::vector<std::unique_ptr<Joint>> joints_;
  std::vector<double> fixed_s_;
  std::vector<Link> links_;
  Gauges gauges_;
  std::vector<Coupling> couplings_;
  std::vector<int> coupling_of_;  ///< of a joint; −1: none
  std::vector<std::vector<int>> kept_,
      varied_;                   ///< coordinates that vary at a joint, in equilibrium and in variations
  std::vector<int> even_, odd_;  ///< those of the first joint of a half chain in even and in odd variations
  int first_contact_ = -1, last_contact_ = -1;  ///< the outermost contacts; without one the ends
  bool in_contact_ = false, slides_ = false;
  Eigen::Index slide_at_ = -1;  ///< place of (c, λ) in the state
  std::vector<Eigen::Index> joint_at_, force_at_, interior_at_, strand_at_;  // offsets in the state
  std::vector<Eigen::Index> rest_at_;       ///< rests of s and of the places in the state, of contacts only
  std::vector<Eigen::Index> interior_row_;  // offsets in the increment
  Eigen::Index ambient_size_ = 0, size_ = 0, dense_size_ = 0, geometric_size_ = 0;

  Numbering numbering_;
  std::vector<Eigen::Index> outside_;  ///< see out_of_plane()

  // Last factorisation.
  std::vector<Local> locals_;
  std::vector<bvp::EndsMatrix> condensed_;
  mutable Loads with_travel_;
  mutable std::vector<bvp::EndsVector> gradients_;  ///< at the last residual or factorisation
  MatrixXd border_b_, border_c_;                    ///< reduced borders
  MatrixXd interior_b_, interior_c_;                ///< K⁻¹ b, K⁻¹ c on the interiors
  Block block_;
  BlockFactors dense_;
  Eigen::Index borders_ = 0;  ///< those asked for, then that of the phase
  Eigen::Index asked_ = 0;
  int determinant_sign_ = 0;
  bool flat_ = false;  ///< the rod, and the borders in its plane
  std::optional<contact::Parity> neutral_turn_;
};

/// The state x of `from` on `to`, a chain of the same topology on other meshes.
VectorXd transfer_state(const Chain& from, const Chain& to, const VectorXd& x, const Loads& loads);

}  // namespace windlass::chain
