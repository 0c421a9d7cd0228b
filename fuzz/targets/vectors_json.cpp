// A file of vectors in the first line, what a foreign program answered in the next ones.
#include <algorithm>
#include <cstdint>
#include <string>

#include "shapeid/app/vector_cases.hpp"
#include "shapeid/fuzz/support/check.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\n'), text.size());
  fuzz::taken([&] {
    const app::VectorFile file = app::vector_file_from_json(text.substr(0, end), "v.json");
    const nlohmann::json answer =
        app::parsed_answer(end < text.size() ? text.substr(end + 1) : std::string());
    for (const auto& vector : file.cases) static_cast<void>(app::differences(vector, answer));
  });
  return 0;
}
