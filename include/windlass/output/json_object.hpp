#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace windlass::output {

/// A JSON object as a member of a value type. The full header of nlohmann::json costs every file that includes it
/// seconds to compile; this one declares it only, and whoever looks inside includes the full one.
class JsonObject {
 public:
  JsonObject();  ///< {}
  JsonObject(nlohmann::ordered_json value);
  JsonObject(const JsonObject& other);
  JsonObject(JsonObject&&) noexcept;
  JsonObject& operator=(JsonObject other) noexcept;
  ~JsonObject();

  nlohmann::ordered_json& operator*() { return *value_; }
  const nlohmann::ordered_json& operator*() const { return *value_; }
  nlohmann::ordered_json* operator->() { return value_.get(); }
  const nlohmann::ordered_json* operator->() const { return value_.get(); }

 private:
  std::unique_ptr<nlohmann::ordered_json> value_;
};

}  // namespace windlass::output
