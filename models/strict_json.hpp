// JSON read without charity: a key that is missing, unknown or there twice, and a number that is
// not finite, are bad input, said in one line.
#pragma once

#include <Eigen/Core>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "shapeid/models/error.hpp"

namespace shapeid {

/// Where members of one document are read from: its name and its manual stand in every message.
struct JsonSource {
  std::string name;    ///< of the file
  std::string manual;  ///< "docs/formats/problem.md"
};

/// Where a key's value stands: "p.json, key lambda". An empty key is the document itself.
[[nodiscard]] Place place_of_key(const JsonSource& source, const std::string& key);

/// What the text spells. Throws InputError for what is no JSON, for a key that is there twice, for
/// numbers beyond double and for values nested deeper than any format of ours.
[[nodiscard]] nlohmann::json parse_json(const std::string& text, const JsonSource& source);

/// The object that the text spells. `format` is the required value of its member "format"; `keys`
/// are all other members that may be there. Throws InputError.
[[nodiscard]] nlohmann::json parse_document(const std::string& text, const JsonSource& source,
                                            const std::string& format,
                                            const std::set<std::string>& keys);

/// Throws InputError if `object` is none, or has members besides `keys`.
void check_keys(const nlohmann::json& object, const std::string& key, const JsonSource& source,
                const std::set<std::string>& keys);

/// A member that must be there.
[[nodiscard]] const nlohmann::json& member(const nlohmann::json& object, const std::string& key,
                                           const JsonSource& source);

/// A finite number: decimal, or a text with a hexadecimal one such as "0x1.8p-3".
[[nodiscard]] double number(const nlohmann::json& value, const std::string& key,
                            const JsonSource& source);
/// A whole number from 0 to `most`.
[[nodiscard]] Eigen::Index count(const nlohmann::json& value, Eigen::Index most,
                                 const std::string& key, const JsonSource& source);
[[nodiscard]] std::string text(const nlohmann::json& value, const std::string& key,
                               const JsonSource& source);
[[nodiscard]] Eigen::VectorXd numbers(const nlohmann::json& value, const std::string& key,
                                      const JsonSource& source);
/// Rows of `columns` numbers each.
[[nodiscard]] Eigen::MatrixXd matrix(const nlohmann::json& value, Eigen::Index columns,
                                     const std::string& key, const JsonSource& source);

/// Numbers are written as the shortest decimals that read back to the same double.
[[nodiscard]] nlohmann::json vector_json(const Eigen::VectorXd& v);
/// Row by row, as a reader of the file would write the matrix down.
[[nodiscard]] nlohmann::json matrix_json(const Eigen::MatrixXd& M);

/// FNV-1a (64 bit, hexadecimal) of a text: names it, proves nothing.
[[nodiscard]] std::string digest(const std::string& text);

}  // namespace shapeid
