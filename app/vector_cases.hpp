// The vectors of tests/vectors, and what counts as a pass. Format: docs/formats/vectors.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace shapeid::app {

struct VectorFile {
  std::string kind;
  nlohmann::json cases;
};

struct Vectors {
  nlohmann::json flags;  ///< name: meaning
  std::vector<VectorFile> files;
};

/// Reads index.json and the files it names. Throws InputError: missing, malformed, or another text
/// than the tool wrote.
[[nodiscard]] Vectors read_vectors(const std::string& folder);

/// What is wrong with an output, one sentence each: observed, expected. Empty: passed.
[[nodiscard]] std::vector<std::string> differences(const nlohmann::json& vector,
                                                   const nlohmann::json& output);

}  // namespace shapeid::app
