// What each audience of an answer is shown, from one description of a row.
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
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
      .value({.key = "axes", .shown = Shown::in_json},
             told("axes",
                  [](const Gain& gain) {
                    using Value = std::variant<double, std::string>;
                    return std::vector<std::pair<std::string, Value>>{{"ki", gain.value}, {"case", "a"}};
                  }))
      .value({.key = "ki", .shown = Shown::in_csv}, told("ki", [](const Gain& gain) { return gain.value; }))
      .value({.key = "settling", .heading = "settled", .unit = "s", .numeric = true},
             told("settling", [](const Gain& gain) { return gain.settling; }))
      .shown_as(told("settled", [](const Gain& gain) { return gain.settling < 0.3 ? "0.25" : "> 0.3 s"; }));
  AnswerDescription<Gains> answer{{.name = "gains", .meaning = "gains", .csv_table = "gains"}, {}};
  answer.items.table({.key = "gains", .meaning = "a row a gain"}, columns, &Gains::gains);
  return answer;
}

TEST(Audience, IsShownItsItemsOfOneDescription) {
  std::vector<std::string> computed;
  const Answer answer = gains_answer(computed).of(Gains{});
  EXPECT_EQ(json(answer)["gains"][1].dump(), R"({"axes":{"ki":2.0,"case":"a"},"settling":0.5})");
  EXPECT_EQ(csv(answer), "ki,settling\n1,0.25\n2,0.5\n");
  EXPECT_EQ(text(answer), "settled (s)\n───────────\n       0.25\n    > 0.3 s\n");
  EXPECT_EQ(json_schema(answer.type)["properties"]["gains"]["items"]["properties"]["axes"].dump(),
            R"({"type":"object","additionalProperties":{"type":["number","string","null"]}})");
}

TEST(Audience, WhatItIsNotShownIsNotComputed) {
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
TEST(Audience, PeopleAreShownObjectsAsColumnsOrInTheirOwnTables) {
  using Of = const Gain&;
  const auto same = [](Of gain) -> const Gain& { return gain; };
  Description<Gain> goal, speed, gain, when;
  goal.value({.key = "rate", .heading = "in goal", .unit = "1", .notation = Notation::percent},
             [](Of g) { return g.settling; });
  when.value({.key = "s", .heading = "when", .unit = "s"}, [](Of g) { return g.settling; });
  speed.value({.key = "of", .heading = "speed"}, [](Of g) { return 1.0 / g.settling; })
      .value({.key = "unit", .meaning = "its unit"}, [](Of) { return "1/s"; })
      .sentence([](Of g) { return g.value > 1.0 ? "it is slow" : ""; });
  gain.value({.key = "ki", .heading = "ki"}, [](Of g) { return g.value; })
      .value({.key = "label", .heading = "gain", .names_row = true},
             [](Of g) { return g.value > 1.0 ? "high" : "low"; })
      .object({.key = "speed", .own_table = "speeds", .note = "of settling"}, speed, same)
      .table({.key = "times", .shown = Shown::not_in_csv, .own_table = "times"}, when,
             [](Of g) {
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
TEST(Csv, HasWholeNumbersAndTheNamesOfColumns) {
  Description<Gain> goal, gain;
  goal.value({.key = "rate", .unit = "1"},
             [](const Gain& g) {
               return Bounded{g.settling, 0.0, 1.0};
             })
      .value({.key = "hold", .unit = "s", .column = "hold_at_least"}, [](const Gain& g) { return g.value; });
  gain.value({.key = "trials", .shown = Shown::in_csv},
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

}  // namespace
}  // namespace zerocount::document
