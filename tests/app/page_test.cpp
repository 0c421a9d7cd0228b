// A page and what stands in it: pictures of gnuplot beside each other, tables wider than a screen.
#include <gtest/gtest.h>

#include <string>

#include "shapeid/app/html.hpp"
#include "shapeid/app/svg.hpp"
#include "shapeid/tests/app/page_ids.hpp"

namespace shapeid::test {
namespace {

/// As gnuplot writes it: points that refer to each other, of both quotes, and a joint's name that
/// looks like an attribute.
const std::string drawn = R"svg(<svg width="8"><title>Gnuplot</title>
<g id="gnuplot_canvas"><defs><circle id='gpPt5' r='1'/><use xlink:href='#gpPt5' id='gpPt6'/>
<pattern id="gpPat1"/></defs><g id="gnuplot_plot_1" ><title>$d using 1:5</title>
<use xlink:href='#gpPt6' x='2'/><path fill="url(#gpPat1)"/></g>
<g id="gnuplot_plot_1" ><text>knee id='gpPt5' href='#gpPt5'</text></g></g></svg>)svg";

TEST(Page, PicturesBesideEachOtherHaveIdsOfTheirOwn) {
  app::Page page("two pictures");
  page.picture(drawn, "one");
  page.picture(drawn, "the other");
  const PageIds ids = ids_of(page.html());
  EXPECT_EQ(ids.own.size(), 6U);  // of each the two points and the pattern
  EXPECT_EQ(ids.references.size(), 6U);
  EXPECT_EQ(ids.twice(), "");
  EXPECT_EQ(ids.missing(), "");
}

TEST(Page, WhatStandsInAPictureStays) {
  const std::string own = app::with_own_ids(drawn, "p1-");
  EXPECT_NE(own.find("<text>knee id='gpPt5' href='#gpPt5'</text>"), std::string::npos) << own;
  EXPECT_NE(own.find("<use xlink:href='#p1-gpPt5' id='p1-gpPt6'/>"), std::string::npos) << own;
  EXPECT_NE(own.find("<path fill=\"url(#p1-gpPat1)\"/>"), std::string::npos) << own;
  EXPECT_EQ(own.find("gnuplot_plot_1"), std::string::npos) << own;
}

TEST(Page, NoCommandOfThePlottingProgramIsATooltip) {
  const std::string bare = app::without_titles(drawn);
  EXPECT_EQ(bare.find("title"), std::string::npos) << bare;
  EXPECT_EQ(bare.find("using"), std::string::npos) << bare;
  EXPECT_TRUE(bare.starts_with("<svg width=\"8\">\n<g id=\"gnuplot_canvas\">")) << bare;
  EXPECT_TRUE(bare.ends_with("</g></g></svg>")) << bare;
}

TEST(Page, APictureIsReadOutAsItsCaption) {
  app::Page page("a picture");
  page.picture(drawn, "gain & \"delay\"");
  const std::string html = page.html();
  EXPECT_NE(html.find("<svg role=\"img\" aria-label=\"gain &amp; &quot;delay&quot;\" width=\"8\">"),
            std::string::npos)
      << html;
}

/// A sentence may wrap and reads from the left; numbers stand under each other.
TEST(Page, ATableScrollsByItselfAndItsSentencesWrap) {
  app::Page page("a table");
  page.table({{"effect", "value", "doubt"},
              {"drag", "1.5", "a law that no robot has explains more, this one less"},
              {"lag", "-0.25", ""}});
  const std::string html = page.html();
  EXPECT_NE(html.find("<div class=\"wide\"><table>"), std::string::npos) << html;
  EXPECT_NE(html.find(".wide { overflow-x: auto }"), std::string::npos) << html;
  EXPECT_NE(html.find("<th scope=\"col\">value</th><th scope=\"col\" class=\"text\">doubt</th>"),
            std::string::npos)
      << html;
  EXPECT_NE(html.find("<td>-0.25</td><td class=\"text\"></td>"), std::string::npos) << html;
  EXPECT_NE(html.find("prefers-color-scheme: dark"), std::string::npos) << html;
}

}  // namespace
}  // namespace shapeid::test
