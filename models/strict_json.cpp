#include "shapeid/models/strict_json.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const JsonSource& source, const std::string& key, const std::string& wrong,
                         const std::string& right) {
  throw InputError(place_of_key(source, key), wrong, right);
}

/// What the parser would take: it keeps the last of two equal keys, and nests as deep as the file
/// does. Here both keys are refused, and so is what no format of ours nests. (Comparing and writing
/// a document recurse: a million brackets would end the program there.)
class Strictness {
 public:
  explicit Strictness(const JsonSource& source) : source_(&source) {}

  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    constexpr int deepest = 64;
    // The outermost bracket opens at depth 0.
    const bool opens =
        event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && depth >= deepest) {
      throw InputError({source_->name}, fmt::format("nested deeper than {}", deepest),
                       "see " + source_->manual);
    }
    if (event == json::parse_event_t::object_start) open_.emplace_back();
    if (event == json::parse_event_t::object_end) open_.pop_back();
    if (event == json::parse_event_t::key && !open_.back().insert(parsed).second) {
      refuse(*source_, parsed.get<std::string>(), "the key is there twice", "once");
    }
    return true;
  }

 private:
  const JsonSource* source_;
  std::vector<std::set<std::string>> open_;
};

std::optional<double> hexadecimal(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  if (!text.starts_with("0x")) return std::nullopt;
  text.remove_prefix(2);
  if (text.starts_with('-')) return std::nullopt;  // which from_chars would read
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::hex);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return negative ? -value : value;
}

std::optional<double> finite_number(const json& value) {
  std::optional<double> read;
  if (value.is_string()) read = hexadecimal(value.get<std::string>());
  if (value.is_number()) read = value.get<double>();
  return read && std::isfinite(*read) ? read : std::nullopt;
}

/// A number of a list; `name` says which, where it is none.
template <class Name>
double entry(const json& value, Name name, const std::string& key, const JsonSource& source) {
  const auto read = finite_number(value);
  if (!read) refuse(source, key, name() + " is not a finite number", "write finite decimals");
  return *read;
}

}  // namespace

Place place_of_key(const JsonSource& source, const std::string& key) {
  return {key.empty() ? source.name : fmt::format("{}, key {}", source.name, key)};
}

json parse_json(const std::string& text, const JsonSource& source) {
  try {
    return json::parse(text, Strictness(source));
  } catch (const json::parse_error& e) {
    throw InputError({source.name}, fmt::format("is not JSON (at byte {})", e.byte),
                     "see " + source.manual);
  } catch (const json::out_of_range&) {
    throw InputError({source.name}, "a number is larger than any double", "write finite decimals");
  }
}

json parse_document(const std::string& text, const JsonSource& source, const std::string& format,
                    const std::set<std::string>& keys) {
  json document = parse_json(text, source);
  if (!document.contains("format") || document["format"] != format) {
    throw InputError({source.name}, "has no or another format",
                     fmt::format("\"format\" must be \"{}\"", format));
  }
  std::set<std::string> all = keys;
  all.insert("format");
  check_keys(document, "", source, all);
  return document;
}

void check_keys(const json& object, const std::string& key, const JsonSource& source,
                const std::set<std::string>& keys) {
  if (!object.is_object()) refuse(source, key, "not an object", "see " + source.manual);
  for (const auto& item : object.items()) {
    if (!keys.contains(item.key())) {
      refuse(source, item.key(), "unknown key", "see " + source.manual);
    }
  }
}

const json& member(const json& object, const std::string& key, const JsonSource& source) {
  if (!object.contains(key)) refuse(source, key, "missing key", "it is required");
  return object[key];
}

double number(const json& value, const std::string& key, const JsonSource& source) {
  const auto read = finite_number(value);
  if (!read) refuse(source, key, "not a finite number", "write finite decimals");
  return *read;
}

Eigen::Index count(const json& value, Eigen::Index most, const std::string& key,
                   const JsonSource& source) {
  const double read = number(value, key, source);
  if (!(read >= 0.0 && read <= static_cast<double>(most) && read == std::floor(read))) {
    refuse(source, key, "not a count", fmt::format("a whole number from 0 to {}", most));
  }
  return static_cast<Eigen::Index>(read);
}

std::string text(const json& value, const std::string& key, const JsonSource& source) {
  if (!value.is_string()) refuse(source, key, "not a text", "a text");
  return value.get<std::string>();
}

Eigen::VectorXd numbers(const json& value, const std::string& key, const JsonSource& source) {
  if (!value.is_array()) refuse(source, key, "not a list", "a list of numbers");
  Eigen::VectorXd v(static_cast<Eigen::Index>(value.size()));
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    v[i] = entry(
        value[static_cast<std::size_t>(i)], [&] { return fmt::format("entry {}", i); }, key,
        source);
  }
  return v;
}

Eigen::MatrixXd matrix(const json& value, Eigen::Index columns, const std::string& key,
                       const JsonSource& source) {
  if (!value.is_array()) refuse(source, key, "not a list", "a list of rows");
  // All sizes before any memory: ten thousand empty rows of a stated width would ask for all of it.
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].is_array()) {
      refuse(source, key, fmt::format("row {} is not a list", i), "a list of numbers");
    }
    if (std::cmp_not_equal(value[i].size(), columns)) {
      refuse(source, key, fmt::format("row {} has {} numbers", i, value[i].size()),
             fmt::format("every row has {}", columns));
    }
  }
  Eigen::MatrixXd M(static_cast<Eigen::Index>(value.size()), columns);
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    const json& row = value[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < columns; ++k) {
      M(i, k) = entry(
          row[static_cast<std::size_t>(k)], [&] { return fmt::format("entry {} of row {}", k, i); },
          key, source);
    }
  }
  return M;
}

json vector_json(const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); }

json matrix_json(const Eigen::MatrixXd& M) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    // By entries: Eigen's row(i) counts from the data's address, and without columns there is none.
    json row = json::array();
    for (Eigen::Index k = 0; k < M.cols(); ++k) row.push_back(M(i, k));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string digest(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

}  // namespace shapeid
