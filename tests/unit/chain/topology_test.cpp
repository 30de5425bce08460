// Topologies as data: the obstacles that contacts name, in words, in the whole rod, and when compared.
#include "windlass/chain/topology.hpp"

#include <boost/test/unit_test.hpp>

using windlass::chain::Stretch;
using windlass::chain::Topology;
using windlass::chain::unfolded;

using windlass::chain::Coupling;

namespace {

std::vector<int> obstacles_of(const Topology& topology) {
  std::vector<int> out;
  for (const auto& seat : topology.on) out.push_back(seat.obstacle);
  return out;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(topologies)

BOOST_AUTO_TEST_CASE(contacts_name_their_obstacle) {
  // Lies on the second obstacle about its mid-point and touches the first one further out.
  const Topology half{{Stretch::line, Stretch::gap, Stretch::tail}, true, false, {{1}, {1}, {}, {}}};
  BOOST_TEST(half.text() == "tail touch gap line:2 gap touch tail");
  const Topology whole = unfolded(half);
  BOOST_TEST(whole.text() == half.text());
  BOOST_TEST(obstacles_of(whole) == (std::vector<int>{0, 0, 1, 1, 0, 0}), boost::test_tools::per_element());
  const Topology touched{{Stretch::tail}, true, true, {{1}, {}}};
  BOOST_TEST(touched.text() == "tail touch:2 tail");
  BOOST_TEST(obstacles_of(unfolded(touched)) == (std::vector<int>{0, 1, 0}),
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(the_first_obstacle_need_not_be_named) {
  const Topology silent{{Stretch::line, Stretch::tail}, true, false},
      named{{Stretch::line, Stretch::tail}, true, false, {{}, {}, {}}};
  BOOST_TEST((silent == named));
  BOOST_TEST(named.text() == "tail line tail");
  BOOST_TEST(!(silent == Topology{{Stretch::line, Stretch::tail}, true, false, {{1}, {1}, {}}}));
}

BOOST_AUTO_TEST_CASE(strands_that_touch) {
  using S = Stretch;
  // A place that touches its own image: on the whole rod two joints touch.
  const Topology mirror{{S::line, S::gap, S::tail}, true, false, {{}, {}, {0, 1}, {}}};
  BOOST_TEST((mirror.couplings() == std::vector<Coupling>{{2, 2, true}}));
  BOOST_TEST(mirror.text() == "tail cross gap line gap cross tail");
  BOOST_TEST((unfolded(mirror).couplings() == std::vector<Coupling>{{1, 4, false}}));
  // Two places, each touching the image of the other: joints −a, a, −b, b touch as (a, −b) and (b, −a).
  const Topology split{{S::line, S::gap, S::gap, S::tail}, true, false, {{}, {}, {0, 1}, {0, -1}, {}}};
  BOOST_TEST((split.couplings() == std::vector<Coupling>{{2, 3, true}}));
  BOOST_TEST((unfolded(split).couplings() == std::vector<Coupling>{{1, 5, false}, {2, 6, false}}));
  // Two places of the same half, and their images.
  const Topology pair{{S::line, S::gap, S::gap, S::tail}, true, false, {{}, {}, {0, 1}, {0, 1}, {}}};
  BOOST_TEST((pair.couplings() == std::vector<Coupling>{{2, 3, false}}));
  BOOST_TEST((unfolded(pair).couplings() == std::vector<Coupling>{{1, 2, false}, {5, 6, false}}));
  BOOST_TEST(!(split == pair));
}

// Of a line its left end says that it lies on a plate, too: on the other half that is the image of its right one.
BOOST_AUTO_TEST_CASE(folding_undoes_unfolding) {
  Topology half{
      {Stretch::line, Stretch::gap, Stretch::line, Stretch::tail}, true, false, {{0}, {0}, {0}, {0}, {}}};
  half.symmetry = windlass::chain::Symmetry::mirror;
  half.on[0].flat = half.on[2].flat = 1;
  const Topology whole = unfolded(half);
  BOOST_REQUIRE(whole.stretches.size() == 7u);
  for (int link = 0; link < 7; ++link)
    BOOST_TEST(whole.lies_flat(link) == (link == 1 || link == 3 || link == 5));
  BOOST_TEST((windlass::chain::folded(whole, half.symmetry) == half));
  Topology touched{{Stretch::gap, Stretch::tail}, true, true, {{0}, {1}, {}}};
  touched.symmetry = half.symmetry;
  touched.on[0].flat = 1;
  BOOST_TEST(unfolded(touched).touches_flat(2));
  BOOST_TEST((windlass::chain::folded(unfolded(touched), half.symmetry) == touched));
}

BOOST_AUTO_TEST_SUITE_END()
