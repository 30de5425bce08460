#include <fmt/format.h>

#include <algorithm>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/pull/outcome.hpp"

namespace windlass::pull {

namespace {

std::string pull_data(const PictureRequest& request) {
  std::string text = "# a block a mesh: U | F | part of R_tot that sticks | lowest z\n";
  for (const MeshOutcome& mesh : request.meshes) {
    text += output::data_line({0.0, 0.0, 1.0, mesh.rows.empty() ? 0.0 : mesh.rows.front().at.z_low});
    for (const Row& row : mesh.rows)
      text +=
          output::data_line({row.displacement, row.at.drag * request.force, row.at.sticking, row.at.z_low});
    text += "\n\n";
  }
  return text;
}

std::string force_panel(const PictureRequest& request, double reach) {
  double most = request.limit.value_or(0.0);
  for (const MeshOutcome& mesh : request.meshes)
    for (const Row& row : mesh.rows) most = std::max(most, row.at.drag);
  for (const double F0 : request.steady)
    if (F0 < 2.0 * most) most = std::max(most, F0);  // far ones would press the curve down
  const double top = 1.15 * most * request.force;
  std::string text = output::margins(0.12, request.newtons ? 0.87 : 0.90, 0.40, 0.91);
  text += fmt::format("  set xrange [0:{}]\n  set yrange [0:{}]\n", reach, top);
  text += "  set format x ''\n  set ylabel 'force on the cylinder F  [EI/ρ²]'\n  set key bottom right\n";
  if (request.newtons)
    text += fmt::format("  set ytics nomirror\n  set y2tics\n  set y2range [0:{}]\n  set y2label 'F  [N]'\n",
                        top / request.force * *request.newtons);
  std::string plot = "  plot ";
  for (std::size_t k = 0; k < request.steady.size(); ++k) {
    const bool chosen = request.selected == k;
    plot += fmt::format("{} with lines lw {} dt 2 lc rgb '{}' title 'steady state, F_0 = {:.5g}{}', \\\n    ",
                        request.steady[k] * request.force, chosen ? 2 : 1, chosen ? "#d55e00" : "#999999",
                        request.steady[k] * request.force, chosen ? ", selected" : "");
  }
  for (std::size_t k = 0; k < request.meshes.size(); ++k) {
    const bool finest = k + 1 == request.meshes.size();
    plot += fmt::format("'pull.dat' index {} using 1:2 with lines lw {} lc rgb '{}' title 'h = {:.3g}'{}", k,
                        finest ? 2 : 1, finest ? "#0072b2" : "#9ec5df", request.meshes[k].h,
                        finest ? "\n" : ", \\\n    ");
  }
  return text + plot;
}

std::string state_panel(const PictureRequest& request) {
  std::string text = output::margins(0.12, request.newtons ? 0.87 : 0.90, 0.11, 0.36);
  const std::size_t finest = request.meshes.size() - 1;
  text += "  unset y2tics\n  unset y2label\n  set format x '%g'\n  set xlabel 'displacement U  [ρ]'\n";
  text += "  set yrange [*:*]\n  set ylabel 'lowest z  [ρ]'\n  set ytics nomirror\n";
  text += "  set y2range [0:1.05]\n  set y2tics 0.5\n  set y2label 'sticks'\n  set key top right\n";
  text += fmt::format(
      "  plot 'pull.dat' index {} using 1:4 with lines lw 2 lc rgb '#009e73' title 'lowest z', \\\n"
      "    '' index {} using 1:3 axes x1y2 with lines lw 2 lc rgb '#cc79a7' title 'part that sticks'\n",
      finest, finest);
  return text;
}

}  // namespace

std::vector<std::filesystem::path> draw(const PictureRequest& request, const std::filesystem::path& folder) {
  output::replace_file(folder / "pull.dat", std::string_view(pull_data(request)));
  double reach = 0.0;
  for (const MeshOutcome& mesh : request.meshes)
    if (!mesh.rows.empty()) reach = std::max(reach, mesh.rows.back().displacement);
  output::Picture picture{"pull", 6.0, 5.6, {}};
  picture.body = "  set multiplot\n  set tics font ',9'\n  set grid lc rgb '#dddddd'\n  set key font ',9'\n";
  picture.body += "  set label 1 " + output::gnuplot_text(request.title) +
                  " at screen 0.54, screen 0.955 center font ',11'\n";
  picture.body +=
      force_panel(request, reach) + "  unset label\n" + state_panel(request) + "  unset multiplot\n";
  return output::run_gnuplot(picture, folder, request.formats);
}

}  // namespace windlass::pull
