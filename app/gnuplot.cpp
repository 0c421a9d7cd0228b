#include "shapeid/app/gnuplot.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "shapeid/app/svg.hpp"
#include "shapeid/models/contract.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

/// A text as a file without a place on a disk, which a child can read.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& text) : file_(::memfd_create("gnuplot", 0)) {
    std::size_t done = 0;
    while (file_ >= 0 && done < text.size()) {
      const ssize_t count = ::write(file_, text.data() + done, text.size() - done);
      if (count <= 0) break;
      done += static_cast<std::size_t>(count);
    }
    if (file_ < 0 || done < text.size()) {
      throw InputError("there is no memory for what gnuplot is to draw", "free some");
    }
  }
  ~MemoryFile() { ::close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] int descriptor() const { return file_; }

 private:
  int file_;
};

InputError missing() {
  return {"gnuplot is missing", "install Debian's gnuplot-nox, or leave --out away"};
}

}  // namespace

// Between single quotes nothing has a meaning but the quote, which is doubled.
std::string gnuplot_string(const std::string& text) {
  std::string quoted = "'";
  for (const char c : on_one_line(text))
    quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

// Entries have double quotes, which nothing escapes.
std::string gnuplot_entry(const std::string& text) {
  std::string entry = on_one_line(text);
  std::replace(entry.begin(), entry.end(), '"', '\'');
  return "\"" + entry + "\"";
}

void check_gnuplot() {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) throw missing();
}

std::string gnuplot(const std::string& script) {
  const MemoryFile file(script);
  std::string output;
  // A user's own settings would change the pictures, or ask for what is not installed.
  const std::string command =
      fmt::format("GNUTERM=svg gnuplot -d /dev/fd/{} 2>/dev/null", file.descriptor());
  int status = -1;
  if (std::FILE* pipe = ::popen(command.c_str(), "r")) {
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      output.append(buffer.data(), n);
    }
    status = ::pclose(pipe);
  }
  constexpr int not_found = 127;  // of the shell
  if (WIFEXITED(status) && WEXITSTATUS(status) == not_found) {
    throw missing();
  }
  if (status != 0) {
    throw InputError("gnuplot does not draw what it is given",
                     "install Debian's gnuplot-nox, or leave --out away");
  }
  // gnuplot's own declaration and document type have no place inside an HTML page.
  const auto start = output.find("<svg");
  return without_titles(start == std::string::npos ? output : output.substr(start));
}

}  // namespace shapeid::app
