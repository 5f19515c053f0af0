// What each audience of an answer is shown, from one description of a row.
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"

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
      .value({.key = "settling", .unit = "s", .shown = Shown::in_data},
             told("settling", [](const Gain& gain) { return gain.settling; }))
      .value({.heading = "settled (s)", .shown = Shown::to_people, .numeric = true},
             told("settled", [](const Gain& gain) { return gain.settling < 0.3 ? "0.25" : "> 0.3 s"; }));
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

}  // namespace
}  // namespace zerocount::document
