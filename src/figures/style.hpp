#pragma once

#include <string>

#include "windlass/figures/figure.hpp"

/// What the figures' scripts have in common.
namespace windlass::figures {

/// The five capstan angles, largest first as in the paper's panels.
struct Angle {
  const char* run;     ///< name in the study
  const char* title;   ///< for readers
  const char* colour;  ///< Okabe & Ito: distinct in print and for colour-blind readers
};
inline constexpr Angle angles[] = {{"4pi", "4π", "#0072b2"},
                                   {"2pi", "2π", "#d55e00"},
                                   {"pi", "π", "#009e73"},
                                   {"half-pi", "π/2", "#cc79a7"},
                                   {"quarter-pi", "π/4", "#e69f00"}};

inline constexpr const char* flat_colour = "#0072b2";
inline constexpr const char* helical_colour = "#d55e00";

/// Closed form of the planar capstan as functions R(T, phi), alpha(T, phi) of the script, undefined below the limit.
inline constexpr const char* closed_form =
    "  limit(phi) = phi < pi ? 0.5/(1 - cos(phi/2)) : 0.5\n"
    "  phistar(T,phi) = T < limit(phi)*(1 - 1e-9) ? NaN : phi/2 - acos(1 - 1/(2.0*T))\n"
    "  R(T,phi) = (2*T - 1)*phistar(T,phi) + sqrt(4*T - 1)\n"
    "  alpha(T,phi) = 1 + phistar(T,phi)/R(T,phi)\n";

/// First commands of every picture.
inline constexpr const char* opening =
    "  set datafile missing '?'\n  set samples 600\n  set multiplot\n  set tics font ',9'\n"
    "  set grid lc rgb '#dddddd'\n  set key font ',9'\n";

/// The axis of tension, in logarithms.
std::string tension_axis(double low, double high);

/// Logarithmic axis of a force along the left side; `title` is what is measured, with its unit.
std::string force_axis(double low, double high, const std::string& title);

/// A vertical line at T = 1/2, where the line contact of a flat coil ends; `unset arrow 1` takes it away.
inline constexpr const char* contact_limit =
    "  set arrow 1 from 0.5, graph 0 to 0.5, graph 1 nohead lw 2 lc rgb '#b0b0b0' back\n";

/// A block of NAME.dat as an item of a plot command.
std::string item(const std::string& run, int block, int column, const std::string& style);

/// (a), (b) ... above a panel's left corner.
std::string panel_letter(char letter, const std::string& title);

}  // namespace windlass::figures
