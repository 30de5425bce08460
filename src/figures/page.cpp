#include <fmt/format.h>

#include "windlass/figures/figure.hpp"
#include "windlass/output/atomic_file.hpp"

namespace windlass::figures {

namespace {

constexpr const char* style = R"(
body { font: 16px/1.45 sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
img { width: 100%; max-width: 60rem; } h2 { margin-top: 3rem; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { text-align: left; vertical-align: top; padding: .45rem .6rem; border-top: 1px solid #ccc; }
td:nth-child(3) { white-space: nowrap; } .differs { color: #a33; font-weight: bold; } .agrees { color: #27632a; }
pre { background: #f4f4f4; padding: .6rem; overflow-x: auto; font-size: 13px; } .legend { color: #555; }
)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string statement_row(const Statement& statement) {
  const char* verdict = name(statement.verdict);
  return fmt::format("<tr><td>{0}</td><td>{1}{2}</td><td class=\"{3}\">{3}</td></tr>\n",
                     escaped(statement.paper), escaped(statement.here),
                     statement.why.empty() ? "" : "<br><em>" + escaped(statement.why) + "</em>", verdict);
}

/// Extension of the files of a format such as "png@100".
std::string extension(const std::string& format) { return format.substr(0, format.find('@')); }

std::string section(const Figure& figure, const Study& study, const Canvas& canvas) {
  std::string text = fmt::format("<h2 id=\"{0}\">{1}</h2>\n", figure.stem, escaped(figure.title));
  const std::string shown =
      extension(canvas.formats.front() == "pdf" ? canvas.formats.back() : canvas.formats.front());
  text += fmt::format("<img src=\"{}.{}\" alt=\"{}\">\n<p class=\"legend\">{} ", figure.stem, shown,
                      escaped(figure.title), escaped(figure.legend));
  for (const std::string& format : canvas.formats)
    text += fmt::format("<a href=\"{0}.{1}\">{1}</a> ", figure.stem, extension(format));
  text += fmt::format(
      "<a href=\"{}.gp\">script</a></p>\n<table>\n<tr><th>the paper</th><th>here</th><th></th></tr>\n",
      figure.stem);
  for (const Statement& statement : figure.statements) text += statement_row(statement);
  text += "</table>\n<p>Computed by</p>\n<pre>";
  for (const std::string& name : figure.runs) {
    const StudyRun& run = study.at(name);
    text += escaped(run.command) + "\n";
    for (const auto& lost : run.run.info.lost_branches)
      text += escaped(fmt::format("# incomplete: branch {} could not be followed beyond T = {:.4f} ({})\n",
                                  lost.branch, lost.T, lost.reason));
  }
  return text + "</pre>\n";
}

}  // namespace

const char* name(Statement::Verdict verdict) {
  return verdict == Statement::Verdict::agrees    ? "agrees"
         : verdict == Statement::Verdict::differs ? "differs"
                                                  : "remark";
}

std::filesystem::path write_page(const std::vector<Figure>& figures, const Study& study, const Canvas& canvas,
                                 const std::string& invocation, double seconds) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Figures by "
      "windlass</title>\n<style>{}"
      "</style></head><body>\n<h1>The paper's figures, computed by windlass {}</h1>\n"
      "<p>J. Sabater, J.-S. Park, J. Crassous, S. Neukirch, P. M. Reis: <em>Frictional sliding strength of "
      "knotted and "
      "capstan configurations along the axis of a cylinder</em>. Made by <code>{}</code> in {:.1f} s; every "
      "curve is "
      "computed anew, none is read off the paper.</p>\n"
      "<p>The model: an inextensible Kirchhoff rod, GJ/EI = 2/3, ends free of moment unless said otherwise, "
      "round a rigid "
      "cylinder without friction in the wrapping plane and without plates, both but in the figures of the "
      "sliding strength on a plate; no deformation of its cross-section. "
      "Rods are thin "
      "(they pass through themselves) in the figures of the paper's main text; in those on R/r they have "
      "their thickness "
      "and touch themselves, at points. Length in ρ = R + r, force in EI/ρ². “Stable” means against every "
      "perturbation of that "
      "rod in "
      "space. Not remade are the experimental, FEM "
      "and DER points, "
      "for which the paper gives no numbers.</p>\n<ul>\n",
      style, WINDLASS_VERSION, escaped(invocation), seconds);
  for (const Figure& figure : figures)
    text += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", figure.stem, escaped(figure.title));
  text += "</ul>\n";
  for (const Figure& figure : figures) text += section(figure, study, canvas);
  const std::filesystem::path file = canvas.folder / "index.html";
  output::replace_file(file, std::string_view(text + "</body></html>\n"));
  return file;
}

std::vector<Figure> draw_all(const Study& study, const Canvas& canvas) {
  for (const auto& [name, run] : study)
    if (!(run.scene.rod_radius > 0.0))
      write_run_data(name, run, canvas);  // thick rods have files of their own
  std::vector<Figure> figures;
  for (const auto& draw :
       {contact_force, strength, collapse, pressure, pressure_map, wrapping_angle, surgical_knot,
        radius_ratio, contact_set, crossing_map, thin_limit, clove_hitch, sliding, sliding_hitch})
    figures.push_back(draw(study, canvas));
  return figures;
}

}  // namespace windlass::figures
