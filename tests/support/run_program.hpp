#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace windlass::test {

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal if killed by one
  std::string out, err;
};

inline std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

inline std::string slurp(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Path of a scene that comes with the program. Its folder is what ctest names in WINDLASS_SCENES.
inline std::string shipped_scene(const std::string& name) {
  return std::string(std::getenv("WINDLASS_SCENES")) + "/" + name + ".toml";
}

/// Runs the program as a user does. The binary is what ctest names in WINDLASS_BINARY.
/// @param folder  working directory of the program; its runs/ end up there
/// @param before  shell words in front of the program: a limit to set, another program that runs it
inline Outcome run_program(const std::vector<std::string>& arguments,
                           const std::filesystem::path& folder = ".", const std::string& before = "") {
  const char* binary = std::getenv("WINDLASS_BINARY");
  if (!binary || !*binary)
    throw std::runtime_error("WINDLASS_BINARY does not name the program; run through ctest");
  const TemporaryFolder streams;
  std::string command = "cd " + quoted(folder.string()) + " && " + before + " " + quoted(binary);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command +=
      " > " + quoted(streams.path() / "out") + " 2> " + quoted(streams.path() / "err") + " < /dev/null";
  const int code = std::system(command.c_str());
  const int status = WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code);
  return {status, slurp(streams.path() / "out"), slurp(streams.path() / "err")};
}

}  // namespace windlass::test
