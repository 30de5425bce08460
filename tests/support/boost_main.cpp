// The one main function of every Boost.Test executable of the project.
#define BOOST_TEST_MODULE windlass
#include <boost/test/unit_test.hpp>
