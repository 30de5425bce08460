#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>

#include "support/run_program.hpp"

namespace windlass::test {

/// Runs the program and sends it `signal` as soon as `ready` holds; like run_program if it ends before.
inline Outcome interrupt_program(const std::vector<std::string>& arguments,
                                 const std::filesystem::path& folder, int signal,
                                 const std::function<bool()>& ready) {
  const char* binary = std::getenv("WINDLASS_BINARY");
  if (!binary || !*binary)
    throw std::runtime_error("WINDLASS_BINARY does not name the program; run through ctest");
  const TemporaryFolder streams;
  const std::string out = streams.path() / "out", err = streams.path() / "err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    std::vector<char*> words = {const_cast<char*>(binary)};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    if (chdir(folder.c_str()) == 0) execv(binary, words.data());
    _exit(127);
  }
  int code = 0;
  for (;;) {
    if (waitpid(child, &code, WNOHANG) == child) break;
    if (ready()) {
      kill(child, signal);
      waitpid(child, &code, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  const int status = WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code);
  return {status, slurp(out), slurp(err)};
}

}  // namespace windlass::test
