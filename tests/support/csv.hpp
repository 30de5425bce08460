#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_program.hpp"

namespace windlass::test {

/// A table as the program writes it; a quoted cell may hold commas.
struct Table {
  std::vector<std::string> header;
  std::vector<std::map<std::string, std::string>> rows;
};

inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      words.emplace_back();
    else
      words.back().push_back(c);
  }
  return words;
}

inline Table read_csv(const std::filesystem::path& path) {
  std::istringstream text(slurp(path));
  Table table;
  std::string line;
  if (std::getline(text, line)) table.header = split(line);
  while (std::getline(text, line)) {
    const std::vector<std::string> words = split(line);
    auto& row = table.rows.emplace_back();
    for (std::size_t k = 0; k < words.size() && k < table.header.size(); ++k) row[table.header[k]] = words[k];
  }
  return table;
}

}  // namespace windlass::test
