// What a reader says of a file in a scratch folder, without the folder, which is another each time.
#pragma once

#include <filesystem>
#include <string>

namespace shapeid::test {

/// What an InputError says after the folder of the scratch file has been taken away; "accepted" if
/// nothing is thrown.
template <typename Error, typename Call>
std::string message_of(const Call& call, const std::string& path) {
  try {
    call();
  } catch (const Error& error) {
    std::string text = error.what();
    const std::string folder = std::filesystem::path(path).parent_path().string() + "/";
    for (std::size_t at = 0; (at = text.find(folder)) != std::string::npos;) {
      text.erase(at, folder.size());
    }
    return text;
  }
  return "accepted";
}

}  // namespace shapeid::test
