#include "shapeid/app/foreign_program.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

// Bytes: no answer to any vector has a thousandth of it.
constexpr std::size_t longest_answer = std::size_t{1} << 26U;

constexpr const char* what_is_right = "a program that answers each line with one line";

}  // namespace

ForeignProgram::ForeignProgram(const std::string& command) : command_(command) {
  std::array<int, 2> in{}, out{};
  if (pipe(in.data()) != 0 || pipe(out.data()) != 0) {
    throw InputError(command + ": no pipe to it can be opened", what_is_right);
  }
  std::signal(SIGPIPE, SIG_IGN);  // a program that has ended is an error of writing, said below
  child_ = fork();
  if (child_ == 0) {
    dup2(in[0], STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    for (const int end : {in[0], in[1], out[0], out[1]}) close(end);
    std::signal(SIGPIPE, SIG_DFL);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  close(in[0]);
  close(out[1]);
  to_ = in[1];
  from_ = out[0];
  if (child_ < 0) throw InputError(command + ": cannot be started", what_is_right);
}

ForeignProgram::~ForeignProgram() {
  close(to_);  // the end of its input: it should end by itself
  close(from_);
  if (child_ > 0) waitpid(child_, nullptr, 0);
}

void ForeignProgram::write_all(const std::string& text) const {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = write(to_, text.data() + done, text.size() - done);
    if (count <= 0) throw InputError(command_ + ": ended before it was asked", what_is_right);
    done += static_cast<std::size_t>(count);
  }
}

std::string ForeignProgram::ask(const std::string& line, int patience) {
  write_all(line + "\n");
  std::size_t end = unread_.find('\n');
  while (end == std::string::npos) {
    pollfd waiting{from_, POLLIN, 0};
    if (poll(&waiting, 1, patience) <= 0) {
      kill(child_, SIGTERM);
      throw InputError(command_ + ": no answer in time", what_is_right);
    }
    std::array<char, 65536> buffer{};
    const ssize_t count = read(from_, buffer.data(), buffer.size());
    if (count <= 0) throw InputError(command_ + ": ended without an answer", what_is_right);
    unread_.append(buffer.data(), static_cast<std::size_t>(count));
    if (unread_.size() > longest_answer) {
      kill(child_, SIGTERM);
      throw InputError(command_ + ": answers with an endless line", what_is_right);
    }
    end = unread_.find('\n');
  }
  std::string answer = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  return answer;
}

}  // namespace shapeid::app
