#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "continuation/checkpoint.hpp"

namespace continuation {

/// `fields(archive, value)`, one overload a type, names what is stored of it; Writer and Reader both run it, so
/// that writing and reading cannot get out of step.
class Writer {
 public:
  explicit Writer(const ProblemCodec& codec) : codec_(codec) {}

  template <class T>
  void operator()(const char* key, const T& value) {
    node_[key] = put(value);
  }
  nlohmann::json take() { return std::move(node_); }

  nlohmann::json put(const Vector& v) const { return std::vector<double>(v.data(), v.data() + v.size()); }
  nlohmann::json put(const Matrix& m) const {
    return {{"rows", m.rows()}, {"values", std::vector<double>(m.data(), m.data() + m.size())}};
  }
  nlohmann::json put(const std::shared_ptr<Problem>& problem) const {
    return problem ? codec_.encode(*problem) : nlohmann::json();
  }
  template <class T>
  nlohmann::json put(const std::shared_ptr<const T>& value) const {
    return value ? put(*value) : nlohmann::json();
  }
  template <class T>
  nlohmann::json put(const std::optional<T>& value) const {
    return value ? put(*value) : nlohmann::json();
  }
  template <class T>
  nlohmann::json put(const std::vector<T>& values) const {
    return put_all(values);
  }
  template <class T>
  nlohmann::json put(const std::deque<T>& values) const {
    return put_all(values);
  }
  template <class T>
  nlohmann::json put(const T& value) const {
    if constexpr (std::is_enum_v<T>) {
      return static_cast<int>(value);
    } else if constexpr (std::is_arithmetic_v<T> || std::is_convertible_v<T, std::string> ||
                         std::is_same_v<T, std::map<std::string, int>>) {
      return value;
    } else {
      Writer part(codec_);
      fields(part, value);
      return part.take();
    }
  }

 private:
  template <class Values>
  nlohmann::json put_all(const Values& values) const {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& value : values) list.push_back(put(value));
    return list;
  }

  const ProblemCodec& codec_;
  nlohmann::json node_ = nlohmann::json::object();
};

class Reader {
 public:
  Reader(const nlohmann::json& node, const ProblemCodec& codec) : node_(node), codec_(codec) {}

  template <class T>
  void operator()(const char* key, T& value) {
    get(node_.at(key), value);
  }

  void get(const nlohmann::json& json, Vector& v) const {
    const auto values = json.get<std::vector<double>>();
    v = Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
  }
  void get(const nlohmann::json& json, Matrix& m) const {
    const auto values = json.at("values").get<std::vector<double>>();
    const auto rows = json.at("rows").get<Eigen::Index>(), count = static_cast<Eigen::Index>(values.size());
    if (rows < 0 || (rows > 0 && count % rows != 0)) throw std::runtime_error("a matrix has a wrong size");
    m = Eigen::Map<const Matrix>(values.data(), rows, rows > 0 ? count / rows : 0);
  }
  void get(const nlohmann::json& json, std::shared_ptr<Problem>& problem) const {
    problem = json.is_null() ? nullptr : codec_.decode(json);
  }
  template <class T>
  void get(const nlohmann::json& json, std::shared_ptr<const T>& value) const {
    value = json.is_null() ? nullptr : std::make_shared<const T>(made<T>(json));
  }
  template <class T>
  void get(const nlohmann::json& json, std::optional<T>& value) const {
    value = json.is_null() ? std::nullopt : std::optional<T>(made<T>(json));
  }
  template <class T>
  void get(const nlohmann::json& json, std::vector<T>& values) const {
    get_all(json, values);
  }
  template <class T>
  void get(const nlohmann::json& json, std::deque<T>& values) const {
    get_all(json, values);
  }
  template <class T>
  void get(const nlohmann::json& json, T& value) const {
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(json.get<int>());
    } else if constexpr (std::is_arithmetic_v<T> || std::is_convertible_v<T, std::string> ||
                         std::is_same_v<T, std::map<std::string, int>>) {
      json.get_to(value);
    } else {
      Reader part(json, codec_);
      fields(part, value);
    }
  }

 private:
  template <class T>
  T made(const nlohmann::json& json) const {
    T value{};
    get(json, value);
    return value;
  }
  template <class Values>
  void get_all(const nlohmann::json& json, Values& values) const {
    values.clear();
    for (const auto& entry : json) values.push_back(made<typename Values::value_type>(entry));
  }

  const nlohmann::json& node_;
  const ProblemCodec& codec_;
};

}  // namespace continuation
