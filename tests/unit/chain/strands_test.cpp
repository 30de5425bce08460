// Which strands touch which: partners, what faces what, lines with edges and other touches between theirs.
#include "windlass/chain/strands.hpp"

#include <boost/test/unit_test.hpp>

#include "windlass/chain/topology.hpp"

using windlass::chain::Coupling;
using windlass::chain::Seat;
using windlass::chain::Strands;
using windlass::chain::Stretch;
using windlass::chain::Topology;
using windlass::chain::unfolded;

namespace {

/// A rod of free stretches with these seats between them.
Topology of(const std::vector<Seat>& seats) {
  Topology out;
  out.stretches.assign(seats.size(), Stretch::gap);
  out.stretches.push_back(Stretch::tail);
  out.on = {Seat{}};
  out.on.insert(out.on.end(), seats.begin(), seats.end());
  out.on.push_back({});
  return out;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(strands)

BOOST_AUTO_TEST_CASE(a_line_with_the_own_image) {
  // Joints 1 to 3: ends and middle of a line between a tail and its image.
  const Topology t = of({{0, 1, 0.0, 7}, {0, 2, 0.5, 7}, {0, -1, 0.0, 7}});
  const Strands s(t);
  BOOST_TEST(s.partner(1) == 3);
  BOOST_TEST(s.partner(2) == 2);
  BOOST_REQUIRE(s.lines().size() == 1U);
  BOOST_TEST(s.lines()[0].own_image());
  BOOST_TEST(s.inside_line(2));
  BOOST_TEST(!s.inside_line(1));
  BOOST_REQUIRE(s.facing(1, 2, true) != nullptr);  // image of the other half of it
  BOOST_TEST(s.facing(1, 2, false) == nullptr);
  BOOST_TEST(s.along(1));
  BOOST_TEST(!s.along(0));
  BOOST_TEST(t.text() == "tail cross lines cross gap cross lines cross tail");
  // On the whole rod it is a line of two strands, and no other.
  const Strands whole(unfolded(t));
  BOOST_REQUIRE(whole.lines().size() == 1U);
  BOOST_TEST(!whole.lines()[0].own_image());
  BOOST_TEST(!whole.lines()[0].image);
}

BOOST_AUTO_TEST_CASE(a_line_with_the_own_image_that_is_open_about_its_middle) {
  // Joints 1, 2 and their images 5, 4: the halves of what was a line; an edge (3) in the gap between them, which is its own image.
  const Topology t = of({{0, 1, 0.0, 7}, {0, 2, 0.0, 7}, {0}, {0, -2, 0.0, -7}, {0, -1, 0.0, -7}});
  const Strands s(t);
  BOOST_REQUIRE(s.lines().size() == 1U);
  BOOST_TEST(!s.lines()[0].own_image());
  const Strands::Facing* gap = s.facing(2, 3, true);
  BOOST_REQUIRE(gap != nullptr);
  BOOST_TEST(gap->line == -1);
  BOOST_TEST(s.opened_middle(*gap));
  BOOST_TEST(!s.along(2));
  BOOST_REQUIRE(s.facing(1, 4, true) != nullptr);
  BOOST_TEST(!s.opened_middle(*s.facing(1, 4, true)));  // the line itself
}

BOOST_AUTO_TEST_CASE(an_edge_and_a_touch_with_another_strand_inside_a_line) {
  // A strand (1, 2, 3) on another (5, 8, 9): between 5 and 8 there are an edge (6) and a touch (7) with a third strand (4).
  const Topology t = of({{0, 1, 0.0, 9},
                         {0, 2, 0.4, 9},
                         {0, 3, 0.0, 9},
                         {0, 4},
                         {0, 1, 0.0, -9},
                         {},
                         {0, 4},
                         {0, 2, 0.4, -9},
                         {0, 3, 0.0, -9}});
  const Strands s(t);
  BOOST_REQUIRE(s.lines().size() == 1U);
  BOOST_TEST(s.lines()[0].links() == 2);
  BOOST_TEST(!s.lines()[0].image);
  for (const int link : {5, 6, 7}) BOOST_TEST((s.facing(link, 1, false) != nullptr), link);
  BOOST_TEST(s.facing(8, 1, false) == nullptr);
  BOOST_TEST((s.facing(8, 2, false) != nullptr));
  BOOST_TEST(s.neighbours(8) == (std::array<int, 2>{5, 9}), boost::test_tools::per_element());
  const std::vector<Coupling> couplings = t.couplings();
  // Laid on the strand with the edge and the touch, between joints that locate themselves: neither passes it.
  BOOST_TEST(s.laid(8));
  BOOST_TEST(!s.laid(2));
  BOOST_TEST(couplings[1].first == 8);
  BOOST_TEST(couplings[1].second == 2);
  BOOST_TEST(couplings[1].begin == 7);
  BOOST_TEST(couplings[1].end == 9);
  BOOST_TEST(couplings[1].part == 0.4);
  BOOST_TEST(couplings[3].begin == -1);
}

BOOST_AUTO_TEST_CASE(a_line_with_the_own_image_is_laid_on_the_half_with_other_joints) {
  // Joints 1 to 3 and 5 to 6 of a tail and its image, an edge (4) in the upper half.
  const Topology t =
      of({{0, 1, 0.0, 7}, {0, 2, 0.3, 7}, {0, 3, 0.5, 7}, {}, {0, -2, 0.6, 7}, {0, -1, 0.0, 7}});
  const Strands s(t);
  BOOST_REQUIRE(s.lines().size() == 1U);
  BOOST_TEST(s.laid(5));
  BOOST_TEST(!s.laid(2));
  BOOST_TEST(!s.laid(3));  // tangency does it
  BOOST_TEST(s.between(5) == (std::array<int, 2>{4, 6}), boost::test_tools::per_element());
  const Topology bare =
      of({{0, 1, 0.0, 7}, {0, 2, 0.3, 7}, {0, 3, 0.5, 7}, {0, -2, 0.6, 7}, {0, -1, 0.0, 7}});
  BOOST_TEST(Strands(bare).laid(2));
  // As a part of what is up to the middle, where tangency holds the third: the lower half goes on like the upper one.
  BOOST_TEST(Strands(bare).between(2) == (std::array<int, 2>{1, 3}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(of_two_halves_with_as_many_joints_that_is_divided_which_a_strand_presses_on) {
  // Joints 2 to 8 of a tail and its image, a contact with an obstacle (3) in the lower half, one with another strand (1 and 6) in the upper.
  const Topology t = of(
      {{0, 4}, {0, 1, 0.0, 7}, {}, {0, 2, 0.3, 7}, {0, 3, 0.5, 7}, {0, 4}, {0, -2, 0.6, 7}, {0, -1, 0.0, 7}});
  const Strands s(t);
  BOOST_REQUIRE(s.lines().size() == 1U);
  BOOST_TEST(s.laid(7));
  BOOST_TEST(!s.laid(4));
  BOOST_TEST(s.between(7) == (std::array<int, 2>{6, 8}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(where_another_contact_presses_on_a_line_it_has_a_touch_there) {
  // A strand (1, 2, 3) on another (4, 5, 7); joint 6, at the place of 5, touches a third one (8).
  const Topology t = of({{0, 1, 0.0, 9},
                         {0, 2, 0.4, 9},
                         {0, 3, 0.0, 9},
                         {0, 1, 0.0, -9},
                         {.strand = 2, .part = 1.0, .line = -9, .shares = 1},
                         {0, 4},
                         {0, 3, 0.0, -9},
                         {0, 4}});
  const Strands s(t);
  BOOST_TEST(s.laid(5));
  BOOST_TEST(s.pressed(5));
  BOOST_TEST(!s.pressed(2));
  BOOST_TEST(s.welded(5));
  BOOST_TEST(!s.welded(4));
  BOOST_TEST(t.couplings()[1].placed);
  BOOST_TEST(t.couplings()[1].first == 5);
  BOOST_TEST(!t.couplings()[3].placed);
  // On the other half the order is the other.
  const Topology whole = unfolded(t);
  const int middle = static_cast<int>(whole.on.size()) / 2;
  int before = 0, behind = 0;
  for (int j = 0; j < static_cast<int>(whole.on.size()); ++j)
    if (whole.on[j].shares != 0) (j < middle ? before : behind) += whole.on[j].shares;
  BOOST_TEST(before == -1);
  BOOST_TEST(behind == 1);
}

BOOST_AUTO_TEST_CASE(two_touches_next_to_each_other_are_no_line) {
  const Topology t = of({{0, 1}, {0, 2}, {0, -2}, {0, -1}});
  const Strands s(t);
  BOOST_TEST(s.lines().empty());
  BOOST_REQUIRE((s.facing(1, 3, true) != nullptr));
  BOOST_TEST(s.facing(1, 3, true)->line == -1);
  BOOST_TEST(!s.along(1));
  // On an obstacle they are: strands that lie side by side.
  Topology lying = t;
  lying.stretches[1] = lying.stretches[3] = Stretch::line;
  BOOST_TEST(Strands(lying).along(1));
}

BOOST_AUTO_TEST_SUITE_END()
