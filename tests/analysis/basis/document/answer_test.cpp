#include "analysis/basis/document/answer.hpp"

#include <nlohmann/json.hpp>

#include "analysis/basis/text/report_json.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

using Json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// An axis of the made-up answer of a command, with which the output formats are tested.
struct Axis {
  std::string name;
  double torque{0.0};
  Bounded rate{0.5, 0.4, 0.6};
  double load{unknown};
};

/// A made-up answer of a command that has every kind of item.
struct Subject {
  std::string headline{"the goal is met"};
  std::vector<Axis> axes{};
  std::optional<double> delay{};
  std::vector<std::pair<std::string, double>> gains{{"controller.ki", 3e4}};
  std::vector<double> rates{0.1, unknown};
  std::string why{};
};

Description<Axis> axis_description() {
  return Description<Axis>()
      .value({.key = "name", .heading = "axis"}, &Axis::name)
      .value({.key = "torque", .heading = "torque", .meaning = "breakaway torque", .unit = "N m"},
             &Axis::torque)
      .value({.key = "rate", .heading = "rate", .unit = "1", .notation = Notation::percent}, &Axis::rate)
      .value({.key = "load", .heading = "load", .unit = "kg"}, &Axis::load)
      .value({.key = "shown", .heading = "for people", .shown = Visibility::to_people},
             [](const Axis&) { return "composed"; })
      .value({.key = "hidden", .heading = "for data", .shown = Visibility::in_data},
             [](const Axis&) { return 7; });
}

AnswerDescription<Subject> description() {
  AnswerDescription<Subject> answer{{.name = "example", .meaning = "an example", .csv_table = "axes"}, {}};
  answer.items.headline(&Subject::headline)
      .value({.key = "delay", .heading = "delay", .unit = "s"}, &Subject::delay)
      .value({.key = "gains", .heading = "gains"}, &Subject::gains)
      .value({.key = "rates", .heading = "rates", .unit = "1"}, &Subject::rates)
      .table({.key = "axes", .heading = "axes of the machine"}, axis_description(), &Subject::axes)
      .object({.key = "first", .heading = "the first axis"}, axis_description(),
              [](const Subject& s) { return s.axes.empty() ? nullptr : &s.axes.front(); })
      .sentence(&Subject::why);
  return answer;
}

Subject example() {
  Subject subject;
  subject.axes = {{.name = "x", .torque = 0.3}, {.name = "y", .torque = 0.25}};
  subject.why = "because";
  return subject;
}

TEST(Answer, StatesItsNameVersionAndHeadlineInJson) {
  const Json json = document::json(description().of(example()));
  EXPECT_EQ(json["answer"], "example");
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["headline"], "the goal is met");
}

TEST(Answer, WritesJsonInPiecesThatEqualTheWhole) {
  Subject subject = example();
  for (const char* name : {"a \"quoted\" name", "back\\slash", "line\nbreak", "Größe", "broken \xff UTF-8"})
    subject.axes.push_back({.name = name, .torque = -0.0});
  for (std::size_t i = 0; i < 2000; ++i) subject.axes.push_back({.name = "z", .torque = 1.0 / 3.0});
  for (const Subject& one : {subject, example(), Subject{}}) {
    const Answer answer = description().of(one);
    const Json tree = document::json(answer);
    std::string text;
    std::size_t longest = 0;
    document::write_json(answer, 2, [&](std::string_view piece) {
      text += piece;
      longest = std::max(longest, piece.size());
    });
    EXPECT_EQ(text, text::json_text(tree));
    EXPECT_EQ(document::json_text(answer, text::one_line), text::json_text(tree, text::one_line));
    EXPECT_LT(longest, 100'000U);
  }
}

TEST(Answer, WritesBoundsBesideTheirValueAndUnknownNumbersAsNull) {
  const Json row = document::json(description().of(example()))["axes"][0];
  EXPECT_EQ(row["rate"], 0.5);
  EXPECT_EQ(row["rate_low"], 0.4);
  EXPECT_EQ(row["rate_high"], 0.6);
  EXPECT_TRUE(row["load"].is_null());
  EXPECT_FALSE(row.contains("shown"));
  EXPECT_EQ(row["hidden"], 7);
}

TEST(Answer, WritesEveryNumberSoThatItReadsBack) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 200; ++i) {
    Subject subject = example();
    subject.axes[0].torque = std::ldexp(std::uniform_real_distribution(-1.0, 1.0)(random),
                                        std::uniform_int_distribution(-300, 300)(random));
    const Answer answer = description().of(subject);
    EXPECT_EQ(Json::parse(document::json(answer).dump())["axes"][0]["torque"], subject.axes[0].torque);
    const std::string csv = document::csv(answer);
    EXPECT_EQ(std::stod(csv.substr(csv.find("\nx,") + 3)), subject.axes[0].torque) << csv;
  }
}

TEST(Answer, NamesTheColumnsOfItsCsvLikeTheKeysOfItsJson) {
  const std::string csv = document::csv(description().of(example()));
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "name,torque,rate,rate_low,rate_high,load,hidden");
  EXPECT_EQ(document::csv(description().of({})), csv.substr(0, csv.find('\n') + 1));
}

TEST(Answer, QuotesCellsOfCsvThatWouldEndThem) {
  Subject subject = example();
  subject.axes[0].name = "a,\"b\"\nc";
  EXPECT_TRUE(says(document::csv(description().of(subject)), "\n\"a,\"\"b\"\"\nc\",0.3"));
}

TEST(Answer, TextShowsTitlesAndUnitsAndOmitsEmptyColumns) {
  const std::string text = document::text(description().of(example()));
  EXPECT_TRUE(text.starts_with("the goal is met\n")) << text;
  EXPECT_TRUE(says(text, "gains: controller.ki = 3e+04\n", "\naxes of the machine:\n\naxis  torque (N m)",
                   "50.0 % [40.0, 60.0]"));
  EXPECT_FALSE(says(text, "load"));
  EXPECT_FALSE(says(text, "for data"));
  EXPECT_FALSE(says(text, "delay"));
}

TEST(Answer, LeavesOutTablesWithoutRowsAndEmptySentences) {
  const std::string text = document::text(description().of({}));
  EXPECT_FALSE(says(text, "axes of the machine"));
  EXPECT_EQ(text, "the goal is met\ngains: controller.ki = 3e+04\nrates: 0.1, –\n");
}

TEST(Answer, EscapesManifestTextInMarkup) {
  Subject subject = example();
  subject.axes[0].name = "<script>|`*_\x1b[31m";
  subject.headline = "<b>&";
  const Answer answer = description().of(subject);
  const std::string html = document::html(answer);
  EXPECT_FALSE(says(html, "<script"));
  EXPECT_FALSE(says(html, "<b>"));
  EXPECT_EQ(html.find('\x1b'), std::string::npos);
  const std::string markdown = document::markdown(answer);
  EXPECT_TRUE(says(markdown, "\\<script>\\|\\`\\*\\_"));
  EXPECT_EQ(markdown.find('\x1b'), std::string::npos);
}

TEST(Answer, GivesEveryRowOfAMarkdownTableTheSameCells) {
  const std::string markdown = document::markdown(description().of(example()));
  EXPECT_TRUE(says(markdown,
                   "| axis | torque (N m) | rate | for people |\n| --- | ---: | ---: | --- |\n"
                   "| x | 0.3 | 50.0 % [40.0, 60.0] | composed |\n"));
}

/// Expects that the JSON Schema of an object requires exactly the keys that the JSON object has, and so on
/// for all objects in it.
void expect_described(const Json& schema, const Json& json) {
  if (json.is_object() && schema.contains("properties")) {
    std::set<std::string> keys;
    for (const auto& [key, value] : json.items()) {
      keys.insert(key);
      ASSERT_TRUE(schema["properties"].contains(key)) << key;
      expect_described(schema["properties"][key], value);
    }
    for (const Json& key : schema["required"]) EXPECT_TRUE(keys.contains(key.get<std::string>())) << key;
  }
  if (json.is_array() && schema.contains("items")) {
    for (const Json& value : json) expect_described(schema["items"], value);
  }
}

TEST(AnswerSchema, DescribesEveryKeyOfTheJson) {
  const Json schema = json_schema(description().complete_type());
  expect_described(schema, document::json(description().of(example())));
  expect_described(schema, document::json(description().of({})));
  EXPECT_EQ(schema["properties"]["axes"]["items"]["properties"]["torque"]["unit"], "N m");
  EXPECT_EQ(schema["properties"]["first"]["type"], Json::array({"object", "null"}));
}

TEST(AnswerSchema, HasOneDefinitionForEachType) {
  const Json schema = json_schema(std::vector{description().complete_type()});
  EXPECT_EQ(schema["oneOf"][0]["$ref"], "#/$defs/example");
  EXPECT_TRUE(schema["$defs"]["example"].contains("properties"));
}

TEST(DataOnlyItem, IsInJsonAndItsSchemaButNotInText) {
  AnswerDescription<double> description{{.name = "example", .meaning = "an example"}, {}};
  description.items
      .value(in_data("travel", "distance from the start", "m"), [](double travel) { return travel; })
      .value(with_words(in_data("side", "side of the start"), {"left", "right"}),
             [](double travel) { return travel < 0.0 ? "left" : "right"; });
  const Answer answer = description.of(-0.5);
  EXPECT_EQ(json(answer)["travel"], -0.5);
  EXPECT_EQ(json(answer)["side"], "left");
  EXPECT_EQ(text(answer), "");
  const nlohmann::ordered_json properties = json_schema(answer.type)["properties"];
  EXPECT_EQ(properties["travel"]["description"], "distance from the start");
  EXPECT_EQ(properties["travel"]["unit"], "m");
  EXPECT_EQ(properties["side"]["enum"], nlohmann::ordered_json({"left", "right"}));
}

// Values of answers that read back to the same number.

template <class Number>
struct Holder {
  Number number;
};

template <class Number>
Answer answer_with(Number number) {
  AnswerDescription<Holder<Number>> description{{.name = "holder", .meaning = "a number"}, {}};
  description.items.value({.key = "number", .heading = "number"}, &Holder<Number>::number);
  return description.of({number});
}

template <class Number>
void expect_kept(Number number) {
  const Answer answer = answer_with(number);
  EXPECT_EQ(json(answer)["number"].get<Number>(), number);
  EXPECT_TRUE(says(text(answer), std::to_string(number)));
}

// A seed is any of 64 bits.
TEST(Values, WholeNumbersKeepAllTheirBits) {
  expect_kept(std::numeric_limits<std::uint64_t>::max());
  expect_kept(std::numeric_limits<std::int64_t>::min());
}

TEST(Values, UndefinedBoundsAreOmittedFromText) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(text(answer_with(Bounded{0.5, unknown, unknown})), "number: 0.5\n");
  EXPECT_EQ(text(answer_with(Bounded{0.5, unknown, 1.0})), "number: 0.5 [–, 1]\n");
  EXPECT_EQ(text(answer_with(Bounded{unknown, unknown, unknown})), "");
}

// An answer without a table in CSV has one line there: its values, and those of its objects.
TEST(Values, WithoutATableFormOneLineOfCsv) {
  using Inner = Holder<double>;
  AnswerDescription<Inner> description{{.name = "holder", .meaning = "a number"}, {}};
  description.items.value({.key = "number", .heading = "number"}, &Inner::number)
      .object({.key = "part", .heading = "part"},
              Description<Inner>().value({.key = "twice", .heading = "twice"},
                                         [](const Inner& inner) { return 2.0 * inner.number; }),
              [](const Inner& inner) { return inner; });
  EXPECT_EQ(csv(description.of({0.1})), "number,part_twice\n0.1,0.2\n");
}

// The schema lets be null what may be missing, and nothing else.
TEST(Values, AreNullableInTheSchemaIfTheirPartIsOptional) {
  using Part = Holder<double>;
  const auto part = Description<Part>().value({.key = "number", .heading = "number"}, &Part::number);
  const auto there = Description<Part>().include(part, [](const Part& whole) { return whole; });
  EXPECT_FALSE(there.items()[0].nullable);
  const auto missing = Description<Part>().include(part, [](const Part&) { return std::optional<Part>(); });
  EXPECT_TRUE(missing.items()[0].nullable);
  EXPECT_TRUE(missing.members_of({1.0}).contents[0].is_empty());
}

// Texts of several lines that are shown as they are, such as a part of a manifest.

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
  EXPECT_TRUE(says(markdown(answer), "```\n" + lines + "```\n"));
  EXPECT_TRUE(says(html(answer), "<pre>friction:\n  k1: 110   # &lt;b&gt;\n</pre>"));
}

struct Loop {
  std::string name;
  double rate;  // Hz
  double gain;
};

Answer answer_of(const std::vector<Loop>& loops) {
  AnswerDescription<std::vector<Loop>> description{
      {.name = "example", .meaning = "an example", .csv_table = "loops"}, {}};
  description.items.table({.key = "loops", .heading = "Loops", .common_above = true},
                          Description<Loop>()
                              .value({"name", "loop"}, &Loop::name)
                              .value({"rate", "sample rate", "", "Hz"}, &Loop::rate)
                              .value({"gain", "gain"}, &Loop::gain),
                          [](const std::vector<Loop>& all) { return all; });
  return description.of(loops);
}

TEST(CommonColumns, AColumnWithEqualValuesIsShownOnceAboveTheTable) {
  const std::string text = document::text(answer_of({{"a", 2000.0, 1.0}, {"b", 2000.0, 2.0}}));
  EXPECT_TRUE(text.starts_with("Loops:\nsample rate: 2000 Hz\n\nloop  gain\n")) << text;
}

TEST(CommonColumns, ASingleRowIsShownAsAList) {
  EXPECT_EQ(document::text(answer_of({{"a", 2000.0, 1.0}})),
            "Loops:\nloop:        a\nsample rate: 2000 Hz\ngain:        1\n");
}

TEST(CommonColumns, ATableWhoseRowsDifferKeepsAllItsColumns) {
  const std::string text = document::text(answer_of({{"a", 1.0, 1.0}, {"b", 2.0, 2.0}}));
  EXPECT_TRUE(text.starts_with("Loops:\n\nloop  sample rate (Hz)  gain\n")) << text;
}

TEST(CommonColumns, JsonAndCsvRepeatThemInEveryRow) {
  const Answer answer = answer_of({{"a", 2000.0, 1.0}, {"b", 2000.0, 2.0}});
  EXPECT_EQ(json(answer)["loops"][1]["rate"], 2000.0);
  EXPECT_EQ(csv(answer), "name,rate,gain\na,2000,1\nb,2000,2\n");
}

}  // namespace
}  // namespace zerocount::document
