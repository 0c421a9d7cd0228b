// State of objects to JSON and back. A class lists its members once, in state(archive), and the
// same list saves and restores: the two cannot get out of step.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>

#include <cmath>
#include <concepts>
#include <deque>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "shapeid/models/error.hpp"

namespace shapeid::app {

/// Writes members under their names into one JSON object. Doubles keep every bit: JSON has no NaN
/// and no infinity, so these are texts.
class StateWriter {
 public:
  template <class T>
  void operator()(const char* name, T& value) {
    object_[name] = encode(value);
  }
  [[nodiscard]] nlohmann::json take() { return std::move(object_); }

  template <class T>
  [[nodiscard]] static nlohmann::json encode(T& value) {
    StateWriter inner;
    value.state(inner);
    return inner.take();
  }
  [[nodiscard]] static nlohmann::json encode(double& value) {
    if (std::isfinite(value)) return value;
    if (std::isnan(value)) return "nan";
    return value > 0.0 ? "inf" : "-inf";
  }
  template <std::integral T>
  [[nodiscard]] static nlohmann::json encode(T& value) {
    return value;
  }
  [[nodiscard]] static nlohmann::json encode(std::string& value) { return value; }
  template <class T>
  [[nodiscard]] static nlohmann::json encode(std::optional<T>& value) {
    return value ? encode(*value) : nlohmann::json();
  }
  template <class T>
  [[nodiscard]] static nlohmann::json encode(std::vector<T>& values) {
    return list(values);
  }
  template <class T>
  [[nodiscard]] static nlohmann::json encode(std::deque<T>& values) {
    return list(values);
  }
  template <int rows, int columns>
  [[nodiscard]] static nlohmann::json encode(Eigen::Matrix<double, rows, columns>& matrix) {
    std::vector<double> numbers(matrix.data(), matrix.data() + matrix.size());
    return {{"rows", matrix.rows()}, {"columns", matrix.cols()}, {"values", list(numbers)}};
  }

 private:
  template <class List>
  [[nodiscard]] static nlohmann::json list(List& values) {
    nlohmann::json array = nlohmann::json::array();
    for (auto&& element : values) {
      typename List::value_type value =
          element;  // a copy: vector<bool> has no elements to refer to
      array.push_back(encode(value));
    }
    return array;
  }

  nlohmann::json object_ = nlohmann::json::object();
};

/// Reads what StateWriter wrote into an object that was made in the same way. Throws
/// nlohmann::json::exception or InputError for anything else.
class StateReader {
 public:
  explicit StateReader(const nlohmann::json& object) : object_(object) {}

  template <class T>
  void operator()(const char* name, T& value) {
    decode(object_.at(name), value);
  }

  /// A whole number that the type holds: the library would cut any other down to one.
  template <std::integral T>
  [[nodiscard]] static T whole(const nlohmann::json& json) {
    if (json.is_number_unsigned()) {
      const auto number = json.get<std::uint64_t>();
      if (std::in_range<T>(number)) return static_cast<T>(number);
    } else if (json.is_number_integer()) {
      const auto number = json.get<std::int64_t>();
      if (std::in_range<T>(number)) return static_cast<T>(number);
    }
    refuse("has a number that is not whole, or too large");
  }

  template <class T>
  static void decode(const nlohmann::json& json, T& value) {
    StateReader inner(json);
    value.state(inner);
  }
  static void decode(const nlohmann::json& json, double& value) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!json.is_string()) {
      json.get_to(value);
    } else if (json == "nan") {
      value = std::numeric_limits<double>::quiet_NaN();
    } else {
      value = json == "inf" ? infinity : -infinity;
    }
  }
  template <std::integral T>
  static void decode(const nlohmann::json& json, T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      json.get_to(value);
    } else {
      value = whole<T>(json);
    }
  }
  static void decode(const nlohmann::json& json, std::string& value) { json.get_to(value); }
  template <class T>
  static void decode(const nlohmann::json& json, std::optional<T>& value) {
    if (json.is_null()) {
      value.reset();
      return;
    }
    if constexpr (std::is_default_constructible_v<T>) {
      if (!value) value.emplace();
    }
    if (!value) refuse("has a part that these options do not make");
    decode(json, *value);
  }
  template <class T>
  static void decode(const nlohmann::json& json, std::vector<T>& values) {
    if constexpr (std::is_default_constructible_v<T>) {
      values.clear();
      for (const nlohmann::json& element : json) {
        T value{};
        decode(element, value);
        values.push_back(std::move(value));
      }
    } else {  // made by the constructor: as many as there are
      if (json.size() != values.size()) refuse("has a list of another size");
      for (std::size_t i = 0; i < values.size(); ++i) decode(json.at(i), values[i]);
    }
  }
  template <class T>
  static void decode(const nlohmann::json& json, std::deque<T>& values) {
    values.clear();
    for (const nlohmann::json& element : json) {
      T value{};
      decode(element, value);
      values.push_back(std::move(value));
    }
  }
  template <int rows, int columns>
  static void decode(const nlohmann::json& json, Eigen::Matrix<double, rows, columns>& matrix) {
    std::vector<double> numbers;
    decode(json.at("values"), numbers);
    const auto height = whole<std::size_t>(json.at("rows"));
    const auto width = whole<std::size_t>(json.at("columns"));
    const bool complete = width == 0
                              ? numbers.empty()
                              : numbers.size() % width == 0 && height == numbers.size() / width;
    // A size that the type or the constructor gave stays: what was made with it relies on it.
    const bool fits_type = (rows == Eigen::Dynamic || std::cmp_equal(height, rows)) &&
                           (columns == Eigen::Dynamic || std::cmp_equal(width, columns));
    const bool as_made = matrix.size() == 0 || (std::cmp_equal(height, matrix.rows()) &&
                                                std::cmp_equal(width, matrix.cols()));
    if (!complete || !fits_type || !as_made) refuse("has a matrix of another size");
    matrix.resize(static_cast<Eigen::Index>(height), static_cast<Eigen::Index>(width));
    std::copy(numbers.begin(), numbers.end(), matrix.data());
  }

 private:
  [[noreturn]] static void refuse(const char* wrong) {
    throw InputError(fmt::format("the state of the checkpoint {}", wrong),
                     "resume with the options that it was written with");
  }

  const nlohmann::json& object_;
};

}  // namespace shapeid::app
