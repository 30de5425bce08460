#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "windlass/output/error.hpp"
#include "windlass/petsc/session.hpp"
#include "windlass/scene/error.hpp"

namespace {

using namespace windlass;
using namespace windlass::app;

constexpr const char* footer = R"(
Start with
  windlass scenes                                       what comes with the program
  windlass diagram data/scenes/capstan-vps-pom.toml     branch, special points, what leaves them
  windlass solve SCENE --set load.tension=2 --json      one equilibrium

Any scene key can be set on the command line; `windlass scenes --keys` lists them. Options after `--` go to
PETSc and SLEPc, e.g. `windlass solve SCENE -- -snes_monitor`.

Exit status: 0 done; 1 bad input; 2 the solver could not finish (what it had is on disk); 3 a certificate
failed; 130 stopped by Ctrl-C, runs after the current point and saved.)";

/// Splits the command line at the first `--`: ours before it, PETSc's after it.
std::vector<std::string> take_petsc_options(std::vector<std::string>& arguments) {
  const auto separator = std::find(arguments.begin(), arguments.end(), "--");
  if (separator == arguments.end()) return {};
  std::vector<std::string> petsc(separator + 1, arguments.end());
  arguments.erase(separator, arguments.end());
  return petsc;
}

int complain(const char* message, int status) {
  std::fprintf(stderr, "windlass: %s\n", message);
  return status;
}

/// CLI11 would only say that a subcommand is required.
void check_command(const CommandLine& app, const std::string& word) {
  if (word.starts_with('-')) return;
  std::string known;
  for (const char* planned : {"relax", "table"})
    if (word == planned) throw InputError(word + ": this command is not built yet");
  for (const CommandText& command : app.describe_commands()) {
    if (command.name == word) return;
    known += (known.empty() ? "" : ", ") + command.name;
  }
  throw InputError(word + ": no such command; must be one of " + known);
}

/// Under mpirun every process would do the same and write to the same folder; only a sweep shares its work out.
void check_ranks(const std::string& word) {
  const char* ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (ranks && std::atoi(ranks) > 1 && word != "sweep" && !word.starts_with('-'))
    throw InputError(word + ": runs on one process; only `sweep` spreads its work over several");
}

int run(std::vector<std::string> arguments) {
  CommandLine app("windlass: equilibria, bifurcations and stability of elastic rods in contact",
                  "windlass " WINDLASS_VERSION, footer);
  CommonOptions common;
  int status = done;
  for (AddCommand* add : {add_solve, add_continue, add_diagram, add_locus, add_stability, add_verify,
                          add_plot, add_report, add_fit, add_figures, add_export, add_sweep, add_pull,
                          add_robustness, add_precision, add_scenes, add_manual, add_completion})
    add(app, common, status);

  if (arguments.empty()) {
    std::fputs(app.help().c_str(), stderr);
    return bad_input;
  }
  check_command(app, arguments.front());
  check_ranks(arguments.front());
  common.petsc = take_petsc_options(arguments);
  petsc::set_options(common.petsc);
  const bool parsed = app.parse(arguments);
  for (const std::string& option : petsc::unused_options())
    std::fprintf(stderr, "windlass: %s: nothing in this run has asked PETSc for this option; misspelt?\n",
                 option.c_str());
  return parsed ? status : static_cast<int>(bad_input);
}

/// What was printed must have arrived: a full disk behind a redirected stdout is an error like any other. Says so, and
/// sends the rest nowhere, so that nobody stumbles over it again at exit.
bool flush_stdout(bool complain_now) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return true;
  const int reason = errno;
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0)
    ::dup2(nowhere, STDOUT_FILENO);
  if (complain_now)
    complain((std::string("cannot write to standard output") + (reason ? ": " : "") +
              (reason ? std::strerror(reason) : ""))
                 .c_str(),
             not_finished);
  return false;
}

int guarded_run(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const InputError& error) {
    return complain(error.what(), bad_input);
  } catch (const output::DeviceError& error) {
    return complain(error.what(), not_finished);
  } catch (const output::OutputError& error) {  // a run folder that cannot be read or written
    return complain(error.what(), bad_input);
  } catch (const std::filesystem::filesystem_error& error) {  // a folder that may not be entered
    return complain((error.path1().string() + ": " + error.code().message()).c_str(), bad_input);
  } catch (const std::exception& error) {
    return complain(error.what(), not_finished);
  } catch (...) {
    return complain("an unknown error", not_finished);
  }
}

}  // namespace

int main(int argc, char** argv) {
  catch_interrupts();
  // Written at the end, but to a terminal: the reason why it cannot be is known then. (glibc wants the buffer given.)
  static char buffer[1 << 20];
  if (!::isatty(STDOUT_FILENO)) std::setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
  const int status = guarded_run(argc, argv);
  // A command that has failed has said why; that its output is cut short with it needs no second line.
  if (!flush_stdout(status == done || status == certificate_failed)) return not_finished;
  return status;
}
