// Names that users give cannot become commands of a spreadsheet, links or layout.
#include "analysis/document/answer.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

struct NamedRow {
  std::string name;
};

struct NamedAnswer {
  std::string name;
  std::vector<NamedRow> rows;
  std::string lines{};
};

Answer named_answer(const std::string& name, const std::string& lines = "") {
  AnswerDescription<NamedAnswer> description{{.name = "holder", .meaning = "names", .csv_table = "rows"}, {}};
  description.items.headline(&NamedAnswer::name)
      .sentence(&NamedAnswer::name)
      .value({.key = "name", .heading = "name"}, &NamedAnswer::name)
      .value({.key = "lines", .heading = "lines", .optional = true, .verbatim = true},
             [](const NamedAnswer& holder) { return holder.lines; })
      .table({.key = "rows", .heading = "names"},
             Description<NamedRow>().value({.key = "name", .heading = "name"}, &NamedRow::name),
             &NamedAnswer::rows);
  return description.of({name, {{name}}, lines});
}

TEST(Escaping, ATextOfCsvIsNoFormula) {
  EXPECT_EQ(csv(named_answer("=cmd|' /C calc'!A0")), "name\n'=cmd|' /C calc'!A0\n");
  EXPECT_EQ(csv(named_answer("@SUM(1,2)")), "name\n\"'@SUM(1,2)\"\n");
  EXPECT_EQ(csv(named_answer("+1+1")), "name\n'+1+1\n");
  EXPECT_EQ(csv(named_answer("-3")), "name\n-3\n");
}

TEST(Escaping, AWholeAnswerOfCsvIsNoFormula) {
  AnswerDescription<NamedRow> description{{.name = "holder", .meaning = "a name"}, {}};
  description.items.value({.key = "name", .heading = "name"}, &NamedRow::name);
  EXPECT_EQ(csv(description.of({"=1+1"})), "name\n'=1+1\n");
}

TEST(Escaping, NoNameIsALinkInMarkdown) {
  const std::string link = markdown(named_answer("[x](javascript:alert(2))"));
  EXPECT_EQ(link.find("]("),
            link.find("\\](") == std::string::npos ? std::string::npos : link.find("\\](") + 1);
  EXPECT_NE(link.find("[x\\](javascript:alert(2))"), std::string::npos) << link;
  EXPECT_NE(markdown(named_answer("[x]: javascript:alert(2)")).find("[x\\]: "), std::string::npos);
  EXPECT_NE(markdown(named_answer("[x][y]")).find("[x\\][y]"), std::string::npos);
  // Brackets of bounds stay as they are.
  EXPECT_NE(markdown(named_answer("90 [87, 95] %")).find("90 [87, 95] %"), std::string::npos);
}

TEST(Escaping, NoNameIsLayoutInMarkdown) {
  EXPECT_EQ(markdown(named_answer("# a")).find("\n# a"), std::string::npos);
  for (const char* const name : {"# a", "- a", "+ a", "> a", "1. a", "12) a", "=== a", "---"}) {
    const std::string text = markdown(named_answer(name));
    EXPECT_EQ(text.find(std::string("\n") + name), std::string::npos) << text;
  }
  EXPECT_NE(markdown(named_answer("a|b <i> `c` *d* _e_ ~f~ &lt;"))
                .find("a\\|b \\<i> \\`c\\` \\*d\\* \\_e\\_ \\~f\\~ \\&lt;"),
            std::string::npos);
  // The block of lines ends where its lines end.
  EXPECT_NE(markdown(named_answer("a", "x\n```\n# y\n")).find("````\nx\n```\n# y\n````\n"),
            std::string::npos);
}

}  // namespace
}  // namespace zerocount::document
