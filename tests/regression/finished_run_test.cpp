// What is done with a finished run: verify, stability, plot; damaged ones.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "regression/coil_run.hpp"
#include "support/csv.hpp"
#include "windlass/output/point_store.hpp"

using namespace windlass::test;
namespace fs = std::filesystem;

namespace {

void truncate(const fs::path& path) { fs::resize_file(path, fs::file_size(path) / 2); }

}  // namespace

BOOST_AUTO_TEST_SUITE(finished_runs)

BOOST_AUTO_TEST_CASE(what_is_done_with_a_finished_run) {
  const TemporaryFolder folder;
  make_run(folder);
  const fs::path run = folder.path() / "run";
  const Outcome certificate = run_program({"verify", "run", "--json"}, folder.path());
  BOOST_REQUIRE_MESSAGE(certificate.status == 0, certificate.err);
  const auto report = nlohmann::json::parse(certificate.out);
  BOOST_TEST(report["failed"] == 0);
  BOOST_TEST(report["checked"] == read_csv(run / "branches.csv").rows.size());

  const Outcome spectra = run_program({"stability", "run"}, folder.path());
  BOOST_TEST(spectra.status == 0, spectra.err);
  BOOST_TEST(contains(spectra.out, "1-1 "), spectra.out);
  BOOST_TEST(nlohmann::json::parse(slurp(run / "run.json"))["status"] == "finished");
  for (const auto& row : read_csv(run / "branches.csv").rows)
    BOOST_TEST(std::stod(row.at("eigenvalue_1")) > 0.0);

  const Outcome picture = run_program({"plot", "run", "--format", "png"}, folder.path());
  BOOST_REQUIRE_MESSAGE(picture.status == 0, picture.err);
  BOOST_TEST(slurp(run / "plots" / "diagram.png").substr(1, 3) == "PNG");
}

BOOST_AUTO_TEST_CASE(damaged_run_folders_are_named) {
  const TemporaryFolder folder;
  make_run(folder);
  for (const char* file : {"points.h5", "run.json", "branches.csv"}) {
    fs::copy(folder.path() / "run", folder.path() / "damaged", fs::copy_options::recursive);
    truncate(folder.path() / "damaged" / file);
    for (const char* command : {"verify", "stability", "plot"}) {
      const Outcome outcome = run_program({command, "damaged"}, folder.path());
      BOOST_TEST(outcome.status == 1, command);
      BOOST_TEST(
          contains(outcome.err, std::string("windlass: cannot read damaged/") + file + ": it is truncated"),
          outcome.err);
    }
    fs::remove_all(folder.path() / "damaged");
  }
}

BOOST_AUTO_TEST_CASE(damaged_points_fail_by_name) {
  const TemporaryFolder folder;
  make_run(folder);
  const fs::path path = folder.path() / "run" / "points.h5";
  const auto stored = windlass::output::PointStore::read(path);
  windlass::output::PointStore damaged;
  for (std::size_t k = 0; k < stored.size(); ++k) {
    auto solution = stored.get(k);
    if (k == 4) solution.arcs[0].m(2, 3) += 1e-6;
    damaged.append(stored.keys()[k], solution);
  }
  damaged.write(path);
  const Outcome failed = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(failed.status == 3, failed.err);
  BOOST_TEST(contains(failed.out, "point 1-5 "), failed.out);
  BOOST_TEST(contains(failed.out, "FAILED arc_moment"), failed.out);
  BOOST_TEST(contains(failed.out, ", 1 failed"), failed.out);
  BOOST_TEST(run_program({"verify", "run", "--accept", "1e-4"}, folder.path()).status == 0);

  windlass::output::PointStore().write(path);  // as if it had been killed before its first point was stored
  const Outcome empty = run_program({"verify", "run"}, folder.path());
  BOOST_TEST(empty.status == 1);
  BOOST_TEST(empty.err == "windlass: run: holds no points yet, so there is nothing to verify\n");
}

BOOST_AUTO_TEST_CASE(a_certificate_can_fail) {
  const TemporaryFolder folder;
  make_run(folder);
  // Moment-free ends are not clamped ones: at low tension their directions differ by 1e-4.
  const Outcome outcome = run_program({"verify", "run", "--set", "ends.kind=clamped"}, folder.path());
  BOOST_TEST(outcome.status == 3, outcome.err);
  BOOST_TEST(contains(outcome.out, "FAILED end_clamp"), outcome.out);
}

BOOST_AUTO_TEST_SUITE_END()
