#include "windlass/petsc/session.hpp"

#include <petscsys.h>
#include <slepcsys.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <vector>

namespace windlass::petsc {

namespace {

std::vector<std::string>& options() {
  static std::vector<std::string> list;
  return list;
}

std::string& error_message() {
  static std::string text;
  return text;
}

std::exception_ptr& kept_exception() {
  static std::exception_ptr pointer;
  return pointer;
}

/// PETSc calls this once per frame as an error travels up; the first call knows what happened.
PetscErrorCode record_error(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) {
    const char* general = nullptr;
    PetscErrorMessage(code, &general, nullptr);
    error_message() = std::string(function ? function : "PETSc") + ": " + (general ? general : "error");
    if (message && *message) error_message() += std::string(": ") + message;
  }
  return code;
}

/// Open MPI looks for networks, other processes and a resource manager before it starts, and hwloc for caches, buses
/// and (through an X server) screens: 0.4 s that a process started by hand need not wait for. Its folder for messages between
/// processes has one name for all that are started by hand: one that ends may take it away while another starts. A user's
/// own setting wins.
void shorten_mpi_start() {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMIX_RANK")) return;  // under mpirun
  const int keep = 0;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", keep);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", keep);
  setenv("OMPI_MCA_btl", "self", keep);
  setenv("OMPI_MCA_pml", "ob1", keep);
  setenv("OMPI_MCA_coll", "self,basic,libnbc", keep);
  setenv("OMPI_MCA_osc", "sm", keep);
  setenv("HWLOC_COMPONENTS", "no_os,stop", keep);
}

struct Session {
  Session() {
    shorten_mpi_start();
    // Signals are the program's: Ctrl-C saves, and a crash should reach the debugger undisturbed.
    std::vector<std::string> words = {"windlass", "-no_signal_handler", "-skip_petscrc"};
    words.insert(words.end(), options().begin(), options().end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    int argc = static_cast<int>(words.size());
    char** arguments = argv.data();
    if (PetscErrorCode code = SlepcInitialize(&argc, &arguments, nullptr, nullptr); code != 0)
      throw Error(code, "PETSc could not be started");
    PetscPushErrorHandler(record_error, nullptr);
    started = true;
  }
  ~Session() {
    started = false;
    PetscPopErrorHandler();
    SlepcFinalize();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  static inline bool started = false;
};

}  // namespace

void set_options(std::span<const std::string> list) {
  if (Session::started) throw std::logic_error("PETSc options given after PETSc has started");
  options().assign(list.begin(), list.end());
}

void ensure_session() { static Session session; }

namespace {

/// PETSc asks for these only when it ends.
bool asked_for_at_the_end(std::string_view name) {
  constexpr std::string_view late[] = {"-options_left", "-options_view", "-objects_dump", "-log_view",
                                       "-malloc_dump",  "-malloc_view",  "-help"};
  return std::find(std::begin(late), std::end(late), name) != std::end(late);
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && (std::isalpha(word[1]) || word[1] == '_');
}

}  // namespace

std::vector<std::string> unused_options() {
  std::vector<std::string> unused;
  for (const std::string& word : options()) {
    if (!is_option(word) || asked_for_at_the_end(word)) continue;
    PetscBool used = PETSC_FALSE;
    if (Session::started) check(PetscOptionsUsed(nullptr, word.c_str() + 1, &used));
    if (!used) unused.push_back(word);
  }
  return unused;
}

bool session_started() { return Session::started; }

void check(PetscErrorCode code) {
  if (code == 0) return;
  std::string message = std::exchange(error_message(), {});
  if (std::exception_ptr kept = std::exchange(kept_exception(), nullptr)) std::rethrow_exception(kept);
  if (message.empty()) message = "PETSc error " + std::to_string(code);
  throw Error(code, message);
}

void detail::keep_current_exception() noexcept { kept_exception() = std::current_exception(); }

}  // namespace windlass::petsc
