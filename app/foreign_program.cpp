#include "shapeid/app/foreign_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>
#include <utility>

#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

// Half a second to end by itself.
constexpr int looks_at_its_end = 50;
constexpr std::chrono::milliseconds between_looks{10};

// Bytes: no answer to any vector has a thousandth of it.
constexpr std::size_t longest_answer = std::size_t{1} << 26U;

constexpr const char* what_is_right = "a program that answers each line with one line";

}  // namespace

ForeignProgram::ForeignProgram(const std::string& command) : command_(command) {
  std::array<int, 2> in{}, out{}, errors{};
  if (pipe(in.data()) != 0 || pipe(out.data()) != 0 || pipe(errors.data()) != 0) {
    throw InputError(command + ": no pipe to it can be opened", what_is_right);
  }
  std::signal(SIGPIPE, SIG_IGN);  // a program that has ended is an error of writing, said below
  child_ = fork();
  if (child_ == 0) {
    setpgid(0, 0);  // what it starts ends with it
    dup2(in[0], STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    dup2(errors[1], STDERR_FILENO);
    for (const int end : {in[0], in[1], out[0], out[1], errors[0], errors[1]}) close(end);
    std::signal(SIGPIPE, SIG_DFL);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  close(in[0]);
  close(out[1]);
  close(errors[1]);
  fcntl(errors[0], F_SETFL, O_NONBLOCK);
  fcntl(in[1], F_SETFL, O_NONBLOCK);  // a program that does not read is not waited for
  to_ = in[1];
  from_ = out[0];
  errors_ = errors[0];
  if (child_ < 0) throw InputError(command + ": cannot be started", what_is_right);
}

ForeignProgram::~ForeignProgram() {
  close(to_);  // the end of its input: it should end by itself
  close(from_);
  if (child_ > 0 && !ended_by_itself()) {
    kill(-child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  hear();
  pass_on();
  close(errors_);
}

/// Whether it ends within a while. What it says meanwhile must not stop it.
std::optional<int> ForeignProgram::ended_by_itself() {
  for (int look = 0; look < looks_at_its_end; ++look) {
    int status = 0;
    if (waitpid(child_, &status, WNOHANG) != 0) {
      child_ = -1;
      return status;
    }
    hear();
    std::this_thread::sleep_for(between_looks);
  }
  return std::nullopt;
}

/// What it says on its standard error goes to ours, but before its first answer it waits: that the
/// shell finds no such program is said in our own line.
void ForeignProgram::hear() {
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0;
       errors_ >= 0 && (count = read(errors_, buffer.data(), buffer.size())) >= 0;) {
    if (count == 0) {
      close(std::exchange(errors_, -1));
      break;
    }
    complaint_.append(buffer.data(), static_cast<std::size_t>(count));
    constexpr std::size_t most = 65536;  // bytes that wait
    if (answered_ || complaint_.size() > most) pass_on();
  }
}

void ForeignProgram::pass_on() {
  std::fwrite(complaint_.data(), 1, complaint_.size(), stderr);
  complaint_.clear();
}

void ForeignProgram::fail_ended(const char* how) {
  const std::optional<int> status = ended_by_itself();
  hear();
  // What the shell exits with where a command is not found, or cannot be executed.
  constexpr int not_executable = 126, not_found = 127;
  if (!answered_ && status && WIFEXITED(*status) &&
      (WEXITSTATUS(*status) == not_found || WEXITSTATUS(*status) == not_executable)) {
    complaint_.clear();
    throw InputError(
        command_ + (WEXITSTATUS(*status) == not_found ? ": the shell finds no such program"
                                                      : ": the shell cannot execute it"),
        what_is_right);
  }
  throw InputError(command_ + how, what_is_right);
}

/// As much of the question as it takes now.
void ForeignProgram::write_some(std::string_view& question) {
  const ssize_t count = write(to_, question.data(), question.size());
  if (count < 0 && errno == EAGAIN) return;
  if (count <= 0) fail_ended(": ended before it was asked");
  question.remove_prefix(static_cast<std::size_t>(count));
}

void ForeignProgram::read_some() {
  std::array<char, 65536> buffer{};
  const ssize_t count = read(from_, buffer.data(), buffer.size());
  if (count <= 0) fail_ended(": ended without an answer");
  unread_.append(buffer.data(), static_cast<std::size_t>(count));
  if (unread_.size() <= longest_answer) return;
  kill(-child_, SIGTERM);
  const bool has_line = unread_.find('\n') != std::string::npos;
  throw InputError(command_ + (has_line ? ": answers before it is asked, and does not read"
                                        : ": answers with an endless line"),
                   what_is_right);
}

std::string ForeignProgram::ask(const std::string& line, int patience) {
  const std::string whole = line + "\n";
  std::string_view question = whole;
  while (!question.empty() || unread_.find('\n') == std::string::npos) {
    std::array<pollfd, 3> ends = {pollfd{from_, POLLIN, 0},
                                  pollfd{question.empty() ? -1 : to_, POLLOUT, 0},
                                  pollfd{errors_, POLLIN, 0}};
    if (poll(ends.data(), ends.size(), patience) <= 0) {
      kill(-child_, SIGTERM);
      throw InputError(command_ + ": no answer in time", what_is_right);
    }
    if (ends[2].revents != 0) hear();
    if (ends[1].revents != 0) write_some(question);
    if (ends[0].revents != 0) read_some();
  }
  const std::size_t end = unread_.find('\n');
  std::string answer = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  answered_ = true;
  pass_on();
  return answer;
}

}  // namespace shapeid::app
