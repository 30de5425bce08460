#include "windlass/output/run_folder.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <fstream>

#include "support/temporary_folder.hpp"
#include "unit/verify/closed_form_rods.hpp"
#include "windlass/output/error.hpp"

namespace {

namespace fs = std::filesystem;
using namespace windlass;
using equilibrium::Solution;
using output::OutputError;
using output::RunWriter;
using output::WriterOptions;

constexpr double two_pi = 2 * std::numbers::pi;

Solution sample_solution(double T) {
  Solution solution = test::planar_capstan(T, two_pi);
  solution.F0 = 0.3 * solution.R_tot;
  solution.restart = {R"({"arcs":3})", Eigen::VectorXd::LinSpaced(7, 0.1, T)};
  equilibrium::Stability stability;
  stability.index = 1, stability.inertia_index = 1;
  stability.eigenvalues = {-0.25 * T, 1.0 / 3.0};
  stability.modes.push_back(
      {-0.25 * T, "out", "odd", Eigen::VectorXd::LinSpaced(4, -1, 1), Eigen::Matrix3Xd::Ones(3, 4)});
  solution.stability = stability;
  return solution;
}

void add(RunWriter& writer, int branch, int point, double T, const std::string& label = "") {
  const Solution solution = sample_solution(T);
  writer.add_point(
      output::make_row(solution, branch, point, label, label.empty() ? "regular" : "branch_point", 0.1),
      solution);
}

std::string content(const fs::path& path) { return output::read_file(path); }

/// True when what() of the error holds every one of the words.
auto mentions(std::vector<std::string> words) {
  return [words = std::move(words)](const OutputError& error) {
    for (const std::string& word : words) {
      if (std::string(error.what()).find(word) == std::string::npos) {
        BOOST_TEST_MESSAGE("\"" << error.what() << "\" lacks \"" << word << "\"");
        return false;
      }
    }
    return true;
  };
}

/// Exit status of a child process that runs `work`; -signal when it was killed.
template <class Work>
int in_child(Work work) {
  const pid_t child = fork();
  if (child == 0) {
    work();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(run_folder)

BOOST_AUTO_TEST_CASE(what_is_written_is_read_back_exactly) {
  const test::TemporaryFolder temporary;
  const auto scene = test::capstan_scene(1.0, two_pi);
  {
    WriterOptions options;
    options.version = "1.2.3", options.command = "diagram", options.options["load.tension"] = 5.0;
    RunWriter writer = RunWriter::create(temporary / "runs/a", scene, options);
    add(writer, 1, 1, 1.7);
    add(writer, 1, 2, 1.0 / 3.0 + 0.4, "BP1");
    writer.add_special_point(
        {"BP1", "branch_point", 1, 0.7, two_pi, 1e-9, 1, output::SpecialMode{"out", "odd"}, "", "", {}});
    writer.add_special_point({"C1", "contact", 1, 0.5, two_pi, 1e-9, 1, {}, "line, one", "touch", {}});
    writer.add_lost_branch({2, "BP1", 0.4, two_pi, "step length below its minimum", {}});
    writer.finish("finished", {2, 0.25, 0.5, 1.5}, {{"branches", 1}});
  }
  const output::Run run = output::read_run(temporary / "runs/a");
  BOOST_TEST(run.scene_toml == scene.resolved_toml);
  BOOST_TEST(run.info.version == "1.2.3");
  BOOST_TEST(run.info.status == "finished");
  BOOST_TEST(run.info.timings.stability == 0.5);
  BOOST_REQUIRE(run.info.lost_branches.size() == 1u);
  BOOST_TEST(run.info.lost_branches[0].reason == "step length below its minimum");
  BOOST_REQUIRE(run.rows.size() == 2u);
  BOOST_TEST(run.rows[1].T == 1.0 / 3.0 + 0.4);
  BOOST_TEST(run.row("BP1").index.value() == 1);
  BOOST_REQUIRE(run.special_points.size() == 2u);
  BOOST_TEST(run.special_points[0].mode->parity == "odd");
  BOOST_TEST(run.special_points[1].before == "line, one");
  const Solution expected = sample_solution(1.0 / 3.0 + 0.4), got = run.points.get("BP1");
  BOOST_TEST(got.R_tot == expected.R_tot);
  BOOST_TEST(got.F0.value() == expected.F0.value());
  BOOST_TEST(got.topology == expected.topology);
  BOOST_REQUIRE(got.arcs.size() == expected.arcs.size());
  for (std::size_t k = 0; k < got.arcs.size(); ++k) {
    BOOST_TEST((got.arcs[k].q == expected.arcs[k].q && got.arcs[k].m == expected.arcs[k].m));
    BOOST_TEST((got.arcs[k].r == expected.arcs[k].r && got.arcs[k].p == expected.arcs[k].p));
  }
  BOOST_TEST(got.joints[2].force == expected.joints[2].force);
  BOOST_TEST((got.restart.state == expected.restart.state));
  BOOST_TEST(got.restart.chain == expected.restart.chain);
  BOOST_TEST(got.stability->eigenvalues == expected.stability->eigenvalues);
  BOOST_TEST((got.stability->modes[0].displacement == expected.stability->modes[0].displacement));
}

BOOST_AUTO_TEST_CASE(columns_are_those_promised) {
  const test::TemporaryFolder temporary;
  auto scene = test::capstan_scene(1.0, two_pi);
  RunWriter::create(temporary / "capstan", scene, {});
  BOOST_TEST(content(temporary / "capstan/branches.csv") ==
             "branch,point,label,type,T,phi,R_tot,phi_star,tilt,z_span,energy,self_distance,self_force,plate_"
             "force,F0,travel,index,"
             "eigenvalue_1,ds,"
             "newton_iterations,error_estimate,topology\n");
  scene.has_cylinder = false;
  WriterOptions options;
  options.extra_parameter = "ends.twist";
  RunWriter::create(temporary / "strut", scene, options);
  BOOST_TEST(content(temporary / "strut/branches.csv") ==
             "branch,point,label,type,T,phi,end_force,end_moment,shortening,tilt,z_span,energy,self_distance,"
             "self_force,index,"
             "eigenvalue_1,ds,"
             "newton_iterations,error_estimate,topology,ends.twist\n");
}

BOOST_AUTO_TEST_CASE(no_file_holds_nan_or_inf) {
  const test::TemporaryFolder temporary;
  RunWriter writer = RunWriter::create(temporary / "run", test::capstan_scene(1.0, two_pi), {});
  Solution solution = sample_solution(1.0);  // its tails end at infinity
  solution.error_estimate = NAN, solution.tilt = HUGE_VAL;
  writer.add_point(output::make_row(solution, 1, 1, "", "start", NAN), solution);
  writer.add_special_point({"F1", "fold", 1, NAN, two_pi, HUGE_VAL, 1, {}, "", "", {}});
  writer.finish("finished", {1, NAN, 0, 0}, {{"worst", NAN}});
  for (const char* file : {"branches.csv", "run.json", "special_points.json"}) {
    const std::string text = content(temporary / (std::string("run/") + file));
    BOOST_TEST(text.find("nan") == std::string::npos, file << ":\n" << text);
    BOOST_TEST(text.find("inf") == std::string::npos, file << ":\n" << text);
  }
  const Solution stored = output::read_run(temporary / "run").points.get("1-1");
  BOOST_TEST(std::isfinite(stored.arcs.back().s_end));
  BOOST_TEST(stored.arcs.back().s_end == stored.arcs.back().s[stored.arcs.back().s.size() - 1]);
  BOOST_TEST(std::isfinite(stored.joints.back().s));
  solution.arcs[1].m(2, 3) = NAN;
  BOOST_CHECK_EXCEPTION(writer.add_point(output::make_row(solution, 1, 2, "", "regular", 0.1), solution),
                        OutputError, mentions({"1-2", "not finite"}));
}

BOOST_AUTO_TEST_CASE(existing_content_is_kept_unless_forced) {
  const test::TemporaryFolder temporary;
  const auto scene = test::capstan_scene(1.0, two_pi);
  {
    RunWriter writer = RunWriter::create(temporary / "run", scene, {});
    add(writer, 1, 1, 1.5);
    writer.finish("finished", {}, nlohmann::ordered_json::object());
  }
  std::ofstream(temporary / "run/notes.txt") << "mine";
  const std::string before = content(temporary / "run/branches.csv");
  BOOST_CHECK_EXCEPTION(RunWriter::create(temporary / "run", scene, {}), OutputError,
                        mentions({"run", "--force"}));
  BOOST_TEST(content(temporary / "run/branches.csv") == before);
  WriterOptions force;
  force.force = true;
  RunWriter::create(temporary / "run", scene, force);
  BOOST_TEST(output::read_run(temporary / "run").rows.empty());
  BOOST_TEST(content(temporary / "run/notes.txt") == "mine");
  std::ofstream(temporary / "file") << "mine";
  BOOST_CHECK_EXCEPTION(RunWriter::create(temporary / "file", scene, force), OutputError, mentions({"file"}));
  BOOST_CHECK_EXCEPTION(RunWriter::create(temporary / "file/below", scene, force), OutputError,
                        mentions({"file/below"}));
}

BOOST_AUTO_TEST_CASE(a_killed_run_is_readable_and_can_go_on) {
  const test::TemporaryFolder temporary;
  const fs::path folder = temporary / "run";
  const int status = in_child([&] {
    RunWriter writer = RunWriter::create(folder, test::capstan_scene(1.0, two_pi), {});
    add(writer, 1, 1, 5.0);
    add(writer, 1, 2, 4.0, "BP1");
    writer.add_special_point({"BP1", "branch_point", 1, 4.0, two_pi, 1e-9, 1, {}, "", "", {}});
    writer.commit();
    add(writer, 1, 3, 3.0);
    raise(SIGKILL);
  });
  BOOST_REQUIRE(status == -SIGKILL);
  std::ofstream(folder / "branches.csv", std::ios::app) << "1,4,,regu";  // a kill in the middle of a line
  const output::Run run = output::read_run(folder);
  BOOST_TEST(run.info.status == "running");
  BOOST_TEST(run.rows.size() == 3u);
  BOOST_TEST(run.points.size() == 2u);
  BOOST_TEST(run.points.get("BP1").T == 4.0);
  RunWriter writer = RunWriter::resume(folder);
  BOOST_TEST(writer.rows().size() == 2u);
  add(writer, 1, 3, 3.0);
  writer.finish("finished", {}, nlohmann::ordered_json::object());
  BOOST_TEST(output::read_run(folder).rows.size() == 3u);
  BOOST_TEST(output::read_run(folder).points.get("1-3").T == 3.0);
}

BOOST_AUTO_TEST_CASE(kills_at_any_moment_leave_a_readable_folder) {
  const test::TemporaryFolder temporary;
  for (int attempt = 0; attempt < 20; ++attempt) {
    const fs::path folder = temporary / ("run" + std::to_string(attempt));
    { RunWriter::create(folder, test::capstan_scene(1.0, two_pi), {}); }
    const pid_t child = fork();
    if (child == 0) {
      RunWriter writer = RunWriter::resume(folder);
      for (int point = 1;; ++point) {
        const std::string label = point % 3 == 0 ? "BP" + std::to_string(point) : "";
        add(writer, 1, point, 1.0 + 1.0 / point, label);
        if (!label.empty())
          writer.add_special_point({label, "branch_point", 1, 1.0, two_pi, 1e-9, 1, {}, "", "", {}});
        writer.commit();  // as often as possible: most of the time is spent inside the files
      }
    }
    usleep(static_cast<useconds_t>(5000 + 2700 * attempt));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const output::Run run = output::read_run(folder);
    BOOST_TEST(run.rows.size() >= run.points.size());
    BOOST_TEST(run.rows.size() <= run.points.size() + 1);
    for (std::size_t i = 0; i < run.points.size(); ++i) BOOST_TEST(run.points.get(i).T == run.rows[i].T);
    for (const output::SpecialPoint& listed : run.special_points)  // each can be restarted from
      BOOST_TEST(run.points.find(listed.label).has_value());
  }
}

BOOST_AUTO_TEST_CASE(a_full_disk_is_an_error_and_loses_nothing) {
  const test::TemporaryFolder temporary;
  const fs::path folder = temporary / "run";
  const int status = in_child([&] {
    RunWriter writer = RunWriter::create(folder, test::capstan_scene(1.0, two_pi), {});
    for (int point = 1; point <= 3; ++point) add(writer, 1, point, 1.0 + point);
    writer.commit();
    // a limit on file size stands in for a full disk: write(2) fails in the same way
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{fs::file_size(folder / "points.h5") + 1000, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      for (int point = 4; point <= 60; ++point) add(writer, 1, point, 1.0 + point);
      writer.commit();
    } catch (const OutputError& error) {
      _exit(std::string(error.what()).find("points.h5") != std::string::npos ? 42 : 43);
    }
  });
  BOOST_TEST(status == 42);
  const output::Run run = output::read_run(folder);
  BOOST_TEST(run.points.size() == 3u);
  BOOST_TEST(run.rows.size() == 60u);
}

BOOST_AUTO_TEST_CASE(damaged_folders_are_named) {
  const test::TemporaryFolder temporary;
  const fs::path folder = temporary / "run";
  {
    RunWriter writer = RunWriter::create(folder, test::capstan_scene(1.0, two_pi), {});
    for (int point = 1; point <= 5; ++point) add(writer, 1, point, 1.0 + point);
    writer.finish("finished", {}, nlohmann::ordered_json::object());
  }
  BOOST_CHECK_EXCEPTION(output::read_run(temporary / "none"), OutputError,
                        mentions({"none", "no such folder"}));
  const auto damaged = [&](const std::string& file, const std::string& text) {
    const std::string good = content(folder / file);
    output::replace_file(folder / file, std::string_view(text));
    BOOST_CHECK_EXCEPTION(output::read_run(folder), OutputError, mentions({file}));
    output::replace_file(folder / file, std::string_view(good));
  };
  const std::string points = content(folder / "points.h5"), rows = content(folder / "branches.csv");
  for (const double part : {0.0, 0.1, 0.5, 0.99}) {
    damaged("points.h5",
            points.substr(0, static_cast<std::size_t>(part * static_cast<double>(points.size()))));
  }
  damaged("points.h5", std::string(5000, 'x'));
  damaged("run.json", content(folder / "run.json").substr(0, 60));
  damaged("run.json", "{}");
  damaged("special_points.json", "[{\"label\": \"F1\"}]");
  damaged("branches.csv", "T,R\n1,2\n");
  damaged("branches.csv", rows + "1,6,,regular,abc,1,1,1,1,1,1,1,1,1,1,1,x\n");
  damaged("branches.csv", rows + "1,6\n");
  damaged("branches.csv", rows.substr(0, rows.size() / 2));
  fs::remove(folder / "points.h5");
  BOOST_CHECK_EXCEPTION(output::read_run(folder), OutputError, mentions({"points.h5", "no such file"}));
}

BOOST_AUTO_TEST_CASE(stability_can_be_added_later) {
  const test::TemporaryFolder temporary;
  const fs::path folder = temporary / "run";
  RunWriter writer = RunWriter::create(folder, test::capstan_scene(1.0, two_pi), {});
  Solution solution = sample_solution(2.0);
  solution.stability.reset();
  writer.add_point(output::make_row(solution, 1, 1, "", "start", 0), solution);
  equilibrium::Stability stability;
  stability.index = 3, stability.eigenvalues = {-3, -2, -1, 4};
  writer.set_stability("1-1", stability);
  writer.finish("finished", {}, nlohmann::ordered_json::object());
  const output::Run run = output::read_run(folder);
  BOOST_TEST(run.row("1-1").index.value() == 3);
  BOOST_TEST(run.row("1-1").eigenvalue_1.value() == -3);
  BOOST_TEST(run.points.get("1-1").stability->eigenvalues.size() == 4u);
  BOOST_CHECK_EXCEPTION(writer.set_stability("BP9", stability), OutputError, mentions({"BP9"}));
  BOOST_CHECK_EXCEPTION(run.points.get("BP9"), OutputError, mentions({"BP9"}));
}

BOOST_AUTO_TEST_CASE(writing_costs_little) {
  const test::TemporaryFolder temporary;
  RunWriter writer = RunWriter::create(temporary / "run", test::capstan_scene(1.0, two_pi), {});
  const Solution solution = sample_solution(2.0);
  const auto begin = std::chrono::steady_clock::now();
  constexpr int points = 2000;
  for (int point = 1; point <= points; ++point) {
    writer.add_point(output::make_row(solution, 1, point, "", "regular", 0.1), solution);
  }
  writer.finish("finished", {}, nlohmann::ordered_json::object());
  const double milliseconds =
      1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / points;
  BOOST_TEST_MESSAGE("writing: " << milliseconds << " ms a point, points.h5 "
                                 << fs::file_size(temporary / "run/points.h5") / points << " bytes a point");
  BOOST_TEST(milliseconds < 2.0);  // 0.1 expected; room for slow and sanitized machines
}

BOOST_AUTO_TEST_SUITE_END()
