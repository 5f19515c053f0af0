#include "experiments/yaml/yaml_tree.hpp"

#include "experiments/manifests/shipped_manifests.hpp"
#include "experiments/yaml/faults.hpp"
#include "tests/support/marked_text.hpp"
#include "tests/support/refusal.hpp"

namespace zerocount::yaml {
namespace {

YamlPointer parse(const std::string& text, Problems& problems) {
  return parse_yaml(text, "m.yaml", false, problems);
}

std::string message_of(const Problems& problems) {
  return refusal_by([&] { problems.raise_if_any(); });
}

/// The message about the text, which may have marks «…» (see with_marks()).
std::string problem_with(const std::string& text) {
  const MarkedText marked = marked_text(text);
  Problems problems;
  parse(marked.text, problems);
  return with_marks(message_of(problems), "m.yaml", marked);
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
  EXPECT_EQ(problem_with("a: 1\nb: {c: 1, «c»: 2}\n«a»: 3\n"),
            "m.yaml:«1»: b.c: duplicate key; expected each key once\n"
            "m.yaml:«2»: a: duplicate key; expected each key once");
}

TEST(YamlTree, RefusesInvalidYaml) {
  EXPECT_TRUE(says(problem_with("b: 1\na: [1, 2\n«»"), "m.yaml:«»: manifest: incomplete list"));
  EXPECT_TRUE(says(problem_with("b: 1\n«a»: [1, 2"), "m.yaml:«»: manifest: incomplete list"));
  EXPECT_TRUE(says(problem_with("a: b«»: c\n"), "m.yaml:«»: manifest: unexpected ':'"));
  EXPECT_TRUE(says(problem_with("a: «\"x\\\"\nb: 1»\n"), "m.yaml:«»: manifest: unclosed quotation mark"));
  EXPECT_TRUE(says(problem_with("a: 1\n«\tb»: 2\n"), "m.yaml:«»: manifest: tab in the indentation"));
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
  EXPECT_TRUE(says(problem_with("a: &x [1, «*x»]\n"), "m.yaml:«»: a.1: the alias lies inside"));
  EXPECT_TRUE(says(problem_with("a: &x {b: {c: *x}}\n"), "a.b.c: the alias lies inside"));
}

TEST(YamlTree, RefusesExponentialAliases) {
  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i)
    laughs += fmt::format("a{0}: &a{0} [*a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}]\n", i, i - 1);
  EXPECT_TRUE(says(problem_with(laughs), "the aliases expand to too many"));
}

TEST(YamlTree, RefusesDeepNesting) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(problem_with(nested(max_nesting)), "");
  EXPECT_TRUE(says(problem_with(nested(max_nesting + 1)), "the nesting is too deep"));
  EXPECT_TRUE(says(problem_with(nested(300000)), "m.yaml:1:"));
}

TEST(YamlTree, RefusesBytesThatAreNotText) {
  EXPECT_TRUE(says(problem_with("a: 1\nb: «\xff»\n"), "m.yaml:«»: manifest: invalid UTF-8"));
  EXPECT_TRUE(says(problem_with(std::string("a: 1\0b", 6)), "m.yaml:1:5"));
  EXPECT_TRUE(says(problem_with("a: \xc3"), "m.yaml:1:4"));
  EXPECT_EQ(problem_with("a: λ # θ\r\nb: ω\r\n"), "");
}

TEST(YamlTree, RefusesControlCharactersInTexts) {
  for (const char* text : {"\\0", "\\e", "\\x7F", "\\u0085", "\\u202E", "\\u2067", "\\r"}) {
    const std::string refused = problem_with(fmt::format("a: {{b: «\"x{}y\"»}}\n", text));
    EXPECT_TRUE(says(refused, "m.yaml:«»: a.b: control character U+"));
    EXPECT_TRUE(says(problem_with(fmt::format("\"x{}y\": 1\n", text)), "control character"));
  }
  EXPECT_TRUE(says(problem_with("a: \u202Eb\n"), "m.yaml:1:4"));
  EXPECT_EQ(problem_with("a: \"two\\nlines and\\ta tab\"\n"), "");
}

// A key is the name of something, which stands in tables, messages and files of one line.
TEST(YamlTree, AKeyStandsOnOneLine) {
  for (const char* const text : {"\\n", "\\t"}) {
    const std::string refused = problem_with(fmt::format("a: {{«\"x{}y\"»: 1}}\n", text));
    EXPECT_TRUE(says(refused, "m.yaml:«»: a: a line break or a tab in a key; expected a name on one line"));
  }
}

TEST(YamlTree, AnEmptyTextHasNoDocument) {
  Problems problems;
  EXPECT_EQ(parse("", problems), nullptr);
  EXPECT_EQ(parse("# nothing\n", problems), nullptr);
  EXPECT_TRUE(problems.empty());
}

// Whatever the text: a tree, or a problem with a place; never a crash or an exception of the YAML library.
TEST(YamlTree, MutatedTextsThrowOnlyExpectedErrors) {
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

/// The message about the text, which may have marks «…» (see with_marks()).
std::string problem_in(const std::string& text, bool one_line = false) {
  const MarkedText marked = marked_text(text);
  Problems problems;
  parse_yaml(marked.text, "m.yaml", one_line, problems);
  return with_marks(message_of(problems), "m.yaml", marked);
}

void collect_scalars(const YamlNode& node, std::vector<Place>& places) {
  if (node.kind == YamlNode::Kind::scalar) places.push_back(node.place);
  for (const YamlPointer& item : node.items) collect_scalars(*item, places);
  for (const YamlEntry& entry : node.entries) {
    places.push_back(entry.place);
    collect_scalars(*entry.value, places);
  }
}

std::size_t offset_of(const std::string& text, const Place& place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
  return at + static_cast<std::size_t>(place.column) - 1;
}

// A quotation mark too many swallows lines; whatever follows, the user must learn where it stands.
TEST(LexicalFaults, AQuotationMarkBeforeAnyScalarOfAShippedManifestIsAnErrorOnItsLine) {
  std::size_t tried = 0;
  for (const auto& shipped : manifests::shipped_manifests()) {
    const std::string text(shipped.bytes);
    Problems problems;
    const YamlPointer root = parse_yaml(text, "m.yaml", false, problems);
    std::vector<Place> places;
    collect_scalars(*root, places);
    for (const Place& place : places) {
      const std::size_t at = offset_of(text, place);
      if (text[at] == '|' || text[at] == '>' || text[at] == '"' || text[at] == '\'') continue;
      const char* const before = std::array{"\"", "'", "&x \"", "! '"}[tried++ % 4];
      const std::string problem = problem_in(std::string(text).insert(at, before));
      ASSERT_TRUE(problem.starts_with(fmt::format("m.yaml:{}:", place.line)))
          << shipped.name << ", " << before << " at line " << place.line << ": " << problem;
    }
  }
  EXPECT_GT(tried, 1000u);
}

TEST(LexicalFaults, AnUnclosedQuoteIsNamedEvenIfALaterOneClosesIt) {
  const auto expect_unclosed = [](const std::string& text) {
    const std::string problem = problem_in(text);
    EXPECT_TRUE(problem.starts_with("m.yaml:«»: manifest: unclosed quotation mark")) << text << "\n"
                                                                                     << problem;
  };
  for (const std::string end : {"", "\n"}) {  // yaml-cpp treats them differently
    expect_unclosed("a: 1\nb: «\"two»\nc: 3" + end);
    expect_unclosed("a: 1\nb: «'two»\nc: 3" + end);
    expect_unclosed("a: 1\nb: &anchor «'two»\nc: 3" + end);
    expect_unclosed("a: 1\nb: ! &anchor «\"two»\nc: 3" + end);
  }
  expect_unclosed("a: «\"one»\nb: \"two\"\nc: 3\n");
  expect_unclosed("a: «'one»\nb: 2 # the machine's\nc: 3\n");
  expect_unclosed("a: [1, «\"two, 3]»\nb: {c: \"\"}\n");
  expect_unclosed("a: {b: «'x, c: 2}»\nd: 'y'\n");
  expect_unclosed("«\"a: 1»\nb\": 2\n");
  expect_unclosed("a: 1\n«'b: 2»\nc: 3\n");
  expect_unclosed("a:\n  - «\"x»\n  - y\"\n");
  expect_unclosed("a:\n  b: «'x»\n  c: ''\n");
  expect_unclosed("a: |\n  it's \"text\nb: «\"c»\nd: 1\n");
  expect_unclosed("a: «\"x»\n---\nb: 1\"\n");
  EXPECT_TRUE(problem_in("\"x", true).starts_with("m.yaml: manifest: unclosed quotation mark"));
}

// yaml-cpp begins the text right after a lone '!'.
TEST(LexicalFaults, AQuotationMarkInATagOrAnAnchorIsAnError) {
  for (const char* const value : {"!\"two", "!'two", "&a !\"two", "!x\"two\"", "&a\"two\""}) {
    const std::string problem = problem_in(fmt::format("a: 1\nb: {}\nc: 3\n", value));
    EXPECT_TRUE(problem.starts_with("m.yaml:2:")) << value << ": " << problem;
  }
}

TEST(LexicalFaults, AFaultIsReportedWhereItBegins) {
  const auto starts = [](const std::string& text, const std::string& problem) {
    EXPECT_TRUE(problem_in(text).starts_with(problem)) << text << "\n" << problem_in(text);
  };
  starts("a: \"b\"«c»\nd: 1\n", "m.yaml:«»: manifest: text after the closing quotation mark");
  starts("a: [\"b\" «c»]\n", "m.yaml:«»: manifest: text after the closing quotation mark");
  starts("a:\n«\tb»: 1\n", "m.yaml:«»: manifest: tab in the indentation");
  starts("\ta: 1\n", "m.yaml:1:1: manifest: tab in the indentation");
  starts("a:\n  b: 1\n «\t c»: 1\n", "m.yaml:«»: manifest: tab in the indentation");
  starts("a: 1\n«b:2»\nc: 3\n", "m.yaml:«»: manifest: a text without the colon");
  starts("a: {b: 1}\n«c 5»\nd: 3\n", "m.yaml:«»: manifest: a text without the colon");
  starts("<<: {a: 1}\n", "m.yaml:1:1: manifest: merge keys are not supported");
}

// Writes random documents in all styles of YAML, with marks and comments that are not quotation marks.
class Writer {
 public:
  explicit Writer(unsigned seed) : random_(seed) {}

  struct Written {
    std::string text;
    std::string meaning;  ///< the value of the written text, as flow_text() of its node returns it
  };

  Written document() { return {block(0, 2)}; }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }

  // On one line, also inside brackets.
  Written inline_scalar() {
    static const std::vector<Written> scalars{{"5", "5"},
                                              {"it's", "it's"},
                                              {"a\"b", "a\"b"},
                                              {"b#c", "b#c"},
                                              {"x:y", "x:y"},
                                              {"''", ""},
                                              {"'it''s'", "it's"},
                                              {"\"a\\\"b\"", "a\"b"},
                                              {"\"# no: {comment\"", "# no: {comment"},
                                              {"&id 'x'", "x"},
                                              {"'['", "["}};
    return scalars[below(scalars.size())];
  }

  Written flow(int depth) {
    if (depth == 0 || below(2) == 0) return inline_scalar();
    const bool map = below(2) == 0;
    Written written{map ? "{" : "[", map ? "{" : "["};
    for (std::size_t i = 0, n = below(4); i < n; ++i) {
      const Written item = flow(depth - 1);
      const std::string key = map ? fmt::format("k{}: ", i) : "";
      if (i > 0) written = {written.text + ",", written.meaning + ", "};
      const std::string gap = below(3) == 0 ? "  # isn't \"one\n     " : " ";
      written = {written.text + (i > 0 ? gap : "") + key + item.text, written.meaning + key + item.meaning};
    }
    return {written.text + (map ? "}" : "]"), written.meaning + (map ? "}" : "]")};
  }

  // A value after "key:" or "-" in a column; it ends with a line feed.
  Written value(std::size_t column, int depth) {
    const std::string deeper(column + 1 + below(3), ' ');
    switch (below(6)) {
      case 0:
        return {" \"one\n" + deeper + "'two\"  # three's\n", "one 'two"};
      case 1:
        return {" one\n\n" + deeper + "\"two\n", "one\n\"two"};
      case 2:
        return {" |-\n" + deeper + "it's\n\n" + deeper + "\"x: {\n", "it's\n\n\"x: {"};
      case 3:
        if (depth > 0) {
          const Written inner = block(column + 1 + below(3), depth - 1);
          return {(below(2) == 0 ? "  # what's next\n" : "\n") + inner.text, inner.meaning};
        }
        [[fallthrough]];
      default: {
        const Written inner = flow(2);
        return {" " + inner.text + (below(2) == 0 ? " # it's\n" : "\n"), inner.meaning};
      }
    }
  }

  Written block(std::size_t column, int depth) {
    const bool map = below(3) > 0;
    const std::string indentation(column, ' ');
    Written written{"", map ? "{" : "["};
    for (std::size_t i = 0, n = 1 + below(4); i < n; ++i) {
      const Written item = value(column, depth);
      const std::string key = fmt::format("k{}: ", i);
      const std::string shown = below(2) == 0 ? fmt::format("k{}:", i) : fmt::format("\"k{}\":", i);
      written.text += indentation + (map ? shown : "-") + item.text;
      if (below(4) == 0) written.text += "\n# don't\n";
      written.meaning += (i > 0 ? ", " : "") + (map ? key : "") + item.meaning;
    }
    return {written.text, written.meaning + (map ? "}" : "]")};
  }

  std::mt19937 random_;
};

TEST(LexicalFaults, DocumentsInAllStylesOfYamlKeepTheirMeaning) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const auto [text, meaning] = Writer(seed).document();
    Problems problems;
    const YamlPointer root = parse_yaml(text, "m.yaml", false, problems);
    ASSERT_TRUE(root && problems.empty()) << problem_in(text) << "\n" << text;
    ASSERT_EQ(flow_text(*root), meaning) << text;
  }
}

}  // namespace
}  // namespace zerocount::yaml
