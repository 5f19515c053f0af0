#include "experiments/yaml/yaml_tree.hpp"

#include "core/failure/failure.hpp"
#include "tests/support/says.hpp"
#include "tests/support/test.hpp"

namespace zerocount::yaml {
namespace {

YamlPointer parse(const std::string& text, Problems& problems) {
  return parse_yaml(text, "m.yaml", false, problems);
}

std::string message_of(const Problems& problems) {
  try {
    problems.raise_if_any();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    return failure.what();
  }
  return "";
}

std::string problem_with(const std::string& text) {
  Problems problems;
  parse(text, problems);
  return message_of(problems);
}

TEST(YamlTree, KeepsOrderPlacesAndQuotes) {
  Problems problems;
  const YamlPointer root = parse("b: 'x'\na: [1, {c: ~}]\n", problems);
  ASSERT_TRUE(problems.empty());
  ASSERT_EQ(root->entries.size(), 2u);
  EXPECT_EQ(root->entries[0].key, "b");
  EXPECT_FALSE(root->entries[0].value->plain);
  EXPECT_EQ(root->entries[1].place.line, 2);
  const YamlNode& list = *root->entries[1].value;
  EXPECT_EQ(list.items[0]->place.column, 5);
  EXPECT_TRUE(list.items[0]->plain);
  EXPECT_EQ(list.items[1]->entries[0].value->kind, YamlNode::Kind::null);
  EXPECT_EQ(flow_text(list), "[1, {c: ~}]");
}

TEST(YamlTree, AnAliasSharesTheNodeOfItsAnchor) {
  Problems problems;
  const YamlPointer root = parse("a: &x [1, 2]\nb: *x\n", problems);
  ASSERT_TRUE(problems.empty());
  EXPECT_EQ(root->entries[0].value, root->entries[1].value);
}

TEST(YamlTree, ReportsEveryDuplicateKeyWhereItStands) {
  EXPECT_EQ(problem_with("a: 1\nb: {c: 1, c: 2}\na: 3\n"),
            "m.yaml:2:11: b.c: duplicate key; expected each key once\n"
            "m.yaml:3:1: a: duplicate key; expected each key once");
}

TEST(YamlTree, RefusesWhatIsNotYaml) {
  EXPECT_TRUE(says(problem_with("b: 1\na: [1, 2\n"), "m.yaml:3:1: manifest: incomplete list"));
  EXPECT_TRUE(says(problem_with("b: 1\na: [1, 2"), "m.yaml:2:1: manifest: incomplete list"));
  EXPECT_TRUE(says(problem_with("a: b: c\n"), "m.yaml:1:5: manifest: unexpected ':'"));
  EXPECT_TRUE(says(problem_with("a: \"x\\\"\nb: 1\n"), "m.yaml:1:4: manifest: unclosed quotation mark"));
  EXPECT_TRUE(says(problem_with("a: 1\n\tb: 2\n"), "m.yaml:2:1: manifest: tab in the indentation"));
  EXPECT_TRUE(says(problem_with("a: *nothing\n"), "alias without an anchor"));
  EXPECT_TRUE(says(problem_with("a: ]\n"), "m.yaml:1:"));
}

TEST(YamlTree, RefusesASecondDocumentTagsAndOddKeys) {
  EXPECT_TRUE(says(problem_with("a: 1\n---\nb: 2\n"), "a second document starts here"));
  EXPECT_TRUE(says(problem_with("a: !!float 1\n"), "a: unsupported tag"));
  EXPECT_TRUE(says(problem_with("a: !mine [1]\n"), "a: unsupported tag '!mine'"));
  EXPECT_TRUE(says(problem_with("? [1, 2]\n: 3\n"), "cannot be a key"));
  EXPECT_TRUE(says(problem_with("? {a: 2}\n: 3\n"), "cannot be a key"));
  EXPECT_TRUE(says(problem_with("~: 3\n"), "the key is empty"));
  EXPECT_TRUE(says(problem_with("x: &l [1]\ny: {*l : 2}\n"), "cannot be a key"));
}

TEST(YamlTree, RefusesAnchorsThatContainThemselves) {
  EXPECT_TRUE(says(problem_with("a: &x [1, *x]\n"), "m.yaml:1:11: a.1: the alias lies inside"));
  EXPECT_TRUE(says(problem_with("a: &x {b: {c: *x}}\n"), "a.b.c: the alias lies inside"));
}

TEST(YamlTree, RefusesExponentialAliases) {
  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    laughs += fmt::format("a{0}: &a{0} [*a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}]\n", i, i - 1);
  }
  EXPECT_TRUE(says(problem_with(laughs), "the aliases expand to too many"));
}

TEST(YamlTree, RefusesDeepNesting) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(problem_with(nested(max_nesting)), "");
  EXPECT_TRUE(says(problem_with(nested(max_nesting + 1)), "the nesting is too deep"));
  EXPECT_TRUE(says(problem_with(nested(300000)), "m.yaml:1:"));
}

TEST(YamlTree, RefusesBytesThatAreNotText) {
  EXPECT_TRUE(says(problem_with("a: 1\nb: \xff\n"), "m.yaml:2:4: manifest: invalid UTF-8"));
  EXPECT_TRUE(says(problem_with(std::string("a: 1\0b", 6)), "m.yaml:1:5"));
  EXPECT_TRUE(says(problem_with("a: \xc3"), "m.yaml:1:4"));
  EXPECT_EQ(problem_with("a: λ # θ\r\nb: ω\r\n"), "");
}

TEST(YamlTree, RefusesControlCharactersInTexts) {
  for (const char* text : {"\\0", "\\e", "\\x7F", "\\u0085", "\\u202E", "\\u2067", "\\r"}) {
    const std::string refused = problem_with(fmt::format("a: {{b: \"x{}y\"}}\n", text));
    EXPECT_TRUE(says(refused, "m.yaml:1:8: a.b: control character U+"));
    EXPECT_TRUE(says(problem_with(fmt::format("\"x{}y\": 1\n", text)), "control character"));
  }
  EXPECT_TRUE(says(problem_with("a: \u202Eb\n"), "m.yaml:1:4"));
  EXPECT_EQ(problem_with("a: \"two\\nlines and\\ta tab\"\n"), "");
}

// A key is the name of something, which stands in tables, messages and files of one line.
TEST(YamlTree, AKeyStandsOnOneLine) {
  for (const char* const text : {"\\n", "\\t"}) {
    const std::string refused = problem_with(fmt::format("a: {{\"x{}y\": 1}}\n", text));
    EXPECT_TRUE(says(refused, "m.yaml:1:5: a: a line break or a tab in a key; expected a name on one line"));
  }
}

TEST(YamlTree, AnEmptyTextIsNoDocument) {
  Problems problems;
  EXPECT_EQ(parse("", problems), nullptr);
  EXPECT_EQ(parse("# nothing\n", problems), nullptr);
  EXPECT_TRUE(problems.empty());
}

// Whatever the text: a tree, or a problem with a place; never a crash or an exception of the YAML library.
TEST(YamlTree, MutilatedTextsNeverEscape) {
  const std::string text =
      "a: &x {b: [1, 'two', \"th\\tree\"], c: *x2}\n? d\n: - e\n  - |\n    f\n%g\n--- # h\n";
  std::uint64_t state = 1;
  for (int i = 0; i < 20000; ++i) {
    std::string mutilated = text;
    for (int change = 0; change < 3; ++change) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      const std::size_t at = (state >> 33) % mutilated.size();
      const char with = "[]{}:,&*!|>-?%@'\"# \n\tx1"[(state >> 20) % 23];
      if (state >> 63) {
        mutilated.erase(at, 1);
      } else {
        mutilated[at] = with;
      }
    }
    Problems problems;
    YamlPointer tree;
    ASSERT_NO_THROW(tree = parse(mutilated, problems)) << mutilated;
    ASSERT_TRUE(tree || !problems.empty()) << mutilated;
  }
}

}  // namespace
}  // namespace zerocount::yaml
