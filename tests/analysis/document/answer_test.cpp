#include "analysis/document/answer.hpp"

#include <nlohmann/json.hpp>

#include "analysis/text/report_json.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

using Json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// An axis of a made-up answer.
struct Axis {
  std::string name;
  double torque{0.0};
  Bounded rate{0.5, 0.4, 0.6};
  double load{unknown};
};

/// An answer with every kind of item.
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
      .value({.key = "shown", .heading = "for people", .shown = Shown::to_people},
             [](const Axis&) { return "composed"; })
      .value({.key = "hidden", .heading = "for data", .shown = Shown::in_data},
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

TEST(Answer, WritesTheTextOfItsTreeInPieces) {
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
  EXPECT_NE(document::csv(description().of(subject)).find("\n\"a,\"\"b\"\"\nc\",0.3"), std::string::npos);
}

TEST(Answer, ShowsPeopleTheTitleTheUnitsAndNoColumnWithoutContent) {
  const std::string text = document::text(description().of(example()));
  EXPECT_TRUE(text.starts_with("the goal is met\n")) << text;
  EXPECT_NE(text.find("gains: controller.ki = 3e+04\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\naxes of the machine:\n\naxis  torque (N m)"), std::string::npos) << text;
  EXPECT_NE(text.find("50.0 % [40.0, 60.0]"), std::string::npos) << text;
  EXPECT_EQ(text.find("load"), std::string::npos) << text;
  EXPECT_EQ(text.find("for data"), std::string::npos) << text;
  EXPECT_EQ(text.find("delay"), std::string::npos) << text;
}

TEST(Answer, LeavesOutTablesWithoutRowsAndEmptySentences) {
  const std::string text = document::text(description().of({}));
  EXPECT_EQ(text.find("axes of the machine"), std::string::npos) << text;
  EXPECT_EQ(text, "the goal is met\ngains: controller.ki = 3e+04\nrates: 0.1, –\n");
}

TEST(Answer, LetsNoTextOfAManifestBecomeMarkup) {
  Subject subject = example();
  subject.axes[0].name = "<script>|`*_\x1b[31m";
  subject.headline = "<b>&";
  const Answer answer = description().of(subject);
  const std::string html = document::html(answer);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<b>"), std::string::npos);
  EXPECT_EQ(html.find('\x1b'), std::string::npos);
  const std::string markdown = document::markdown(answer);
  EXPECT_NE(markdown.find("\\<script>\\|\\`\\*\\_"), std::string::npos) << markdown;
  EXPECT_EQ(markdown.find('\x1b'), std::string::npos);
}

TEST(Answer, GivesEveryRowOfAMarkdownTableTheSameCells) {
  const std::string markdown = document::markdown(description().of(example()));
  EXPECT_NE(markdown.find("| axis | torque (N m) | rate | for people |\n| --- | ---: | ---: | --- |\n"
                          "| x | 0.3 | 50.0 % [40.0, 60.0] | composed |\n"),
            std::string::npos)
      << markdown;
}

/// The required keys of an object's schema are those of its JSON, and objects within likewise.
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

}  // namespace
}  // namespace zerocount::document
