// Bad input is refused: by InputError, in one line that fits a screen.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "shapeid/models/error.hpp"

namespace shapeid::test {

/// What `read` says as it refuses its input; "accepted" if it does not.
template <typename Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    std::string message = error.what();
    constexpr std::size_t longest = 2000;  // bytes: a screen
    EXPECT_LE(message.size(), longest);
    EXPECT_TRUE(std::none_of(message.begin(), message.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20;
    })) << message;
    return message;
  }
  return "accepted";
}

/// Whether a text stands in another.
inline bool says(const std::string& message, const std::string& words) {
  return message.find(words) != std::string::npos;
}

inline std::string repeated(const std::string& text, std::size_t times) {
  std::string result;
  result.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) result += text;
  return result;
}

}  // namespace shapeid::test
