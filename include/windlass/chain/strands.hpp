#pragma once

#include <array>
#include <vector>

/// Which strands of a topology touch which, found once: touches that are next to each other, and the lines they make up.
namespace windlass::chain {

struct Topology;

/// A line between two strands, or a strand and its own image: touches, as joints.
struct StrandLine {
  std::vector<int> first;  ///< along one strand
  std::vector<int>
      second;  ///< second[i] touches first[i]; of a strand and its own image the same joints, in reverse
  bool image = false;         ///< of the half-turn, which runs the other way
  bool on_obstacles = false;  ///< every link of both strands lies on an obstacle
  bool own_image() const { return first.front() == second.back(); }
  int links() const { return static_cast<int>(first.size()) - 1; }
};

class Strands {
 public:
  explicit Strands(const Topology& topology);

  /// The other joint of a touch between strands; the joint itself where it touches its own image; −1: it touches no strand.
  int partner(int joint) const { return partner_[joint]; }
  /// Does a joint touch the half-turn's image of its partner?
  bool mirrored(int joint) const { return mirrored_[joint]; }
  const std::vector<StrandLine>& lines() const { return lines_; }
  /// Place among the lines of that which a joint is a touch of; −1: none.
  int line_of(int joint) const { return line_of_[joint]; }
  /// Is a joint a touch inside a line, not at its end?
  bool inside_line(int joint) const;
  /// The touches before and after one that is inside a line, along its strand.
  std::array<int, 2> neighbours(int joint) const;
  /// Is it one that is laid at a fixed part of what is between two joints (chain/coupling.hpp)? On its other strand tangency locates
  /// it. Of a line's two strands, or halves, that one is divided on which more joints of other contacts are; of two halves with as many, that on
  /// which more strands press.
  bool laid(int joint) const { return joint >= 0 && laid_[joint]; }
  /// Does its own condition find a joint, and not its part of what is between two others? In the middle of a line between a strand
  /// and its own image tangency does.
  bool located(int joint) const {
    return !inside_line(joint) || (partner_[joint] == joint && !lines_[line_of_[joint]].on_obstacles);
  }
  /// Of a line's two strands, is the first the one that is divided?
  bool divides_first(const StrandLine& line) const;
  /// Is a touch of a line where a contact that is inside none presses on the strand? What of that goes on to the other strand is
  /// a point force.
  bool pressed(int joint) const;
  /// Has a link no length, because the touches at its ends are at one place?
  bool welded(int link) const { return shares_[link] > 0 || shares_[link + 1] < 0; }
  /// The next joints before and after a touch inside a line, or a link, that are inside none.
  std::array<int, 2> between(int joint) const { return located_about(joint - 1, joint + 1); }
  std::array<int, 2> located_about(int before, int after) const;

  /// Two stretches of rod, [begin, end] and [other_begin, other_end] as joints, that face each other between the same two touches:
  /// of a line, or else next to each other on either strand. It may be its own image.
  struct Facing {
    int begin, end, other_begin, other_end;
    bool image;
    int line;  ///< place among the lines; −1: of none
  };
  /// What has opened about the middle of a line between a strand and its own image?
  bool opened_middle(const Facing& facing) const {
    const int line = facing.line < 0 ? line_of_[facing.begin] : -1;
    return line >= 0 && line == line_of_[facing.end] && partner_[facing.begin] == facing.end;
  }
  /// All that a link belongs to.
  const std::vector<Facing>& facing(int link) const { return facing_[link]; }
  /// The one with a link of the other strand; nullptr: there is none.
  const Facing* facing(int link, int other, bool image) const;
  /// Does another strand touch a link all along?
  bool along(int link) const;
  /// The line that does, −1: none.
  int line_along(int link) const;

 private:
  void find_lines(const Topology& topology);
  void find_lines_on_obstacles(const Topology& topology, const std::vector<int>& touches);
  void find_laid();
  /// Joints between two, but for those inside lines. @param touches  of strands alone
  int others(int begin, int end, bool touches = false) const;
  void add(const Facing& facing);
  void face(const std::vector<int>& touches);

  std::vector<int> partner_, line_of_, shares_;
  std::vector<bool> mirrored_, laid_;
  std::vector<StrandLine> lines_;
  std::vector<std::vector<Facing>> facing_;
};

}  // namespace windlass::chain
