#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

/// What the user asks for, as plain numbers: the outcome of reading a scene file.
///
/// All quantities are dimensionless (PHYSICS: length s/ρ, force T ρ²/EI, moment m ρ/EI), also for a physical
/// scene; `units` then carries the scales that give millimetres and newtons back.
namespace windlass::scene {

/// Free rods (no cylinder) hold the places of their ends on e_x: `moment_free` is `pinned` there. `spin_held`: round a cylinder, in
/// a universal joint, which lets the end bend and not spin.
enum class EndKind { moment_free, clamped, pinned, spin_held };
enum class ModelKind { automatic, closed_form, planar, kirchhoff };
enum class Symmetry { automatic, half_turn, mirror, none };
enum class Sliding { none, up };
enum class Travel { free, blocked };
enum class PlateSide { above, below };
enum class Guide { none, slider };

struct Rod {
  double bending_stiffness = 1.0;    ///< EI1 [EI]; the unit of stiffness, 1 in a dimensionless capstan
  double bending_stiffness_2 = 1.0;  ///< EI2 [EI]; differs from EI1 only for anisotropic free rods
  double twist_ratio = 2.0 / 3.0;    ///< GJ/EI [-]
  double length = 0.0;               ///< whole rod [ρ]; infinity() for `length = "inf"`
  double natural_curvature = 0.0;  ///< κ̂ in the plane of the flat rod, > 0 the way round the cylinder [1/ρ]
  double natural_twist = 0.0;      ///< û₃ [1/ρ]
  bool extensible = false;
  double axial_stiffness = HUGE_VAL;  ///< EA of an extensible rod [EI/ρ²]
  std::array<double, 3> weight{};     ///< force per length [EI/ρ³]
  double compliance() const { return extensible ? 1.0 / axial_stiffness : 0.0; }  ///< 1/EA [ρ²/EI]
  bool weighs() const { return weight != std::array<double, 3>{}; }
  bool infinite() const;
  bool isotropic_straight() const {
    return bending_stiffness_2 == bending_stiffness && natural_curvature == 0.0 && natural_twist == 0.0;
  }

  bool operator==(const Rod&) const = default;
};

/// A plane wall: the centre line stays where n·r <= distance, n the unit vector along `normal`.
struct Wall {
  std::array<double, 3> normal = {0.0, 1.0, 0.0};
  double distance = 0.0;  ///< [ρ]

  /// How far a straight strut of this length, along e_x about the origin, reaches towards it.
  double reach_of_straight(double length) const;
  /// Is it its own image under the half-turn about e_y?
  bool keeps_half_turn() const { return normal[0] == 0.0 && normal[2] == 0.0; }

  bool operator==(const Wall&) const = default;
};

/// A stopper, a plane z = height: the centre line stays on one side of it.
struct Plate {
  double height = 0.0;                ///< [ρ]
  PlateSide side = PlateSide::above;  ///< where the plate is, seen from the rod
  double outer_radius = HUGE_VAL;     ///< [ρ]

  bool operator==(const Plate&) const = default;
};

/// How the cylinder moves.
struct Motion {
  Sliding sliding = Sliding::none;  ///< along its axis, slipping everywhere on the rod
  /// Of a thick rod: has the friction a moment about its centre line? Not given: where an end holds it.
  std::optional<bool> friction_couple;

  bool operator==(const Motion&) const = default;
};

struct Load {
  double tension = 1.0;          ///< T [EI/ρ²], > 0 with a cylinder
  double angle = 0.0;            ///< phi, the capstan angle [rad], > 0
  std::optional<double> thrust;  ///< strut only: compressive end force [EI/L²-free: EI/ρ², ρ = 1]

  bool operator==(const Load&) const = default;
};

struct Ends {
  EndKind kind = EndKind::moment_free;
  std::optional<EndKind> left, right;  ///< where one differs from `kind`
  EndKind left_kind() const { return left.value_or(kind); }
  EndKind right_kind() const { return right.value_or(kind); }
  std::optional<double> shortening;  ///< strut only: end shortening / length [-]
  double twist = 0.0;                ///< strut only: relative end rotation about the axis [rad]
  Travel travel = Travel::free;      ///< while sliding: equal pulls, or no travel along itself
  /// slider: round a cylinder each end moves along a line parallel to its pull, and nowhere else.
  Guide guide = Guide::none;
  double guide_offset = 1.0;  ///< distance of those lines from the axis [ρ]; 1: tangents to the coil
  bool guided() const { return guide != Guide::none; }

  bool operator==(const Ends&) const = default;
};

enum class KnotKind { none, clove_hitch };

/// A rod that is knotted round the cylinder, or round itself.
struct Knot {
  KnotKind kind = KnotKind::none;
  std::string curve;  ///< instead: file with the points of a start curve; empty: none
  bool tied() const { return kind != KnotKind::none || !curve.empty(); }

  bool operator==(const Knot&) const = default;
};

struct Model {
  ModelKind kind = ModelKind::automatic;
  Symmetry symmetry = Symmetry::automatic;
  double tolerance = 1e-8;  ///< relative error asked of R_tot (strut: of end_force)

  bool operator==(const Model&) const = default;
};

struct Continuation {
  std::string parameter = "load.tension";  ///< dotted key of any numeric scene entry
  double from = 0.0;
  double to = 0.0;
  double step = 0.0;      ///< first step in path length; 0: chosen by the program
  double step_min = 0.0;  ///< 0: chosen
  double step_max = 0.0;  ///< 0: chosen
  int max_points = 2000;

  bool operator==(const Continuation&) const = default;
};

/// Scales of a physical scene: multiply a dimensionless number to get SI units.
struct Units {
  double bending_stiffness = 1.0;  ///< EI [N m²]; with `length` it gives the other four
  double length = 1.0;             ///< ρ = R + r; of a strut the rod length [m]
  double force = 1.0;              ///< EI/ρ² [N]
  double moment = 1.0;             ///< EI/ρ [N m]
  double pressure = 1.0;           ///< EI/ρ³ [N/m] (force per length)
  double energy = 1.0;             ///< EI/ρ [J]

  /// The scales that follow from a length [m] and a bending stiffness [N m²].
  static Units of(double length, double bending_stiffness);

  bool operator==(const Units&) const = default;
};

struct Scene {
  std::string name;   ///< file stem, or the scene's `name` key
  std::string title;  ///< one line, from the scene's `title` key
  Rod rod;
  bool has_cylinder = false;  ///< radius of the centreline's cylinder is 1 when true
  double rod_radius = 0.0;    ///< r [ρ]; 0 unless physical or given
  bool self_contact = false;  ///< strands of the rod keep 2r apart
  double strand_radius() const { return self_contact ? rod_radius : 0.0; }
  std::optional<double> friction;     ///< mu
  Motion motion;                      ///< of the cylinder
  std::optional<Plate> plate;         ///< of a cylinder that slides what holds the rod back
  std::optional<Plate> second_plate;  ///< on the other side of the rod
  std::vector<Plate> plates() const {
    std::vector<Plate> all;
    for (const std::optional<Plate>& one : {plate, second_plate})
      if (one) all.push_back(*one);
    return all;
  }
  bool slides() const { return motion.sliding != Sliding::none; }
  std::vector<Wall> walls;  ///< struts only, in the order of the file
  Load load;
  Ends ends;
  Knot knot;
  Model model;
  std::optional<Continuation> continuation;
  std::optional<Units> units;  ///< physical scenes only
  /// What a number of this scene is multiplied with to give the user's: 1, but in what natural() returns.
  Units solved_in;
  std::string resolved_toml;  ///< the scene as resolved (defaults and --set applied), dimensionless;
                              ///< reading it again gives an equal Scene

  /// Is a half chain, symmetric under the half-turn, admitted?
  bool half_turn() const {
    return model.symmetry != Symmetry::none && ends.left_kind() == ends.right_kind() &&
           obstacles_keep_half_turn() && weight_keeps_half_turn();
  }
  /// Is a half chain asked for, whose other half is its mirror image in the plane x = 0?
  bool mirrored() const { return model.symmetry == Symmetry::mirror; }
  bool weight_keeps_half_turn() const {
    const bool varies = continuation && (continuation->parameter == "rod.weight_x" ||
                                         continuation->parameter == "rod.weight_z");
    return rod.weight[0] == 0.0 && rod.weight[2] == 0.0 && !varies;
  }
  bool obstacles_keep_half_turn() const;
  /// Is there no torsion anywhere? Then the centre line alone is the rod, as the thick discrete rod has it.
  bool free_of_torsion() const { return ends_turn_freely() && rod.isotropic_straight(); }
  bool has_obstacles() const { return has_cylinder || !walls.empty(); }
  double dragging_friction() const { return slides() ? friction.value_or(0.0) : 0.0; }  ///< mu of what slips
  /// Do both ends turn freely? Then nothing balances a moment about the rod's tangent.
  bool ends_turn_freely() const {
    return ends.left_kind() == EndKind::moment_free && ends.right_kind() == EndKind::moment_free;
  }
  bool friction_has_couple() const {
    return slides() && motion.friction_couple.value_or(!ends_turn_freely());
  }
  /// Distance from the centre line at which friction acts, where its moment about it counts [ρ].
  double friction_arm() const { return friction_has_couple() ? rod_radius : 0.0; }

  bool operator==(const Scene&) const = default;
};

}  // namespace windlass::scene
