#pragma once

#include <set>
#include <string>
#include <vector>

#include "windlass/output/run_folder.hpp"

/// What a bifurcation diagram shows, as numbers.
namespace windlass::output {

enum class ArmState { stable, unstable, unknown };
inline std::string arm_state_name(ArmState state) {
  return state == ArmState::stable     ? "stable"
         : state == ArmState::unstable ? "unstable"
                                       : "stability not computed";
}

inline constexpr const char* special_types[] = {"fold", "branch_point", "contact"};

struct Axis {
  std::string name;   ///< column name
  std::string title;  ///< for readers, gnuplot enhanced text
  bool log = false;
  double low = 0.0, high = 0.0;  ///< range shown
};

/// Consecutive points of one branch with one stability; ends at the first point of the next piece, so that the
/// curve has no holes.
struct Piece {
  int branch = 0;
  ArmState state = ArmState::unknown;
  std::vector<std::vector<double>> rows;  ///< x, then one value a panel
  std::set<std::size_t> breaks;  ///< rows before which the line is broken: a new topology, the place repeated
};

struct SpecialMark {
  std::string label, type;
  std::vector<double> values;  ///< x, then one value a panel
};

struct DiagramData {
  std::string title;
  bool locus =
      false;  ///< its two branches are the two directions of one curve, and stability is not asked for
  Axis x;
  std::vector<Axis> panels;  ///< at most four
  std::vector<Piece> pieces;
  std::vector<SpecialMark> special;
};

DiagramData diagram_data(const Run& run);

}  // namespace windlass::output
