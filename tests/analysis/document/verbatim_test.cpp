// Texts of several lines that are shown as they are, such as a part of a manifest.
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

const std::string lines = "friction:\n  k1: 110   # <b>\n";

Answer answer_with_lines() {
  AnswerDescription<std::string> description{{.name = "example", .meaning = "an example"}, {}};
  description.items.value({.key = "manifest", .heading = "To paste", .verbatim = true},
                          [](const std::string& text) { return text; });
  return description.of(lines);
}

TEST(VerbatimText, KeepsItsLinesInEveryFormat) {
  const Answer answer = answer_with_lines();
  EXPECT_EQ(json(answer)["manifest"], lines);
  EXPECT_EQ(text(answer), "To paste:\n\n" + lines);
  EXPECT_NE(markdown(answer).find("```\n" + lines + "```\n"), std::string::npos) << markdown(answer);
  EXPECT_NE(html(answer).find("<pre>friction:\n  k1: 110   # &lt;b&gt;\n</pre>"), std::string::npos)
      << html(answer);
}

}  // namespace
}  // namespace zerocount::document
