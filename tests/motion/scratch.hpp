// Files that a test writes, and that vanish with it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace shapeid::test {

/// A folder of its own for one test, removed at its end.
class Scratch {
 public:
  Scratch() {
    std::string name = std::filesystem::temp_directory_path() / "shapeid-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder");
    folder_ = name;
  }
  ~Scratch() { std::filesystem::remove_all(folder_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  /// Writes `text` as it is and returns the path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

/// What an InputError says after the folder of the scratch file has been taken away; "accepted" if
/// nothing is thrown.
template <typename Error, typename Call>
std::string message_of(const Call& call, const std::string& path) {
  try {
    call();
  } catch (const Error& error) {
    std::string text = error.what();
    const std::string folder = std::filesystem::path(path).parent_path().string() + "/";
    const std::size_t at = text.find(folder);
    return at == std::string::npos ? text : text.erase(at, folder.size());
  }
  return "accepted";
}

}  // namespace shapeid::test
