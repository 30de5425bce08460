#include "plot_diagram_data.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "windlass/output/plot.hpp"
#include "windlass/output/stable_state.hpp"

namespace windlass::output {

std::vector<double> log_slopes(const std::vector<BranchRow>& rows) {
  const std::size_t count = rows.size();
  std::vector<double> slopes(count, std::nan(""));
  const auto same_arm = [&](std::size_t i, std::size_t j) { return rows[i].topology == rows[j].topology; };
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    for (end = begin + 1; end < count && same_arm(begin, end);) ++end;
    if (end - begin < 3) continue;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t k = std::clamp(i, begin + 1, end - 2);  // centre of the three points used
      const double x[3] = {std::log(rows[k - 1].T), std::log(rows[k].T), std::log(rows[k + 1].T)};
      const double y[3] = {std::log(rows[k - 1].R_tot), std::log(rows[k].R_tot), std::log(rows[k + 1].R_tot)};
      // derivatives with respect to the chord length t, so that folds in T are no obstacle, then their quotient
      const double a = std::hypot(x[1] - x[0], y[1] - y[0]), b = std::hypot(x[2] - x[1], y[2] - y[1]);
      if (!(a > 0.0) || !(b > 0.0)) continue;
      const double at = i < k ? -a : i > k ? b : 0.0;  // t of point i, 0 at the centre
      const auto derivative = [&](const double(&v)[3]) {
        const double left = (v[1] - v[0]) / a, right = (v[2] - v[1]) / b;
        return (left * b + right * a) / (a + b) + 2.0 * (right - left) / (a + b) * at;
      };
      const double dx = derivative(x), dy = derivative(y);
      if (std::abs(dx) > 1e-3) slopes[i] = dy / dx;
    }
  }
  return slopes;
}

namespace {

ArmState state_between(const BranchRow& first, const BranchRow& second) {
  const std::optional<int> index = index_between(first, second);
  if (!index) return ArmState::unknown;
  return *index == 0 ? ArmState::stable : ArmState::unstable;
}

/// A quantity of a row, given the row and alpha there.
struct Quantity {
  Axis axis;
  std::function<double(const BranchRow&, double alpha)> value;
};

double spread(const Run& run, double BranchRow::*member) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const BranchRow& row : run.rows) low = std::min(low, row.*member), high = std::max(high, row.*member);
  return high - low;
}

Quantity horizontal_axis(const Run& run) {
  if (!run.info.has_cylinder) {
    if (spread(run, &BranchRow::shortening) > 1e-9 || run.info.extra_parameter.empty()) {
      return {{"shortening", "end shortening / length", false, 0, 0},
              [](const BranchRow& r, double) { return r.shortening; }};
    }
  }
  const bool T_varies = spread(run, &BranchRow::T) > 1e-9, phi_varies = spread(run, &BranchRow::phi) > 1e-9;
  if (!run.info.extra_parameter.empty() && !T_varies && !phi_varies) {
    return {{run.info.extra_parameter, run.info.extra_parameter, false, 0, 0},
            [](const BranchRow& r, double) { return r.parameter.value_or(std::nan("")); }};
  }
  if (phi_varies) {
    return {{"phi/pi", "capstan angle φ/π", false, 0, 0},
            [](const BranchRow& r, double) { return r.phi / std::numbers::pi; }};
  }
  return {{"T", "tension T  [EI/ρ²]", true, 0, 0}, [](const BranchRow& r, double) { return r.T; }};
}

std::vector<Quantity> capstan_quantities(const Run& run, bool against_T) {
  std::vector<Quantity> list;
  if (!against_T && spread(run, &BranchRow::T) > 1e-9)  // a locus
    list.push_back({{"T", "tension T  [EI/ρ²]", true, 0, 0}, [](const BranchRow& r, double) { return r.T; }});
  list.push_back({{"R_tot", "total contact force R_{tot}  [EI/ρ²]", against_T, 0, 0},
                  [](const BranchRow& r, double) { return r.R_tot; }});
  if (against_T) {
    list.push_back(
        {{"alpha", "α = dlog R_{tot} / dlog T", false, 0, 0}, [](const BranchRow&, double a) { return a; }});
  } else if (list.size() == 1) {
    list.push_back(
        {{"energy", "energy  [EI/ρ]", false, 0, 0}, [](const BranchRow& r, double) { return r.energy; }});
  }
  list.push_back({{"phi_star/pi", "half contact angle φ^*/π", false, 0, 0},
                  [](const BranchRow& r, double) { return r.phi_star / std::numbers::pi; }});
  double z_span = 0.0;
  for (const BranchRow& row : run.rows) z_span = std::max(z_span, row.z_span);
  constexpr double flat = 1e-4;  // beside the singular points of a locus flat coils are flat to 1e-6 only
  if (z_span > flat) {
    list.push_back({{"tilt", "tilt at the mid-point  [°]", false, 0, 0},
                    [](const BranchRow& r, double) { return r.tilt * 180.0 / std::numbers::pi; }});
  } else if (run.rows.front().eigenvalue_1) {
    list.push_back({{"eigenvalue_1", "lowest eigenvalue", false, 0, 0},
                    [](const BranchRow& r, double) { return r.eigenvalue_1.value_or(std::nan("")); }});
  } else {
    list.push_back(
        {{"energy", "energy  [EI/ρ]", false, 0, 0}, [](const BranchRow& r, double) { return r.energy; }});
  }
  return list;
}

/// Without the quantities that few points have, such as eigenvalues of a run without `stability`, or that vanish
/// throughout, such as the axial moment of a strut that is not twisted.
std::vector<Quantity> existing(std::vector<Quantity> quantities, const Run& run) {
  std::erase_if(quantities, [&](const Quantity& quantity) {
    const auto known = std::count_if(run.rows.begin(), run.rows.end(), [&](const BranchRow& row) {
      return std::isfinite(quantity.value(row, 1.0));
    });
    const bool some = std::any_of(run.rows.begin(), run.rows.end(), [&](const BranchRow& row) {
      return std::abs(quantity.value(row, 1.0)) > 1e-12;
    });
    return !some || 2 * known < static_cast<std::ptrdiff_t>(run.rows.size());
  });
  return quantities;
}

std::vector<Quantity> strut_quantities() {
  return {{{"end_force", "end thrust  [EI/ρ²]", false, 0, 0},
           [](const BranchRow& r, double) { return r.end_force; }},
          {{"end_moment", "axial end moment  [EI/ρ]", false, 0, 0},
           [](const BranchRow& r, double) { return r.end_moment; }},
          {{"energy", "energy  [EI/ρ]", false, 0, 0}, [](const BranchRow& r, double) { return r.energy; }},
          {{"eigenvalue_1", "lowest eigenvalue", false, 0, 0},
           [](const BranchRow& r, double) { return r.eigenvalue_1.value_or(std::nan("")); }}};
}

/// Range that holds the central 96 % of the values with a margin: a few huge ones (alpha beside a fold, an
/// eigenvalue at the end of a branch) must not flatten the rest. Log axes cover everything.
void choose_range(Axis& axis, std::vector<double> values) {
  std::erase_if(values, [&](double v) { return !std::isfinite(v) || (axis.log && v <= 0.0); });
  if (values.empty()) {
    axis.log = false, axis.low = 0.0, axis.high = 1.0;  // e.g. alpha of a branch of two points
    return;
  }
  std::sort(values.begin(), values.end());
  if (axis.log) {
    axis.log = values.back() / values.front() > 5.0;
    if (axis.log) {
      // where contact is about to be lost R_tot goes to zero: five decades are enough to see that
      const double lowest = 1e-5 * values.back(),
                   margin = std::pow(values.back() / std::max(values.front(), lowest), 0.06);
      axis.low = std::max(values.front() / margin, lowest), axis.high = values.back() * margin;
      return;
    }
  }
  const auto at = [&](double part) {
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
  };
  const double inner = std::max(at(0.98) - at(0.02), 1e-12);
  const double low = std::max(values.front(), at(0.02) - 0.5 * inner),
               high = std::min(values.back(), at(0.98) + 0.5 * inner);
  const double margin = std::max(0.06 * (high - low), 0.02 * std::max(std::abs(high), 1e-6));
  axis.low = low - margin, axis.high = high + margin;
}

}  // namespace

DiagramData diagram_data(const Run& run) {
  const Quantity x = horizontal_axis(run);
  const auto quantities =
      existing(run.info.has_cylinder ? capstan_quantities(run, x.axis.name == "T") : strut_quantities(), run);
  DiagramData data;
  data.x = x.axis;
  data.locus = run.info.command == "locus";
  data.title =
      run.info.scene + (data.locus ? ", locus of " + run.info.options->value("of", "a special point") : "");
  std::map<int, std::vector<BranchRow>> branches;
  for (const BranchRow& row : run.rows) branches[row.branch].push_back(row);
  std::vector<std::vector<double>> seen(quantities.size() + 1);
  std::map<std::string, std::vector<double>> labelled;
  for (auto& [branch, rows] : branches) {
    const std::vector<double> alpha = log_slopes(rows);
    const auto values_at = [&](std::size_t i, double slope) {
      std::vector<double> values = {x.value(rows[i], slope)};
      for (const Quantity& quantity : quantities) values.push_back(quantity.value(rows[i], slope));
      return values;
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::vector<double> values = values_at(i, alpha[i]);
      for (std::size_t k = 0; k < values.size(); ++k) seen[k].push_back(values[k]);
      if (!rows[i].label.empty()) labelled[rows[i].label] = values;
      if (i == 0 && rows.size() > 1) continue;
      const std::size_t before = i == 0 ? 0 : i - 1;
      const ArmState state = state_between(rows[before], rows[i]);
      // Beyond an event the contact is another, and so is alpha: it has no value there at the event itself.
      const bool changed = rows[before].topology != rows[i].topology;
      if (i <= 1 || data.pieces.back().state != state) data.pieces.push_back({branch, state, {}, {}});
      Piece& piece = data.pieces.back();
      if (piece.rows.empty() || changed) {
        if (changed) piece.breaks.insert(piece.rows.size());
        piece.rows.push_back(values_at(before, changed ? std::nan("") : alpha[before]));
      }
      piece.rows.push_back(values);
    }
  }
  choose_range(data.x, seen[0]);
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    data.panels.push_back(quantities[k].axis);
    choose_range(data.panels.back(), seen[k + 1]);
    // alpha goes to infinity where contact is lost; what it tells is its way from 1 upwards
    if (data.panels.back().name == "alpha") {
      data.panels.back().low = std::max(data.panels.back().low, -0.5);
      data.panels.back().high = std::clamp(data.panels.back().high, 1.5, 4.0);
    }
  }
  for (const SpecialPoint& point : run.special_points) {
    const auto found = labelled.find(point.label);
    if (found != labelled.end()) data.special.push_back({point.label, point.type, found->second});
  }
  return data;
}

}  // namespace windlass::output
