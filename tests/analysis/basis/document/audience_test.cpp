// What each audience of an answer is shown, from one description of a row.
#include <nlohmann/json.hpp>

#include "analysis/basis/document/answer.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

struct Gain {
  double value;
  double settling;
};

struct Gains {
  std::vector<Gain> gains{{1.0, 0.25}, {2.0, 0.5}};
};

/// Description of an answer with gains, with which it is tested what is shown to whom.
/// @param computed gets the keys of the items that are computed
AnswerDescription<Gains> gains_answer(std::vector<std::string>& computed) {
  const auto told = [&computed](const char* key, auto get) {
    return [&computed, key, get](const Gain& gain) {
      computed.emplace_back(key);
      return get(gain);
    };
  };
  Description<Gain> columns;
  columns
      .value({.key = "axes", .shown = Visibility::in_json},
             told("axes",
                  [](const Gain& gain) {
                    using Value = std::variant<double, std::string>;
                    return std::vector<std::pair<std::string, Value>>{{"ki", gain.value}, {"case", "a"}};
                  }))
      .value({.key = "ki", .shown = Visibility::in_csv},
             told("ki", [](const Gain& gain) { return gain.value; }))
      .value({.key = "settling", .heading = "settled", .unit = "s", .numeric = true},
             told("settling", [](const Gain& gain) { return gain.settling; }))
      .shown_as(told("settled", [](const Gain& gain) { return gain.settling < 0.3 ? "0.25" : "> 0.3 s"; }));
  AnswerDescription<Gains> answer{{.name = "gains", .meaning = "gains", .csv_table = "gains"}, {}};
  answer.items.table({.key = "gains", .meaning = "a row a gain"}, columns, &Gains::gains);
  return answer;
}

TEST(Audience, EachAudienceGetsItsItemsFromOneDescription) {
  std::vector<std::string> computed;
  const Answer answer = gains_answer(computed).of(Gains{});
  EXPECT_EQ(json(answer)["gains"][1].dump(), R"({"axes":{"ki":2.0,"case":"a"},"settling":0.5})");
  EXPECT_EQ(csv(answer), "ki,settling\n1,0.25\n2,0.5\n");
  EXPECT_EQ(text(answer), "settled (s)\n───────────\n       0.25\n    > 0.3 s\n");
  EXPECT_EQ(json_schema(answer.type)["properties"]["gains"]["items"]["properties"]["axes"].dump(),
            R"({"type":"object","additionalProperties":{"type":["number","string","null"]}})");
}

TEST(Audience, ItemsForOtherAudiencesAreNotComputed) {
  for (const auto& [audience, keys] :
       std::vector<std::pair<Audience, std::vector<std::string>>>{{Audience::json, {"axes", "settling"}},
                                                                  {Audience::csv, {"ki", "settling"}},
                                                                  {Audience::people, {"settled"}}}) {
    std::vector<std::string> computed;
    Gains one;
    one.gains.resize(1);
    gains_answer(computed).of(one, ExitCode::success, audience);
    EXPECT_EQ(computed, keys);
  }
}

// People find the members of an object without heading among the columns of its row, in data it is an object.
TEST(Audience, TextShowsObjectsAsColumnsOrAsTables) {
  const auto same = [](const Gain& gain) -> const Gain& { return gain; };
  Description<Gain> goal, speed, gain, when;
  goal.value({.key = "rate", .heading = "in goal", .unit = "1", .notation = Notation::percent},
             [](const Gain& g) { return g.settling; });
  when.value({.key = "s", .heading = "when", .unit = "s"}, [](const Gain& g) { return g.settling; });
  speed.value({.key = "of", .heading = "speed"}, [](const Gain& g) { return 1.0 / g.settling; })
      .value({.key = "unit", .meaning = "its unit"}, [](const Gain&) { return "1/s"; })
      .sentence([](const Gain& g) { return g.value > 1.0 ? "it is slow" : ""; });
  gain.value({.key = "ki", .heading = "ki"}, [](const Gain& g) { return g.value; })
      .value({.key = "label", .heading = "gain", .names_row = true},
             [](const Gain& g) { return g.value > 1.0 ? "high" : "low"; })
      .object({.key = "speed", .own_table = "speeds", .note = "of settling"}, speed, same)
      .table({.key = "times", .shown = Visibility::not_in_csv, .own_table = "times"}, when,
             [](const Gain& g) {
               return std::vector{g, Gain{0.0, 3.0}};
             })
      .object({.key = "goal"}, goal, same);
  AnswerDescription<Gains> answer{{.name = "gains", .meaning = "gains", .csv_table = "gains"}, {}};
  answer.items.table({.key = "gains", .heading = "gains"}, gain, &Gains::gains);
  const Answer given = answer.of(Gains{});
  EXPECT_EQ(
      text(given),
      "gains:\n\nki  in goal\n──  ───────\n 1   25.0 %\n 2   50.0 %\n\n"
      "speeds:\n\ngain  speed\n────  ─────\nlow       4\nhigh      2\n\nhigh: it is slow\nof settling\n\n"
      "times:\n\ngain  when (s)\n────  ────────\nlow       0.25\nlow          3\nhigh       0.5\n"
      "high         3\n");
  EXPECT_EQ(json(given)["gains"][0].dump(),
            R"({"ki":1.0,"label":"low","speed":{"of":4.0,"unit":"1/s"},"times":[{"s":0.25},{"s":3.0}],)"
            R"("goal":{"rate":0.25}})");
  EXPECT_EQ(csv(given), "ki,label,speed_of,speed_unit,goal_rate\n1,low,4,1/s,0.25\n2,high,2,1/s,0.5\n");
  Gains one;
  one.gains.resize(1);
  EXPECT_EQ(
      text(answer.of(one, ExitCode::success, Audience::people)),
      "gains:\n\nki  in goal\n──  ───────\n 1   25.0 %\n\nspeeds:\n\nspeed\n─────\n    4\n\nof settling\n\n"
      "times:\n\nwhen (s)\n────────\n    0.25\n       3\n");
}

// Columns of CSV have the names of their objects before them, or one of their own.
TEST(Csv, NumbersAreUnroundedAndColumnsAreNamed) {
  Description<Gain> goal, gain;
  goal.value({.key = "rate", .unit = "1"},
             [](const Gain& g) {
               return Bounded{g.settling, 0.0, 1.0};
             })
      .value({.key = "hold", .unit = "s", .column = "hold_at_least"}, [](const Gain& g) { return g.value; });
  gain.value({.key = "trials", .shown = Visibility::in_csv},
             [](const Gain& g) { return static_cast<int>(g.value); })
      .object({.key = "goal"}, goal, [](const Gain& g) { return g.value > 1.0 ? &g : nullptr; });
  AnswerDescription<Gains> answer{{.name = "gains", .meaning = "gains", .csv_table = "gains"}, {}};
  answer.items.table({.key = "gains"}, gain, &Gains::gains);
  EXPECT_EQ(csv(answer.of(Gains{})),
            "trials,goal_rate,goal_rate_low,goal_rate_high,hold_at_least\n1,nan,nan,nan,nan\n2,0.5,0,1,2\n");
  const std::vector<std::pair<std::string, std::string>> cells =
      csv_cells(gain.items()[1], gain.content_of(1)({2.0, 0.5}, Audience::csv));
  ASSERT_EQ(cells.size(), 4U);
  EXPECT_EQ(cells.back(), (std::pair<std::string, std::string>{"hold_at_least", "2"}));
}

// Sections of an answer, and tables inside their rows.

struct Rate {
  double from;
  std::optional<Bounded> rate;
};

struct Point {
  std::string label;
  std::vector<Rate> rates;
};

struct Report {
  std::vector<Point> points;
};

AnswerDescription<Report> report_description() {
  const auto rates = Description<Rate>()
                         .value({.key = "from", .heading = "from", .unit = "s"}, &Rate::from)
                         .value({.key = "rate", .heading = "rate", .unit = "1/s"}, &Rate::rate);
  const auto points = Description<Point>()
                          .title(&Point::label)
                          .value(in_data("label", "label of the point"), &Point::label)
                          .value({.key = "advice", .heading = "advice", .shown = Visibility::in_json},
                                 [](const Point&) { return "more trials"; })
                          .table({.key = "rates", .heading = "rates"}, rates, &Point::rates);
  AnswerDescription<Report> answer{{.name = "report", .meaning = "points", .csv_table = "points.rates"}, {}};
  answer.items.headline([](const Report& report) { return std::to_string(report.points.size()) + " points"; })
      .sections({.key = "points", .meaning = "the points"}, points, &Report::points);
  return answer;
}

const Report two_points{
    {{"low", {{0.5, Bounded{2.0, 1.0, 4.0}}, {1.0, {}}}}, {"b, high", {{0.25, Bounded{3.0, 2.0, 5.0}}}}}};

TEST(Sections, TextPlacesThemOneBelowTheOther) {
  const std::string text = document::text(report_description().of(two_points));
  EXPECT_EQ(text.find("2 points"), 0U);
  EXPECT_LT(text.find("low:"), text.find("2 [1, 4]")) << text;
  EXPECT_LT(text.find("2 [1, 4]"), text.find("b, high:")) << text;
  EXPECT_LT(text.find("b, high:"), text.find("3 [2, 5]")) << text;
  EXPECT_FALSE(says(text, "more trials"));
}

TEST(Sections, AreAListOfObjectsInJson) {
  const auto json = document::json(report_description().of(two_points));
  ASSERT_EQ(json["points"].size(), 2U);
  EXPECT_EQ(json["points"][1]["label"], "b, high");
  EXPECT_EQ(json["points"][1]["advice"], "more trials");
  EXPECT_EQ(json["points"][0]["rates"][0]["rate_high"], 4.0);
  EXPECT_TRUE(json["points"][0]["rates"][1]["rate"].is_null());
  const auto schema = json_schema(report_description().complete_type());
  EXPECT_EQ(schema["properties"]["points"]["items"]["properties"]["rates"]["type"], "array");
}

TEST(Sections, CsvRepeatsTheirValuesInEachLineOfTheirTable) {
  EXPECT_EQ(csv(report_description().of(two_points)),
            "label,from,rate,rate_low,rate_high\n"
            "low,0.5,2,1,4\n"
            "low,1,nan,nan,nan\n"
            "\"b, high\",0.25,3,2,5\n");
}

// Names that users give cannot become commands of a spreadsheet, links or layout.

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

TEST(Escaping, CsvTextIsNeverASpreadsheetFormula) {
  EXPECT_EQ(csv(named_answer("=cmd|' /C calc'!A0")), "name\n'=cmd|' /C calc'!A0\n");
  EXPECT_EQ(csv(named_answer("@SUM(1,2)")), "name\n\"'@SUM(1,2)\"\n");
  EXPECT_EQ(csv(named_answer("+1+1")), "name\n'+1+1\n");
  EXPECT_EQ(csv(named_answer("-3")), "name\n-3\n");
}

TEST(Escaping, ACsvAnswerOfOneValueIsNeverASpreadsheetFormula) {
  AnswerDescription<NamedRow> description{{.name = "holder", .meaning = "a name"}, {}};
  description.items.value({.key = "name", .heading = "name"}, &NamedRow::name);
  EXPECT_EQ(csv(description.of({"=1+1"})), "name\n'=1+1\n");
}

TEST(Escaping, NamesDoNotBecomeLinksInMarkdown) {
  const std::string link = markdown(named_answer("[x](javascript:alert(2))"));
  EXPECT_EQ(link.find("]("),
            link.find("\\](") == std::string::npos ? std::string::npos : link.find("\\](") + 1);
  EXPECT_TRUE(says(link, "[x\\](javascript:alert(2))"));
  EXPECT_TRUE(says(markdown(named_answer("[x]: javascript:alert(2)")), "[x\\]: "));
  EXPECT_TRUE(says(markdown(named_answer("[x][y]")), "[x\\][y]"));
  // Brackets of bounds stay as they are.
  EXPECT_TRUE(says(markdown(named_answer("90 [87, 95] %")), "90 [87, 95] %"));
}

TEST(Escaping, NamesDoNotBecomeMarkupInMarkdown) {
  EXPECT_FALSE(says(markdown(named_answer("# a")), "\n# a"));
  for (const char* const name : {"# a", "- a", "+ a", "> a", "1. a", "12) a", "=== a", "---"}) {
    const std::string text = markdown(named_answer(name));
    EXPECT_FALSE(says(text, std::string("\n") + name));
  }
  EXPECT_TRUE(says(markdown(named_answer("a|b <i> `c` *d* _e_ ~f~ &lt;")),
                   "a\\|b \\<i> \\`c\\` \\*d\\* \\_e\\_ \\~f\\~ \\&lt;"));
  // The block of lines ends where its lines end.
  EXPECT_TRUE(says(markdown(named_answer("a", "x\n```\n# y\n")), "````\nx\n```\n# y\n````\n"));
}

}  // namespace
}  // namespace zerocount::document
