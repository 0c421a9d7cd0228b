#include "shapeid/app/gnuplot.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"

namespace shapeid::app {

std::string gnuplot(const std::string& script) {
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("shapeid-{}.gnuplot", ::getpid());
  write_file(file.string(), script);
  std::string output;
  const std::string command = fmt::format("gnuplot '{}' 2>/dev/null", file.string());
  int status = -1;
  if (std::FILE* pipe = ::popen(command.c_str(), "r")) {
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      output.append(buffer.data(), n);
    }
    status = ::pclose(pipe);
  }
  std::filesystem::remove(file);
  if (status != 0) {
    throw InputError("gnuplot did not draw",
                     "install Debian's gnuplot-nox, or leave out the report");
  }
  // gnuplot's own declaration and document type have no place inside an HTML page.
  const auto start = output.find("<svg");
  return start == std::string::npos ? output : output.substr(start);
}

}  // namespace shapeid::app
