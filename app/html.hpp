// The little HTML that a report needs: one self-contained page, nothing loaded from elsewhere.
#pragma once

#include <string>
#include <vector>

namespace shapeid::app {

/// Text with &, <, > and quotes made harmless.
[[nodiscard]] std::string escaped(const std::string& text);

/// A page built from top to bottom.
class Page {
 public:
  explicit Page(std::string title);

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// First row: column heads. Cells of the other rows but the first are set right-aligned.
  void table(const std::vector<std::vector<std::string>>& rows);
  /// An SVG element with a line under it.
  void picture(const std::string& svg, const std::string& caption);

  [[nodiscard]] std::string html() const;

 private:
  std::string title_, body_;
};

}  // namespace shapeid::app
