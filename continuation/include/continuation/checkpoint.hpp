#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "continuation/diagram.hpp"

namespace continuation {

/// How a problem becomes data and comes back. A decoded problem must behave like the encoded one to the last
/// bit, memory of earlier calls included; only then does a resumed diagram equal one never left.
struct ProblemCodec {
  std::function<nlohmann::json(const Problem&)> encode;
  /// @throws nlohmann::json::exception, std::invalid_argument, std::runtime_error where the data are no
  ///   problem
  std::function<std::shared_ptr<Problem>(const nlohmann::json&)> decode;
};

/// A diagram between two steps as a JSON value. Numbers are kept exactly in a binary form (CBOR, MessagePack);
/// as text, infinity and NaN would be lost.
nlohmann::json encode(const DiagramState& state, const ProblemCodec& codec);

/// The inverse. The options of the walk are not part of the data: those of the first run must be given.
/// @throws std::runtime_error for damaged data
DiagramState decode(const nlohmann::json& data, const Options& options, const ProblemCodec& codec);

}  // namespace continuation
