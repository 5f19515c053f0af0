#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

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

TEST(CommonColumns, OfRowsThatAgreeStandOnceAboveTheTable) {
  const std::string text = document::text(answer_of({{"a", 2000.0, 1.0}, {"b", 2000.0, 2.0}}));
  EXPECT_TRUE(text.starts_with("Loops:\nsample rate: 2000 Hz\n\nloop  gain\n")) << text;
}

TEST(CommonColumns, OfASingleRowAreAll) {
  EXPECT_EQ(document::text(answer_of({{"a", 2000.0, 1.0}})),
            "Loops:\nloop:        a\nsample rate: 2000 Hz\ngain:        1\n");
}

TEST(CommonColumns, LeaveATableWhoseRowsDifferAsItIs) {
  const std::string text = document::text(answer_of({{"a", 1.0, 1.0}, {"b", 2.0, 2.0}}));
  EXPECT_TRUE(text.starts_with("Loops:\n\nloop  sample rate (Hz)  gain\n")) << text;
}

TEST(CommonColumns, AreInEachRowOfData) {
  const Answer answer = answer_of({{"a", 2000.0, 1.0}, {"b", 2000.0, 2.0}});
  EXPECT_EQ(json(answer)["loops"][1]["rate"], 2000.0);
  EXPECT_EQ(csv(answer), "name,rate,gain\na,2000,1\nb,2000,2\n");
}

}  // namespace
}  // namespace zerocount::document
