#include "windlass/output/json_object.hpp"

#include <nlohmann/json.hpp>

namespace windlass::output {

using nlohmann::ordered_json;

JsonObject::JsonObject() : JsonObject(ordered_json::object()) {}
JsonObject::JsonObject(ordered_json value) : value_(std::make_unique<ordered_json>(std::move(value))) {}
JsonObject::JsonObject(const JsonObject& other) : JsonObject(*other) {}
JsonObject::JsonObject(JsonObject&&) noexcept = default;
JsonObject& JsonObject::operator=(JsonObject other) noexcept {
  value_ = std::move(other.value_);
  return *this;
}
JsonObject::~JsonObject() = default;

}  // namespace windlass::output
