#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

TEST(ItemInData, IsInJsonAndItsSchemaAndNotShownToPeople) {
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

}  // namespace
}  // namespace zerocount::document
