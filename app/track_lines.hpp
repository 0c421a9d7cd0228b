// Lines of a file that grows, or of standard input, as soon as each has its end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace shapeid::app {

/// A line and where the next one starts.
struct Line {
  std::string text;             ///< without its end
  int number = 0;               ///< from 1
  std::uint64_t next_byte = 0;  ///< of the file or stream, from 0
};

struct FollowOptions {
  bool follow = false;    ///< at the end of a file wait for more; streams are waited for anyway
  double patience = 0.0;  ///< s without a new byte after which waiting ends; 0: never
};

/// Reads no further than it is asked, so that a slow reader of ours slows the writer down and
/// memory stays as it is. A line counts when its end is there: what a writer is in the middle of is
/// waited for, or left.
class LineFollower {
 public:
  /// `path` "-" reads standard input; it and a pipe are streams, which end when their writer has
  /// gone. Throws InputError if it cannot be opened, or is compressed.
  LineFollower(std::string path, const FollowOptions& options);
  ~LineFollower();
  LineFollower(const LineFollower&) = delete;
  LineFollower& operator=(const LineFollower&) = delete;

  /// The next line; empty when no more will come.
  [[nodiscard]] std::optional<Line> next();

  /// The next line is this one of the file, which was read before; its end is the next one's
  /// beginning. Throws InputError if the file is shorter.
  void skip_to(int number, std::uint64_t begin, std::uint64_t end);

  /// Bytes at the end that are no line yet.
  [[nodiscard]] std::size_t unfinished() const { return line_.size(); }
  [[nodiscard]] bool is_stream() const { return is_stream_; }

 private:
  [[nodiscard]] bool fill();
  [[nodiscard]] bool wait_for_more();
  [[nodiscard]] bool keeps_silent() const;
  void refuse_shrunk() const;
  void refuse_replaced() const;

  std::string path_;
  FollowOptions options_;
  int file_ = -1;
  bool is_stream_ = false;
  std::string block_;  ///< read, not yet handed on
  std::size_t in_block_ = 0;
  std::string line_;        ///< the beginning of the next line
  std::uint64_t byte_ = 0;  ///< where block_ ends in the stream
  int number_ = 0;
};

}  // namespace shapeid::app
