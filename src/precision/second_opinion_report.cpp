#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "windlass/output/branches_csv.hpp"
#include "windlass/precision/second_opinion.hpp"

namespace windlass::precision {

using output::format_number;

std::string to_csv(const SecondOpinion& opinion) {
  std::string out =
      "T,radius,R_tot,R_tot_discrete,R_tot_difference,self_force,self_force_discrete,self_force_difference,"
      "seconds,seconds_discrete,topology,\"h:unknowns:R_tot:self_force, a mesh each\"\n";
  for (const Opinion& o : opinion.states) {
    for (const double value :
         {o.tension, o.radius, o.chain.R_tot, o.discrete.R_tot, o.R_tot_difference, o.chain.self_force,
          o.discrete.self_force, o.self_force_difference, o.chain.seconds, o.discrete.seconds})
      out += format_number(value) + ",";
    out += o.topology + ",";
    for (const Opinion::Mesh& mesh : o.meshes)
      out += fmt::format("{}{}:{}:{}:{}", &mesh == o.meshes.data() ? "" : " ", format_number(mesh.h),
                         mesh.unknowns, format_number(mesh.R_tot), format_number(mesh.self_force));
    out += "\n";
  }
  return out;
}

namespace {

/// The worst of them, and which state it is.
std::string worst(const std::vector<Opinion>& states, double Opinion::*difference) {
  const auto at = std::max_element(states.begin(), states.end(), [&](const Opinion& a, const Opinion& b) {
    return std::abs(a.*difference) < std::abs(b.*difference);
  });
  return fmt::format("{:.1e} (T = {:.4g}, R/r = {:.4g})", std::abs((*at).*difference), at->tension,
                     1.0 / at->radius - 1.0);
}

}  // namespace

std::string to_text(const SecondOpinion& opinion) {
  std::string out =
      fmt::format("second opinion, phi = {:.6g}: discrete rod with contact along splines, ", opinion.angle);
  if (opinion.states.empty()) return out + "no state\n";
  std::string meshes;
  for (const auto& mesh : opinion.states.front().meshes) meshes += fmt::format(" {:.3g}", mesh.h);
  out += fmt::format("h ={}, extrapolated from the last three\n", meshes);
  out += fmt::format("{:>6} {:>6} {:>14} {:>14} {:>8} {:>12} {:>12} {:>8} {:>6} {:>6}\n", "R/r", "T", "R_tot",
                     "discrete", "differ", "self_force", "discrete", "differ", "s", "s");
  for (const Opinion& o : opinion.states)
    out +=
        fmt::format("{:6.4g} {:6.4g} {:14.9g} {:14.9g} {:8.1e} {:12.7g} {:12.7g} {:8.1e} {:6.2f} {:6.2f}\n",
                    1.0 / o.radius - 1.0, o.tension, o.chain.R_tot, o.discrete.R_tot, o.R_tot_difference,
                    o.chain.self_force, o.discrete.self_force, o.self_force_difference, o.chain.seconds,
                    o.discrete.seconds);
  const auto agreeing = std::count_if(opinion.states.begin(), opinion.states.end(),
                                      [](const Opinion& o) { return o.agrees(); });
  return out + fmt::format(
                   "{} of {} states agree to {:.0e} in R_tot and {:.0e} in the force between strands; "
                   "largest difference {} and {}\n",
                   agreeing, opinion.states.size(), agreed_R_tot, agreed_self_force,
                   worst(opinion.states, &Opinion::R_tot_difference),
                   worst(opinion.states, &Opinion::self_force_difference));
}

}  // namespace windlass::precision
