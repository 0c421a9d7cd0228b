#include "shapeid/app/run_command.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <system_error>

#include "shapeid/models/error.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid::app {
namespace {

constexpr int no = 1, bad_input = 2, our_defect = 3;

int complain(const std::string& message, int status) {
  constexpr std::size_t longest = 2000;  // bytes: a screen
  fmt::print(stderr, "shapeid: {}\n", one_line(message, longest));
  return status;
}

/// What is printed waits in a buffer: only now is it known whether it arrived.
int finish_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  return complain("standard output cannot be written; give it to a program or disk with room",
                  bad_input);
}

}  // namespace

int run_command(CLI::App& app, int argc, char** argv) {
  // A reader that has gone is an error of writing, said in a line, not a silent end.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    app.parse(argc, argv);
    return finish_output();
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) return complain(e.what(), bad_input);
    app.exit(e);  // --help, --version
    return finish_output();
  } catch (const InputError& e) {
    return complain(e.what(), bad_input);
  } catch (const Refusal& e) {
    return complain(e.what(), no);
  } catch (const std::exception& e) {
    // fmt says so by an exception of its own when it finds the buffer full.
    if (std::ferror(stdout) != 0) return finish_output();
    return complain(fmt::format("this is a defect of shapeid, please report it: {}", e.what()),
                    our_defect);
  }
}

}  // namespace shapeid::app
