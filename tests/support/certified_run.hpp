#pragma once

#include <boost/test/unit_test.hpp>
#include <string>
#include <vector>

#include "support/csv.hpp"
#include "support/run_program.hpp"

namespace windlass::test {

/// Runs a command that makes a run, then `verify`, both of which must succeed. @returns its points; the run is in `folder`/run
inline Table certified_run(std::vector<std::string> command, const TemporaryFolder& folder) {
  command.insert(command.end(), {"--out", "run", "--quiet", "--no-eigenvalues"});
  const Outcome outcome = run_program(command, folder.path());
  BOOST_TEST(outcome.status == 0, outcome.err);  // 2: a branch was lost
  const Outcome certificate = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(certificate.status == 0, certificate.out);
  return read_csv(folder.path() / "run" / "branches.csv");
}

}  // namespace windlass::test
