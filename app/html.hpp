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
  void subheading(const std::string& text);
  void paragraph(const std::string& text);
  /// First row: column heads. Columns but the first are set right-aligned, those with sentences
  /// left. A table that is wider than the page scrolls by itself.
  void table(const std::vector<std::vector<std::string>>& rows);
  /// An SVG element with a line under it, which is also what it is read out as. Its ids become
  /// those of this picture alone.
  void picture(const std::string& svg, const std::string& caption);

  [[nodiscard]] std::string html() const;

 private:
  std::string title_, body_;
  int pictures_ = 0;
};

}  // namespace shapeid::app
