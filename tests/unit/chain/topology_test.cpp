// Topologies as data: the obstacles that contacts name, in words, in the whole rod, and when compared.
#include "windlass/chain/topology.hpp"

#include <boost/test/unit_test.hpp>

using windlass::chain::Stretch;
using windlass::chain::Topology;
using windlass::chain::unfolded;

BOOST_AUTO_TEST_SUITE(topologies)

BOOST_AUTO_TEST_CASE(contacts_name_their_obstacle) {
  // Lies on the second obstacle about its mid-point and touches the first one further out.
  const Topology half{{Stretch::line, Stretch::gap, Stretch::tail}, true, false, {1, 1, 0, 0}};
  BOOST_TEST(half.text() == "tail touch gap line:2 gap touch tail");
  const Topology whole = unfolded(half);
  BOOST_TEST(whole.text() == half.text());
  BOOST_TEST(whole.on == (std::vector<int>{0, 0, 1, 1, 0, 0}), boost::test_tools::per_element());
  const Topology touched{{Stretch::tail}, true, true, {1, 0}};
  BOOST_TEST(touched.text() == "tail touch:2 tail");
  BOOST_TEST(unfolded(touched).on == (std::vector<int>{0, 1, 0}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(the_first_obstacle_need_not_be_named) {
  const Topology silent{{Stretch::line, Stretch::tail}, true, false},
      named{{Stretch::line, Stretch::tail}, true, false, {0, 0, 0}};
  BOOST_TEST((silent == named));
  BOOST_TEST(named.text() == "tail line tail");
  BOOST_TEST(!(silent == Topology{{Stretch::line, Stretch::tail}, true, false, {1, 1, 0}}));
}

BOOST_AUTO_TEST_SUITE_END()
