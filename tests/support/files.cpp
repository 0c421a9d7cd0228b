#include "shapeid/tests/support/files.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace shapeid::test {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path.string() + ": cannot be opened");
  return {std::istreambuf_iterator<char>(in), {}};
}

std::filesystem::path data_folder() {
  // No test changes this variable, so that no other thread can be changing it here.
  const char* const named = std::getenv("SHAPEID_DATA");  // NOLINT(concurrency-mt-unsafe)
  if (named != nullptr) return named;
  return std::filesystem::path(SHAPEID_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace shapeid::test
