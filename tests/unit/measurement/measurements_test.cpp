// Measured points: what the reader accepts, and what it says to a file it cannot use.
#include "windlass/measurement/measurements.hpp"

#include <boost/test/unit_test.hpp>
#include <fstream>
#include <string>

#include "support/temporary_folder.hpp"
#include "windlass/scene/error.hpp"

using namespace windlass;
using measurement::read_measurements;

namespace {

/// 1 cm and 0.5e-3 N m²: a unit of force of 5 N.
const scene::Units units = scene::Units::of(0.01, 0.5e-3);

std::string message(const std::string& text, const std::optional<scene::Units>& scales = units) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("data.csv", text);
  try {
    read_measurements(file, scales);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(measurements)

BOOST_AUTO_TEST_CASE(units_stand_in_the_header) {
  const test::TemporaryFolder folder;
  const auto rows = read_measurements(
      folder.write("data.csv",
                   "# first series\r\n F0 [mN], T [g] ,F0_error [N]\r\n\r\n2500, 500, 0.1\r\n5e3,1000,0.2"),
      units);
  BOOST_REQUIRE(rows.size() == 2u);
  BOOST_TEST(rows[0].T == 0.5 * 9.80665 / 5.0, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(rows[0].F0 == 0.5, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(*rows[1].F0_error == 0.04, boost::test_tools::tolerance(1e-14));
  BOOST_TEST(rows[0].line == 4);
  BOOST_TEST(rows[1].line == 5);
}

BOOST_AUTO_TEST_CASE(without_units_numbers_are_dimensionless) {
  const test::TemporaryFolder folder;
  const auto rows = read_measurements(folder.write("data.csv", "T,F0\n2,1.5\n3,-0.1\n"), std::nullopt);
  BOOST_REQUIRE(rows.size() == 2u);
  BOOST_TEST(rows[0].T == 2.0);
  BOOST_TEST(rows[1].F0 == -0.1);  // a force gauge's noise about zero
  BOOST_TEST(!rows[0].F0_error.has_value());
}

BOOST_AUTO_TEST_CASE(messages_name_file_line_and_column) {
  BOOST_TEST(message("T [g], F0 [N]\n1, 2\n3, abc\n") ==
             "data.csv:3: column 2: \"abc\": F0 must be a number");
  BOOST_TEST(message("T [g], F0 [N]\n0, 2\n") == "data.csv:2: column 1: \"0\": T must be > 0");
  BOOST_TEST(message("T [g], F0 [N]\n1, nan\n") == "data.csv:2: column 2: \"nan\": F0 must be a number");
  BOOST_TEST(message("T [g], F0 [N]\n1, 2, 3\n") == "data.csv:2: has 3 cells; the header names 2 columns");
  BOOST_TEST(message("T, force\n") ==
             "data.csv:1: column 2: \"force\": must be T, F0 or F0_error, with a unit as in \"T [g]\"");
  BOOST_TEST(
      message("T [g], F0 [s]\n1, 2\n") ==
      "data.csv:1: column 2: \"F0 [s]\": must be a force such as \"2 N\" or a hung mass such as \"500 g\"");
  BOOST_TEST(message("T [g\n").find("data.csv:1: column 1: \"T [g\": the unit's bracket is not closed") ==
             0u);
  BOOST_TEST(message("T, T\n") == "data.csv:1: column 2: \"T\": stands there twice");
  BOOST_TEST(message("T\n1\n").find("data.csv:1: the header has no column F0") == 0u);
  BOOST_TEST(message("T, F0\n") == "data.csv: holds no measurements");
  BOOST_TEST(message("T [g], F0\n1, 2\n", std::nullopt)
                 .find("data.csv:1: column 1: \"T [g]\": has a unit, but the scene is dimensionless") == 0u);
}

BOOST_AUTO_TEST_SUITE_END()
