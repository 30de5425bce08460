#include <fmt/format.h>

#include <array>
#include <cmath>

#include "windlass/figures/figure.hpp"
#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/plot.hpp"
#include "windlass/output/stable_state.hpp"

namespace windlass::figures {

namespace {

constexpr std::array titles = {"flat, line contact, stable",
                               "flat, line contact, unstable",
                               "flat, touches, stable",
                               "flat, touches, unstable",
                               "helical, stable",
                               "helical, unstable"};

/// Block of the stretch between two rows.
std::size_t family(const output::BranchRow& a, const output::BranchRow& b) {
  const std::size_t unstable = output::index_between(a, b) == 0 ? 0 : 1;
  constexpr double flat = 1e-7;  // [ρ] of height
  if (a.z_span > flat || b.z_span > flat) return 4 + unstable;
  return (b.topology.find("line") != std::string::npos ? 0 : 2) + unstable;
}

std::string known(double value) { return std::isfinite(value) ? output::format_number(value) : "?"; }

std::string line(const output::BranchRow& row, double phi_star, double alpha) {
  return fmt::format("{} {} {} {} {}\n", row.T, row.R_tot, known(phi_star / M_PI), known(alpha),
                     row.R_tot / row.phi);
}

/// phi_star of the first of two rows as the place to draw from: none where the outermost contact is another beyond an
/// event, so that phi_star jumps.
double phi_star_from(const output::BranchRow& first, const output::BranchRow& second) {
  constexpr double jump = 0.3;  // [rad]; steps along branches are below 0.1
  return std::abs(second.phi_star - first.phi_star) > jump ? std::nan("") : first.phi_star;
}

}  // namespace

void write_run_data(const std::string& name, const StudyRun& study, const Canvas& canvas) {
  std::array<std::string, titles.size()> blocks;
  const auto& rows = study.run.rows;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    for (end = begin + 1; end < rows.size() && rows[end].branch == rows[begin].branch;) ++end;
    const std::vector<output::BranchRow> branch(rows.begin() + static_cast<std::ptrdiff_t>(begin),
                                                rows.begin() + static_cast<std::ptrdiff_t>(end));
    const std::vector<double> alpha = output::log_slopes(branch);
    int drawn = -1;
    for (std::size_t i = 1; i < branch.size(); ++i) {
      const auto now = static_cast<int>(family(branch[i - 1], branch[i]));
      std::string& block = blocks[static_cast<std::size_t>(now)];
      // An event has the topology before it, and so its log slope: none from there on.
      const bool changed = branch[i - 1].topology != branch[i].topology;
      if (now != drawn || changed)
        block += "\n" + line(branch[i - 1],
                             changed ? phi_star_from(branch[i - 1], branch[i]) : branch[i - 1].phi_star,
                             changed ? std::nan("") : alpha[i - 1]);
      block += line(branch[i], branch[i].phi_star, alpha[i]);
      drawn = now;
    }
  }
  std::string text = "# T | R_tot | phi_star/pi | dlog R_tot/dlog T | R_tot/phi; ? = not defined\n";
  for (std::size_t k = 0; k < titles.size(); ++k)
    text += fmt::format("# block {}: {}\n? ? ? ? ?\n{}\n\n", k, titles[k], blocks[k]);
  output::replace_file(canvas.folder / (name + ".dat"), std::string_view(text));
}

}  // namespace windlass::figures
