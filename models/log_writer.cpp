#include "shapeid/models/log_writer.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "shapeid/models/contract.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"

namespace shapeid {
namespace {

void check_names(const std::vector<std::string>& columns, const std::string& path) {
  std::set<std::string> seen;
  for (const std::string& name : columns) {
    if (name.empty() || !seen.insert(name).second ||
        name.find_first_of(",\"\r\n") != std::string::npos) {
      throw InputError({path, 0, name}, "cannot be a column",
                       "give every column its own name without commas and quotes");
    }
  }
  if (columns.empty()) throw InputError({path}, "would have no columns", "name some");
}

}  // namespace

struct LogWriter::State {
  State(const std::string& p, std::vector<std::string> names)
      : place(p), columns(std::move(names)) {
    check_names(columns, p);
    place.keep_private();
    const bool zipped = p.ends_with(".gz");
    file = gzopen(place.writable().c_str(), zipped ? "wb" : "wbT");  // T: transparent, no gzip
    if (file == nullptr) fail("cannot be written");
    put(fmt::format("{}\n", fmt::join(columns, ",")));
  }
  ~State() { discard(); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void put(const std::string& text) {
    if (gzwrite(file, text.data(), static_cast<unsigned>(text.size())) == 0) {
      fail("cannot be written");
    }
  }

  void discard() {
    if (file == nullptr) return;
    gzclose_w(std::exchange(file, nullptr));
    place.discard();
  }

  [[noreturn]] void fail(const std::string& wrong) {
    discard();
    place.fail(wrong);
  }

  OutputPlace place;
  std::vector<std::string> columns;
  gzFile file = nullptr;
};

LogWriter::LogWriter(const std::string& path, std::vector<std::string> columns)
    : state_(std::make_unique<State>(path, std::move(columns))) {}
LogWriter::~LogWriter() = default;
LogWriter::LogWriter(LogWriter&&) noexcept = default;
LogWriter& LogWriter::operator=(LogWriter&&) noexcept = default;

void LogWriter::write(const std::vector<double>& values) {
  if (values.size() != state_->columns.size()) {
    throw Defect(fmt::format("{} values for {} columns", values.size(), state_->columns.size()));
  }
  std::string line;
  for (const double value : values) {
    if (std::isinf(value)) throw Defect("an infinity in a log");
    if (!std::isnan(value)) {
      std::array<char, 32> digits;  // the longest shortest double has 24 characters
      auto* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
      line.append(digits.data(), end);
    }
    line.push_back(',');
  }
  line.back() = '\n';
  state_->put(line);
}

void LogWriter::close() {
  if (gzclose_w(std::exchange(state_->file, nullptr)) != Z_OK) {
    state_->place.fail("cannot be written");
  }
  state_->place.finish();
}

}  // namespace shapeid
