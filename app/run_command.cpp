#include "shapeid/app/run_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fcntl.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/tell.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid::app {
namespace {

constexpr int no = 1, bad_input = 2, our_defect = 3;

constexpr std::size_t longest_line = 2000;  // bytes: a screen

int complain(const std::string& message, int status) {
  tell(fmt::format("shapeid: {}\n", one_line(message, longest_line)));
  return status;
}

/// What was noted first: the reason is the last line.
int refuse(const Refusal& refusal) {
  if (const auto* noted = dynamic_cast<const NotedRefusal*>(&refusal)) {
    for (const std::string& note : noted->notes()) {
      tell(fmt::format("note: {}\n", one_line(note, longest_line)));
    }
  }
  return complain(refusal.what(), no);
}

bool says_no_threads(const std::exception& e) {
  const auto* error = dynamic_cast<const std::system_error*>(&e);
  return error != nullptr && error->code() == std::errc::resource_unavailable_try_again;
}

/// What is printed waits in a buffer: only now is it known whether it arrived.
int finish_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  return complain("standard output cannot be written; give it to a program or disk with room",
                  bad_input);
}

/// Files that are not whole yet go, and the process ends as it would have.
void stop(int signal) {
  remove_unfinished_files();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// CLI11 would say that a verb is missing, not which word is none.
void check_verb(const CLI::App& app, int argc, char** argv) {
  const std::vector<const CLI::App*> verbs = app.get_subcommands({});
  if (argc < 2 || verbs.empty() || *argv[1] == '-') return;
  std::vector<std::string> names;
  names.reserve(verbs.size());
  for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return;
  throw InputError(fmt::format("there is no verb \"{}\"", argv[1]),
                   fmt::format("{}", fmt::join(names, ", ")));
}

/// CLI11 would say first what is missing, which may be what was misspelt.
void check_options(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || *argv[1] == '-') return;
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (verb->get_name() != argv[1]) continue;
    for (int i = 2; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--") return;
      const std::string name = word.substr(0, word.find('='));
      if (!name.starts_with("--") || verb->get_option_no_throw(name) != nullptr) continue;
      throw InputError(fmt::format("{} has no option {}", verb->get_name(), name),
                       fmt::format("see shapeid {} --help", verb->get_name()));
    }
  }
}

/// CLI11 says how many values came and how many are wanted, not which: the option's help does.
std::string with_what_is_right(const CLI::App& app, int argc, char** argv,
                               const CLI::ArgumentMismatch& mismatch) {
  std::string said = mismatch.what();
  std::vector<const CLI::App*> verbs = app.get_subcommands({});
  if (verbs.empty()) verbs.push_back(&app);  // a program that is one
  for (const CLI::App* verb : verbs) {
    if (verb != &app && (argc < 2 || verb->get_name() != argv[1])) continue;
    for (const CLI::Option* option : verb->get_options()) {
      const bool is_meant = said.starts_with(option->get_name() + ":");
      if (is_meant) return fmt::format("{}; {}", said, option->get_description());
    }
  }
  return said;
}

/// CLI11 takes -0.5 for a number and -.5 for an option.
std::vector<std::string> with_leading_digits(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  for (std::string& word : words) {
    const bool is_number =
        word.size() > 2 && word.starts_with("-.") && word[2] >= '0' && word[2] <= '9';
    if (is_number) word.insert(1, "0");
  }
  return words;
}

/// Files that are opened must not get the numbers of standard ones that the caller has closed.
/// Writing to a standard output that was closed stays an error.
void fill_closed_descriptors() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(number, F_GETFD) != -1) continue;
    // The lowest number that is free is this one.
    static_cast<void>(::open("/dev/null", number == STDERR_FILENO ? O_WRONLY : O_RDONLY));
  }
}

/// Sums of a tally come and go by the thousand. Memory that goes back to the system each time is
/// cleared, a page at a time, each time it comes again: a fifth of a trot's diagnosis.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int largest_in_a_heap = 32 << 20, never = 1 << 30;  // bytes; the first is glibc's limit
  mallopt(M_MMAP_THRESHOLD, largest_in_a_heap);
  mallopt(M_TRIM_THRESHOLD, never);
#endif
}

}  // namespace

int run_command(CLI::App& app, int argc, char** argv) {
  fill_closed_descriptors();
  keep_freed_memory();
  // A reader that has gone, or a file that may not grow, is an error of writing, said in a line,
  // not a silent end.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int end : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    // What was ignored stays so: under nohup a program outlives its terminal.
    if (std::signal(end, stop) == SIG_IGN) std::signal(end, SIG_IGN);
  }
  std::vector<CLI::App*> verbs = app.get_subcommands({});
  if (verbs.empty()) verbs.push_back(&app);  // a program that is one
  for (CLI::App* verb : verbs) {
    verb->parse_complete_callback([verb] { check_given(*verb); });
  }
  try {
    check_verb(app, argc, argv);
    check_options(app, argc, argv);
    const std::vector<std::string> words = with_leading_digits(argc, argv);
    std::vector<const char*> pointers;
    pointers.reserve(words.size());
    for (const std::string& word : words) pointers.push_back(word.c_str());
    app.parse(argc, pointers.data());
    return finish_output();
  } catch (const CLI::ArgumentMismatch& e) {
    return complain(with_what_is_right(app, argc, argv, e), bad_input);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) return complain(e.what(), bad_input);
    app.exit(e);  // --help, --version
    return finish_output();
  } catch (const InputError& e) {
    return complain(e.what(), bad_input);
  } catch (const Refusal& e) {
    return refuse(e);
  } catch (const std::bad_alloc&) {
    return complain("there is not enough memory for this; a shorter log, or more memory",
                    bad_input);
  } catch (const std::exception& e) {
    // fmt says so by an exception of its own when it finds the buffer full.
    if (std::ferror(stdout) != 0) return finish_output();
    if (says_no_threads(e)) {
      return complain("the system gives no more threads; --threads 1, or a higher limit",
                      bad_input);
    }
    return complain(fmt::format("this is a defect of shapeid, please report it: {}", e.what()),
                    our_defect);
  }
}

}  // namespace shapeid::app
