#include "style.hpp"

#include <fmt/format.h>

namespace windlass::figures {

std::string tension_axis(double low, double high) {
  return fmt::format(
      "  set log x\n  set xrange [{}:{}]\n  set format x '%g'\n  set xlabel 'tension T  [EI/ρ²]' offset "
      "0,0.2\n",
      low, high);
}

std::string force_axis(double low, double high, const std::string& title) {
  return fmt::format(
      "  set log y\n  set yrange [{}:{}]\n  set format y '%g'\n  set ylabel '{}' offset 1.2,0\n", low, high,
      title);
}

std::string item(const std::string& run, int block, int column, const std::string& style) {
  return fmt::format("'{}.dat' index {} using 1:{} with lines {}", run, block, column, style);
}

std::string panel_letter(char letter, const std::string& title) {
  return fmt::format("  set label 50 '({}) {}' at graph 0, graph 1.05 left font ',10'\n", letter, title);
}

}  // namespace windlass::figures
