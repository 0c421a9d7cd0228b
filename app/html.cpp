#include "shapeid/app/html.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "shapeid/app/svg.hpp"

namespace shapeid::app {

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

namespace {

/// Names of effects and places are long, and best broken between the two.
std::string with_breaks(const std::string& text) {
  std::string html;
  for (const char c : escaped(text)) {
    html += c;
    if (c == '@') html += "<wbr>";
  }
  return html;
}

}  // namespace

Page::Page(std::string title) : title_(std::move(title)) {}

void Page::heading(const std::string& text) { body_ += "<h2>" + escaped(text) + "</h2>\n"; }

void Page::subheading(const std::string& text) { body_ += "<h3>" + escaped(text) + "</h3>\n"; }

void Page::paragraph(const std::string& text) { body_ += "<p>" + escaped(text) + "</p>\n"; }

void Page::table(const std::vector<std::vector<std::string>>& rows) {
  // Letters from which on a column is set as text, and up to which a cell keeps to one line.
  constexpr std::size_t sentence = 30, line = 16;
  std::set<std::size_t> of_text;
  for (const auto& row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (row[j].size() > sentence) of_text.insert(j);
    }
  }
  body_ += "<div class=\"wide\"><table>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string begin = i == 0 ? "th scope=\"col\"" : "td", end = i == 0 ? "th" : "td";
    body_ += "<tr>";
    for (std::size_t j = 0; j < rows[i].size(); ++j) {
      const std::string kind = of_text.contains(j)        ? " class=\"text\""
                               : rows[i][j].size() > line ? " class=\"long\""
                                                          : "";
      const std::string cell = of_text.contains(j) ? with_breaks(rows[i][j]) : escaped(rows[i][j]);
      body_ += fmt::format("<{}{}>{}</{}>", begin, kind, cell, end);
    }
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
}

void Page::picture(const std::string& svg, const std::string& caption) {
  std::string own = with_own_ids(svg, fmt::format("p{}-", ++pictures_));
  const std::string opening = "<svg ";
  if (const std::size_t at = own.find(opening); at != std::string::npos) {
    own.insert(at + opening.size(),
               fmt::format("role=\"img\" aria-label=\"{}\" ", escaped(caption)));
  }
  body_ += "<figure><div class=\"wide\">" + own + "</div><figcaption>" + escaped(caption) +
           "</figcaption></figure>\n";
}

std::string Page::html() const {
  // Pictures have a background of their own, white in the dark, too, and are not shrunk until no
  // label can be read: they scroll as tables do.
  return fmt::format(
      R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{0}</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root {{ color-scheme: light dark; --ink: #222; --soft: #555; --line: #ddd; --paper: #fff }}
@media (prefers-color-scheme: dark) {{
:root {{ --ink: #e2e4e8; --soft: #a9adb5; --line: #3c4047; --paper: #17191d }}
}}
body {{ font: 16px/1.5 sans-serif; max-width: 52rem; margin: 2rem auto; padding: 0 1rem; color: var(--ink);
  background: var(--paper); overflow-wrap: anywhere }}
h1 {{ font-size: 1.5rem }} h2 {{ font-size: 1.15rem; margin-top: 2rem }} h3 {{ font-size: 1rem }}
.wide {{ overflow-x: auto }}
table {{ border-collapse: collapse; font-size: 0.9rem; overflow-wrap: normal }}
th, td {{ padding: 0.2rem 0.6rem; border-bottom: 1px solid var(--line); text-align: right; vertical-align: top;
  font-variant-numeric: tabular-nums }}
th {{ vertical-align: bottom }}
th:first-child, td:first-child {{ text-align: left; padding-left: 0 }}
td {{ white-space: nowrap }} td.text, td.long:not(:first-child) {{ white-space: normal }}
th.text, td.text {{ text-align: left; min-width: 11rem; overflow-wrap: anywhere }}
figure {{ margin: 1.5rem 0 }}
figure svg {{ display: block; max-width: max(100%, 36rem); height: auto; background: #fff }}
figcaption {{ color: var(--soft); font-size: 0.9rem; margin-top: 0.3rem }}
@media print {{
.wide {{ overflow: visible }} table {{ font-size: 0.65rem }} figure, tr {{ break-inside: avoid }}
h2, h3 {{ break-after: avoid }} th, td {{ padding: 0.15rem 0.3rem }}
td, td.text, th.text {{ white-space: normal; min-width: 0; overflow-wrap: anywhere }}
}}
</style></head><body>
<h1>{0}</h1>
{1}</body></html>
)",
      escaped(title_), body_);
}

}  // namespace shapeid::app
