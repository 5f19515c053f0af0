#include <nlohmann/json.hpp>

#include "analysis/document/markup.hpp"
#include "analysis/report/figures/figure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

const std::string hostile = "</script><script>alert('x')</script><!-- & \"quoted\" \xff\x01";

TEST(Escaping, TextHoldsNoMarkup) {
  const std::string text = document::markup(hostile);
  EXPECT_EQ(text.find_first_of("<>\"'"), std::string::npos) << text;
  EXPECT_EQ(document::markup("a < b & c"), "a &lt; b &amp; c");
  EXPECT_EQ(document::markup("µrad\n\tnext"), "µrad\n\tnext");
}

TEST(Escaping, WhatIsNotTextIsReplaced) {
  EXPECT_EQ(document::markup("a\xff"), "a\xEF\xBF\xBD");
  EXPECT_EQ(document::markup(std::string("a\0b", 3)),
            "a\xEF\xBF\xBD"
            "b");
}

TEST(Escaping, NoLineBreaksBeforeAPercentSign) {
  EXPECT_EQ(document::prose_markup("95 % of < 3"), "95&nbsp;% of &lt; 3");
}

TEST(Escaping, JsonCannotEndItsScriptAndReadsBack) {
  const std::string valid = hostile.substr(0, hostile.size() - 2);
  const nlohmann::ordered_json json{{"text", valid}, {"nan", std::nan("")}};
  const std::string text = script_json(json);
  EXPECT_EQ(text.find('<'), std::string::npos);
  const auto read = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(read["text"], valid);
  EXPECT_TRUE(read["nan"].is_null());
  EXPECT_NO_THROW(script_json({{"text", hostile}}));
}

TEST(Escaping, ScriptsDoNotEndThemselves) {
  const std::string source = script_source("a = '</script>' + '<!--';");
  EXPECT_EQ(source, "a = '<\\/script>' + '<\\!--';");
}

}  // namespace
}  // namespace zerocount::report
