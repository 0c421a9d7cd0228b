// Logs, CSV and gzipped: rows of as many finite numbers as there are columns.
#include <cmath>
#include <cstdint>
#include <set>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/models/log.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  fuzz::taken([&] {
    LogReader log(file.path());
    const std::set<std::string> names(log.columns().begin(), log.columns().end());
    fuzz::check(names.size() == log.columns().size() && !names.contains(""),
                "columns have names of their own");
    int line = 1;
    while (const auto row = log.next()) {
      fuzz::check(row->line > line, "lines are counted");
      line = row->line;
      fuzz::check(row->values.size() == log.columns().size(), "a number for each column");
      for (const double value : row->values) {
        fuzz::check(!std::isinf(value), "numbers are finite, or missing");
      }
    }
  });
  return 0;
}
