// JSON as far as the vectors use it, read into a tree and written by hand. Input is trusted: it
// comes from shapeid.
#pragma once

#include <Eigen/Core>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

namespace example {

struct Json {
  std::string text;  ///< of a string, a number, or true, false, null
  std::vector<Json> items;
  std::map<std::string, Json> members;

  [[nodiscard]] bool has(const std::string& name) const { return members.contains(name); }
  const Json& operator[](const std::string& name) const { return members.at(name); }

  [[nodiscard]] double number() const { return std::strtod(text.c_str(), nullptr); }
  [[nodiscard]] int integer() const { return std::atoi(text.c_str()); }

  [[nodiscard]] Eigen::VectorXd numbers() const {
    Eigen::VectorXd v(static_cast<Eigen::Index>(items.size()));
    for (std::size_t i = 0; i < items.size(); ++i) {
      v[static_cast<Eigen::Index>(i)] = items[i].number();
    }
    return v;
  }

  /// A list of rows.
  [[nodiscard]] Eigen::MatrixXd matrix() const {
    const auto rows = static_cast<Eigen::Index>(items.size());
    Eigen::MatrixXd M(rows, rows == 0 ? 0 : items[0].numbers().size());
    for (Eigen::Index i = 0; i < rows; ++i) {
      M.row(i) = items[static_cast<std::size_t>(i)].numbers();
    }
    return M;
  }
};

/// Reads one value from `at`, which is left behind it.
inline Json read_json(const char*& at) {
  const auto space = [&] {
    while (*at == ' ' || *at == '\n' || *at == ',' || *at == ':') ++at;
  };
  const auto string = [&] {  // names and kinds: no escapes
    const char* first = ++at;
    while (*at != '"') ++at;
    return std::string(first, at++);
  };
  Json value;
  space();
  if (*at == '{') {
    for (++at, space(); *at != '}'; space()) {
      const std::string name = string();
      value.members[name] = read_json(at);
    }
    ++at;
  } else if (*at == '[') {
    for (++at, space(); *at != ']'; space()) value.items.push_back(read_json(at));
    ++at;
  } else if (*at == '"') {
    value.text = string();
  } else {
    const char* first = at;
    while (*at != '\0' && *at != ',' && *at != ']' && *at != '}') ++at;
    value.text.assign(first, at);
  }
  return value;
}

/// Decimals that read back to the same doubles.
inline std::string list_text(const Eigen::VectorXd& v) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%.17g", v[i]);
    if (i > 0) text += ',';
    text += number;
  }
  return text + "]";
}

inline std::string member_text(const std::string& name, const Eigen::VectorXd& v) {
  return '"' + name + "\":" + list_text(v);
}
inline std::string member_text(const std::string& name, const std::vector<double>& list) {
  const auto size = static_cast<Eigen::Index>(list.size());
  return member_text(name, Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(list.data(), size)));
}

/// Row by row.
inline Eigen::VectorXd by_rows(const Eigen::MatrixXd& M) { return M.reshaped<Eigen::RowMajor>(); }

}  // namespace example
