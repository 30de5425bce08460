#include "continuation/checkpoint.hpp"

#include <concepts>
#include <stdexcept>

#include "archive.hpp"

namespace continuation {

namespace {

constexpr int format = 4;  // of the data; others are refused

}  // namespace

/// U, const when it is written.
template <class T, class U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

void fields(auto& a, Is<Tangent> auto& tangent) { a("x", tangent.x), a("p", tangent.p); }

void fields(auto& a, Is<SmallEigenvalues> auto& small) {
  a("values", small.values), a("vectors", small.vectors), a("basis", small.basis);
}

void fields(auto& a, Is<EventFunction> auto& event) {
  a("name", event.name), a("value", event.value), a("imminent", event.imminent), a("passes", event.passes);
}

void fields(auto& a, Is<End> auto& end) { a("kind", end.kind), a("reason", end.reason); }

void fields(auto& a, Is<BranchPoint> auto& point) {
  a("x", point.x), a("p", point.p), a("u", point.u), a("multiplicity", point.multiplicity);
  a("right", point.null.right), a("left", point.null.left);
  a("polished", point.polished), a("precision", point.precision), a("tangents", point.tangents);
}

void fields(auto& a, Is<Point> auto& point) {
  a("problem", point.problem), a("x", point.x), a("p", point.p), a("tangent", point.tangent);
  a("type", point.type), a("path_length", point.path_length), a("ds", point.ds);
  a("newton_iterations", point.newton_iterations), a("index", point.index);
  a("functions", point.functions), a("index_after", point.index_after), a("label", point.label),
      a("event", point.event);
  a("before", point.before), a("after", point.after), a("note", point.note);
  a("precision", point.precision), a("bracket_lo", point.bracket_lo), a("bracket_hi", point.bracket_hi);
  a("multiplicity", point.multiplicity), a("branch_point", point.branch_point);
  a("breaking", point.breaking);
  a("next_problem", point.next_problem), a("next_x", point.next_x), a("next_p", point.next_p);
}

void fields(auto& a, Is<Branch> auto& branch) {
  a("id", branch.id), a("depth", branch.depth), a("origin", branch.origin), a("count", branch.count);
  a("points", branch.points), a("end", branch.end);
}

void fields(auto& a, Is<SpecialPoint> auto& special) {
  a("point", special.point), a("branch", special.branch), a("fingerprint", special.fingerprint);
  a("arrivals", special.arrivals), a("arrival_points", special.arrival_points);
}

void fields(auto& a, Is<Diagram> auto& diagram) {
  a("branches", diagram.branches), a("specials", diagram.specials), a("lost", diagram.lost);
  a("inadmissible", diagram.inadmissible), a("notes", diagram.notes);
}

void fields(auto& a, Is<Arm> auto& arm) {
  a("problem", arm.problem), a("x", arm.x), a("p", arm.p), a("tangent", arm.tangent);
  a("epsilon", arm.epsilon), a("count", arm.count);
}

void fields(auto& a, Is<PendingBranch> auto& pending) {
  a("start", pending.start), a("special", pending.special), a("depth", pending.depth);
  a("back", pending.back);
}

void fields(auto& a, Is<WalkState> auto& walk) {
  a("problem", walk.problem), a("x", walk.x), a("p", walk.p), a("tangent", walk.tangent);
  a("previous_tangent", walk.previous_tangent), a("step", walk.step), a("usual_step", walk.usual_step);
  a("after_rejection", walk.after_rejection), a("index", walk.index), a("determinant", walk.determinant);
  a("complex_index", walk.complex_index), a("breaking_index", walk.breaking_index);
  a("small", walk.small);
  a("events", walk.events), a("previous_events", walk.previous_events), a("last_ds", walk.last_ds);
  a("signs", walk.signs), a("noted", walk.noted), a("noted_at", walk.noted_at);
  a("path_length", walk.path_length), a("points", walk.points);
  a("events_in_place", walk.events_in_place), a("started", walk.started);
  a("has_tangent", walk.has_tangent);
  a("mesh_changed", walk.mesh_changed), a("start_x", walk.start_x);
  a("start_fingerprint", walk.start_fingerprint), a("start_parameter", walk.start_parameter);
  a("start_slope", walk.start_slope), a("end", walk.end);
}

void fields(auto& a, Is<DiagramState> auto& state) {
  a("diagram", state.diagram), a("pending", state.pending), a("first_special", state.first_special);
  a("folds", state.folds), a("branch_points", state.branch_points), a("events", state.events);
  a("hopf_points", state.hopf_points);
}

nlohmann::json encode(const DiagramState& state, const ProblemCodec& codec) {
  Writer writer(codec);
  fields(writer, state);
  std::optional<WalkState> walk;
  if (state.walker) walk = state.walker->state();
  writer("walk", walk);
  writer("format", format);
  return writer.take();
}

DiagramState decode(const nlohmann::json& data, const Options& options, const ProblemCodec& codec) {
  const auto damaged = [](const std::exception& error) {
    return std::runtime_error(std::string("the checkpoint is damaged: ") + error.what());
  };
  try {
    if (data.at("format") != format) throw std::runtime_error("it has another format");
    Reader reader(data, codec);
    DiagramState state;
    fields(reader, state);
    std::optional<WalkState> walk;
    reader("walk", walk);
    if (walk) state.walker.emplace(std::move(*walk), options);
    const int specials = static_cast<int>(state.diagram.specials.size());
    for (const PendingBranch& pending : state.pending) {
      if (pending.special >= specials) throw std::runtime_error("an arm leaves a point that is not there");
    }
    if (walk && state.diagram.branches.empty()) throw std::runtime_error("the branch in progress is missing");
    return state;
  } catch (const nlohmann::json::exception& error) {  // an entry is missing or of another type
    throw damaged(error);
  } catch (const std::invalid_argument& error) {  // what the problem or the walker refuses
    throw damaged(error);
  } catch (const std::runtime_error& error) {
    throw damaged(error);
  }
}

}  // namespace continuation
