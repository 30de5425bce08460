#include "strut_picture.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "windlass/output/branches_csv.hpp"

namespace windlass::output {

using Eigen::Vector3d;

namespace {

/// 1, 2 or 5 times a power of ten, at least `least`.
double nice_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(least, 1e-12))));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= least * (1 - 1e-9)) return digit * decade;
  return 10.0 * decade;
}

/// As high as long: a loop, whose views stand side by side.
bool is_tall(const equilibrium::Solution& solution, const Eigen::AlignedBox3d& box) {
  return solution.z_span >= 1e-6 && std::max(box.sizes().y(), box.sizes().z()) > 0.6 * box.sizes().x();
}

}  // namespace

Picture strut_picture(const equilibrium::Solution& solution, const RodCurve& curve, const std::string& title,
                      const std::string& subtitle, const std::string& stem) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& r : curve.r) box.extend(r);
  const bool planar = solution.z_span < 1e-6, tall = is_tall(solution, box);
  const double margin = 0.08 * box.sizes().maxCoeff(),
               half = 0.5 * std::max(box.sizes().y(), planar ? 0.0 : box.sizes().z()) + margin;
  const auto range = [](const char* name, double low, double high) {
    return std::string("  set ") + name + " [" + format_number(low) + ":" + format_number(high) + "]\n";
  };
  const double tic = nice_step(box.sizes().maxCoeff() / 4.0);
  std::string text = std::string("  set multiplot layout ") +
                     (planar ? "1,1"
                      : tall ? "1,2"
                             : "2,1") +
                     " margins screen 0.11,0.96,0.14,0.86 " +
                     "spacing screen 0.12\n  unset key\n  set size ratio -1\n  set grid lc rgb '#dddddd'\n";
  text += "  set xtics " + format_number(tic) + "\n  set ytics " + format_number(tic) + "\n";
  text += "  set label 1 " + gnuplot_text(title) + " at screen 0.5, screen 0.965 center font ',11'\n";
  text += "  set label 2 " + gnuplot_text(subtitle, false) + " at screen 0.5, screen 0.91 center font ',9'\n";
  text += range("xrange", box.min().x() - margin, box.max().x() + margin) + "  set xlabel 'x  [ρ]'\n";
  for (int k = 1; k <= (planar ? 1 : 2); ++k) {
    text += range("yrange", box.center()[k] - half, box.center()[k] + half) + "  set ylabel '" +
            (k == 1 ? "y" : "z") + "  [ρ]'\n  plot '" + stem +
            "-curve.dat' using 2:" + std::to_string(k + 2) +
            " with lines lc rgb '#303030' lw 3\n  unset label\n";
  }
  return {stem, tall ? 8.4 : 7.0, planar ? 4.2 : tall ? 4.8 : 5.6, text + "  unset multiplot\n"};
}

}  // namespace windlass::output
