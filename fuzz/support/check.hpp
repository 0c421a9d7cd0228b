// What every target expects: right answers, or bad input said in one line.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>

#include "shapeid/models/error.hpp"

namespace shapeid::fuzz {

/// Ends the program, which is how a target says that it found something.
inline void check(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

/// A message that a terminal shows as one line, and that says what would be right.
inline void check_message(const std::string& message) {
  constexpr std::size_t longest = 2000;  // bytes: a screen
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  check(std::none_of(message.begin(), message.end(), is_control), "a message is one line of text");
  check(message.size() <= longest, "a message fits on a screen");
  check(message.find("; ") != std::string::npos, "a message says what would be right");
}

/// Calls `read`, which may refuse its input by InputError and in no other way. True if it took it.
template <typename Read>
bool taken(const Read& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    check_message(error.what());
    return false;
  }
}

/// What `read` returns, or nothing where it refused. What is done with it stands outside, so that a
/// refusal of what we wrote ourselves ends the program.
template <typename Read>
auto accepted(const Read& read) {
  std::optional<std::invoke_result_t<Read>> result;
  taken([&] { result.emplace(read()); });
  return result;
}

}  // namespace shapeid::fuzz
