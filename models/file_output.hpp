// Files appear whole or not at all.
#pragma once

#include <string>
#include <vector>

namespace shapeid {

/// Where a file goes, and where it is written until it is whole. A symbolic link is followed: what
/// it points to is replaced, the link stays. What replaces a file takes over its permissions, not
/// its owner. A device or a pipe (/dev/null, /dev/stdout) cannot be replaced and is written to as
/// it stands.
class OutputPlace {
 public:
  /// Throws InputError for a folder.
  explicit OutputPlace(std::string path);

  /// The file to write to: beside the final one, unless that is no regular file.
  [[nodiscard]] const std::string& writable() const { return writable_; }
  /// Before it is opened: while it is written nobody else may read it than may read what it
  /// replaces.
  void keep_private() const;
  /// Before anything is written: throws InputError if nothing could be. Leaves nothing behind.
  void check_writable() const;
  /// The folder that the file is in at last.
  [[nodiscard]] std::string folder() const;
  /// What was written takes its place. Throws InputError if it cannot.
  void finish() const;
  /// Nothing was written.
  void discard() const noexcept;
  /// Discards and throws InputError.
  [[noreturn]] void fail(const std::string& wrong) const;

 private:
  std::string path_;  ///< as given, for complaints
  std::string final_, writable_;
};

/// Removes what is being written by this process, whole or not. Only calls that a signal's handler
/// may make.
void remove_unfinished_files() noexcept;

/// Writes `text` beside `path` and renames it into place, so that a half-written file never
/// replaces a good one. Throws InputError if the place cannot be written (missing folder, full
/// disk).
void write_file(const std::string& path, const std::string& text);

struct FileText {
  std::string path, text;
};

/// The same for files that belong together: none takes its place before all are written, and while
/// they do their folders are locked, so that of several processes that write the same set one comes
/// after the other and no set is mixed.
void write_files(const std::vector<FileText>& files);

}  // namespace shapeid
