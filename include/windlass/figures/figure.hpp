#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "windlass/figures/study.hpp"

namespace windlass::figures {

/// What the paper says, beside what comes out here.
struct Statement {
  std::string paper, here;
  enum class Verdict { agrees, differs, remark } verdict = Verdict::agrees;
  std::string why;  ///< of a difference
};

const char* name(Statement::Verdict verdict);

struct Figure {
  std::string stem;    ///< of its files
  std::string title;   ///< what it shows and which figure of the paper it is
  std::string legend;  ///< how to read it
  std::vector<std::string> runs;
  std::vector<Statement> statements;
};

/// Where pictures go and in which formats.
struct Canvas {
  std::filesystem::path folder;
  std::vector<std::string> formats = {"png", "svg", "pdf"};
};

/// Data of a run for all figures, NAME.dat: columns T, R_tot, phi_star/π, dlog R_tot/dlog T, R_tot/phi; one block (two blank
/// lines apart) for each of: 0 flat states with a line contact, stable; 1 the same, unstable; 2 flat states with touches,
/// stable; 3 unstable; 4 helical states, stable; 5 unstable.
void write_run_data(const std::string& name, const StudyRun& study, const Canvas& canvas);

Figure contact_force(const Study& study, const Canvas& canvas);   ///< R_tot(T) and its log slope, five angles
Figure strength(const Study& study, const Canvas& canvas);        ///< F0/mu at each angle
Figure collapse(const Study& study, const Canvas& canvas);        ///< F0/(mu phi)
Figure pressure(const Study& study, const Canvas& canvas);        ///< along the contact, phi = π and 2π
Figure pressure_map(const Study& study, const Canvas& canvas);    ///< the same on the unrolled cylinder
Figure wrapping_angle(const Study& study, const Canvas& canvas);  ///< 2 phi_star at 4π
Figure surgical_knot(const Study& study, const Canvas& canvas);   ///< n loops against one coil

Figure radius_ratio(const Study& study, const Canvas& canvas);  ///< R_tot at 4π, R/r = 1, 2.5, 5
Figure contact_set(const Study& study, const Canvas& canvas);   ///< wrapping angle and lines at 4π, the same
Figure crossing_map(const Study& study, const Canvas& canvas);  ///< where strands meet, in (T, R/r)
Figure thin_limit(const Study& study, const Canvas& canvas);    ///< tilt and R_tot at 2π against r
Figure clove_hitch(const Study& study, const Canvas& canvas);   ///< R_tot(T), R/r = 1, 2.5, 5
Figure sliding(const Study& study,
               const Canvas& canvas);  ///< F0/mu on a plate with friction in the shape; pulls
Figure sliding_hitch(const Study& study, const Canvas& canvas);  ///< F0/mu against R_tot; the clove hitch

/// All of them. @throws output::OutputError when a file cannot be written or gnuplot fails
std::vector<Figure> draw_all(const Study& study, const Canvas& canvas);

/// index.html: every figure with its commands and statements. @return the file
std::filesystem::path write_page(const std::vector<Figure>& figures, const Study& study, const Canvas& canvas,
                                 const std::string& invocation, double seconds);

}  // namespace windlass::figures
