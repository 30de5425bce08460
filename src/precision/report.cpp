#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "windlass/output/atomic_file.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/gnuplot.hpp"
#include "windlass/precision/study.hpp"

namespace windlass::precision {

using output::format_number;

namespace {

std::string cell(const std::optional<double>& value) { return value ? format_number(*value) : std::string(); }

std::string name(const Measurement& m) {
  return m.stages ? fmt::format("{}, {} stages", m.method, m.stages) : m.method;
}

/// Measurements by method and order, in the order they were made.
std::vector<std::pair<std::string, std::vector<Measurement>>> series(const Study& study) {
  std::vector<std::pair<std::string, std::vector<Measurement>>> out;
  for (const Measurement& m : study.measurements) {
    if (out.empty() || out.back().first != name(m)) out.emplace_back(name(m), std::vector<Measurement>{});
    out.back().second.push_back(m);
  }
  return out;
}

/// One colour a method, lighter symbols for other orders.
const char* colour(const std::string& method) {
  static const std::map<std::string, const char*> colours{{"closed form", "#000000"},
                                                          {"planar arcs", "#0072b2"},
                                                          {"planar arcs, tail by formula", "#56b4e9"},
                                                          {"Kirchhoff arcs, half", "#d55e00"},
                                                          {"Kirchhoff arcs, full", "#cc79a7"},
                                                          {"nodal complementarity", "#009e73"},
                                                          {"discrete elastic rod", "#e69f00"}};
  const auto found = colours.find(method);
  return found == colours.end() ? "#7f7f7f" : found->second;
}

/// The quantities compared, as columns of precision.dat after the two of cost.
struct Shown {
  const char* name;
  std::optional<double> (*error)(const Quantities& error);
};
const Shown shown[] = {{"R_{tot}", [](const Quantities& e) { return std::optional(e.R_tot); }},
                       {"{/Symbol f}*", [](const Quantities& e) { return std::optional(e.phi_star); }},
                       {"energy", [](const Quantities& e) { return std::optional(e.energy); }},
                       {"transition tension", [](const Quantities& e) { return e.transition; }}};

/// Methods and orders as lines of one panel; those without the quantity are left out.
std::string panel(const Study& study, int cost, int quantity) {
  std::string text;
  int block = -1;
  for (const auto& [title, rows] : series(study)) {
    ++block;
    if (!shown[quantity].error(rows.front().error)) continue;
    const int symbol = rows.front().stages ? 4 + rows.front().stages / 2 : 7;
    text += fmt::format(
        "{}'precision.dat' index {} using {}:{} with linespoints lc rgb '{}' pt {} ps 0.6 title {}",
        text.empty() ? "  plot " : ", \\\n    ", block, cost, quantity + 3, colour(rows.front().method),
        symbol, output::gnuplot_text(title));
  }
  return text + "\n";
}

/// One picture: the errors of all quantities against one cost, one key for all.
std::string picture_body(const Study& study, int cost, const std::string& label) {
  const bool transition = study.reference.transition.has_value();
  std::string body = fmt::format(
      "  set multiplot layout 2,2 margins screen 0.08,0.985,0.22,0.965 spacing screen 0.09,screen 0.1\n"
      "  set logscale xy\n  set format xy '10^{{%L}}'\n  set xtics 10\n  set ytics 100\n"
      "  set mxtics 10\n  set mytics 1\n  set grid lc rgb '#dddddd'\n  set yrange [1e-16:10]\n"
      "  set xlabel '{}' offset 0,0.4\n"
      "  set key at screen 0.5,screen 0.01 center bottom maxrows 5 samplen 2 width -2\n",
      label);
  for (int quantity = 0; quantity < (transition ? 4 : 3); ++quantity) {
    body += fmt::format("  set title 'relative error of {}'\n", shown[quantity].name);
    body += panel(study, cost, quantity) + "  unset key\n";
  }
  return body + "  unset multiplot\n";
}

}  // namespace

std::string to_csv(const Study& study) {
  std::string text =
      "method,elements,stages,unknowns,seconds,R_tot,phi_star,energy,transition,error_R_tot,error_phi_star,"
      "error_energy,error_transition\n";
  for (const Measurement& m : study.measurements)
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{}\n", output::csv_cell(m.method), m.elements, m.stages,
        m.unknowns, format_number(m.seconds), format_number(m.value.R_tot), format_number(m.value.phi_star),
        format_number(m.value.energy), cell(m.value.transition), format_number(m.error.R_tot),
        format_number(m.error.phi_star), format_number(m.error.energy), cell(m.error.transition));
  return text;
}

std::vector<std::string> conclusions(const Study& study) {
  std::vector<std::string> out;
  for (const double level : {1e-3, 1e-6, 1e-9}) {
    const Measurement* best = nullptr;
    const Measurement* meshed = nullptr;  // a formula wins wherever it holds; say what comes next
    for (const Measurement& m : study.measurements) {
      if (m.error.R_tot > level) continue;
      if (!best || m.seconds < best->seconds) best = &m;
      if (m.elements > 0 && (!meshed || m.seconds < meshed->seconds)) meshed = &m;
    }
    const auto text = [](const Measurement& m) {
      return m.elements ? fmt::format("{} on {} elements ({:.3g} ms)", name(m), m.elements, 1e3 * m.seconds)
                        : name(m);
    };
    std::string sentence = fmt::format("R_tot to {:.0e}: ", level);
    if (!best)
      sentence += "no method on these ladders.";
    else if (meshed && meshed != best)
      sentence +=
          fmt::format("cheapest is the {}; of the methods with a mesh, {}.", text(*best), text(*meshed));
    else
      sentence += fmt::format("cheapest is {}.", text(*best));
    out.push_back(sentence);
  }
  return out;
}

std::vector<std::filesystem::path> draw(const Study& study, const std::filesystem::path& folder,
                                        const std::vector<std::string>& formats) {
  constexpr double rounding = 1e-16;  // an error of zero has no place on a logarithmic axis
  std::string data =
      "# seconds unknowns error_R_tot error_phi_star error_energy error_transition; a block for each method "
      "and order\n";
  for (const auto& [title, rows] : series(study)) {
    data += "# " + title + "\n";
    for (const Measurement& m : rows) {
      data += fmt::format("{} {}", format_number(m.seconds), std::max(m.unknowns, 1));
      for (const Shown& quantity : shown) {
        const auto error = quantity.error(m.error);
        data += " " + (error ? format_number(std::max(*error, rounding)) : "NaN");
      }
      data += "\n";
    }
    data += "\n\n";
  }
  output::replace_file(folder / "precision.dat", std::string_view(data));
  std::vector<std::filesystem::path> pictures;
  for (const auto& [name, cost, label] :
       {std::tuple("precision", 1, "processor time [s]"), std::tuple("precision-unknowns", 2, "unknowns")}) {
    const output::Picture picture{name, 9.0, 8.5, picture_body(study, cost, label)};
    for (auto& path : output::run_gnuplot(picture, folder, formats)) pictures.push_back(path);
  }
  return pictures;
}

}  // namespace windlass::precision
