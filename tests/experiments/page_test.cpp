// Prose cannot say what was not computed.
#include <gtest/gtest.h>

#include <stdexcept>

#include "shapeid/tests/experiments/page/page.hpp"

namespace shapeid::experiments {
namespace {

Findings some_findings() {
  Findings findings;
  findings.set("a.mass", 1.23456);
  findings.set("count", 42.0);
  findings.tables["t"] = {{"x", "y"}, {"1", "2"}};
  findings.plots["p"] = "plot x";
  return findings;
}

std::string filled(const std::string& text) {
  return fill(text, some_findings(), {{"commit", "abc"}}, "pictures").text;
}

TEST(Page, NumbersTablesPicturesAndWords) {
  EXPECT_EQ(filled("off by {a.mass} kg in {count:d} cases"), "off by 1.23 kg in 42 cases");
  EXPECT_EQ(filled("{a.mass:.1f} {a.mass:%} %"), "1.2 123 %");
  EXPECT_EQ(filled("{table t}\nend"), "| x | y |\n|---|---|\n| 1 | 2 |\nend");
  EXPECT_EQ(filled("{plot p Some curves}"), "![Some curves](pictures/p.svg)");
  EXPECT_EQ(filled("at {text commit}"), "at abc");
}

TEST(Page, NamesWhatNobodyComputed) {
  const auto broken = [](const std::string& text) {
    return fill(text, some_findings(), {}, "").broken;
  };
  EXPECT_EQ(broken("{b.mass}"), std::vector<std::string>{"no number is called b.mass"});
  EXPECT_EQ(broken("{table u}"), std::vector<std::string>{"no table is called u"});
  EXPECT_EQ(broken("{plot q x}"), std::vector<std::string>{"no plot is called q"});
  EXPECT_EQ(broken("{holds a.mass < nothing}"),
            std::vector<std::string>{"no number is called nothing"});
  EXPECT_EQ(filled("{b.mass}"), "?");
  EXPECT_THROW(static_cast<void>(filled("{text none}")), std::out_of_range);
  EXPECT_THROW(static_cast<void>(filled("{holds a.mass > 1}")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(filled("open {a.mass")), std::invalid_argument);
}

TEST(Page, NamesStatementsThatDoNotHold) {
  const auto broken = [](const std::string& text) {
    return fill(text, some_findings(), {}, "").broken.size();
  };
  EXPECT_EQ(broken("{holds a.mass < count}"), 0U);
  EXPECT_EQ(broken("{holds a.mass <= 1.23456}{holds count = 42}"), 0U);
  EXPECT_EQ(broken("{holds count < a.mass}"), 1U);
  EXPECT_EQ(broken("{holds a.mass < 1.2}{holds count = 41}"), 2U);
  EXPECT_EQ(filled("x\n{holds a.mass < count}\ny"), "x\ny");
  EXPECT_EQ(filled("so it is. {holds a.mass < count}\n{holds 1 < count}\ny"), "so it is.\ny");
  EXPECT_EQ(filled("* so\n  {holds 1 < 2}\n  {holds 1 < 2}\n* y"), "* so\n* y");
}

TEST(Findings, ANameIsGivenOnce) {
  Findings findings = some_findings();
  EXPECT_THROW(findings.set("count", 1.0), std::logic_error);
  EXPECT_THROW(findings.set("new", std::numeric_limits<double>::infinity()), std::logic_error);
  EXPECT_THROW(findings.merge(some_findings()), std::logic_error);
  const Findings again = findings_from_json(findings_to_json(findings));
  EXPECT_EQ(again.values, findings.values);
  EXPECT_EQ(again.tables, findings.tables);
}

}  // namespace
}  // namespace shapeid::experiments
