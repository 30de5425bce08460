#pragma once

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run_program.hpp"

namespace windlass::test {

/// What `fit` finds for the branch in `run` of a folder, from measured data. @param data  the CSV file's text
inline nlohmann::json fit_of(const TemporaryFolder& folder, const std::string& data) {
  folder.write("data.csv", data);
  const Outcome outcome =
      run_program({"fit", "run", "--csv", "data.csv", "--json", "--format", "png"}, folder.path());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return nlohmann::json::parse(outcome.out);
}

}  // namespace windlass::test
