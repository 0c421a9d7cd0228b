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

/// `name` stands for the file in messages. Throws InputError for anything but a list of cases that
/// differences() can judge.
[[nodiscard]] VectorFile vector_file_from_json(const std::string& text, const std::string& name);

/// Reads index.json and the files it names. Throws InputError: missing, malformed, or another text
/// than the tool wrote.
[[nodiscard]] Vectors read_vectors(const std::string& folder);

/// What a foreign program printed, as JSON; null where it is none that can be judged.
[[nodiscard]] nlohmann::json parsed_answer(const std::string& line);

/// What is wrong with an output, one sentence each: observed, expected. Empty: passed. `vector` is
/// a case of a VectorFile.
[[nodiscard]] std::vector<std::string> differences(const nlohmann::json& vector,
                                                   const nlohmann::json& output);

}  // namespace shapeid::app
