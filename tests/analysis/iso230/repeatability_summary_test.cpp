#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/iso230/point_statistics.hpp"
#include "analysis/summary/summary.hpp"
#include "tests/analysis/iso230/sequence_studies.hpp"
#include "tests/analysis/summary_forms.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::iso230 {
namespace {

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The lines that begin with `label`, each as its words.
std::vector<std::vector<std::string>> rows_of(const std::string& text, const std::string& label) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : lines_in(text)) {
    if (line.rfind(label + " ", 0) != 0) continue;
    std::istringstream words(line);
    rows.emplace_back();
    for (std::string word; words >> word;) rows.back().push_back(word);
  }
  return rows;
}

/// The summary of trials that end so many counts from the middle of their target's count.
template <typename Offset>
summary::StudySummary summary_of(const study::Study& study, const Offset& offset) {
  std::vector<shards::TrialResult> results = testing::sequence_results(study);
  for (shards::TrialResult& result : results) {
    const trial::TrialParameters p =
        study::study_trial(study, result.row / study.trials, result.row % study.trials).parameters;
    for (std::size_t i = 0; i < study.sequence.size(); ++i) {
      const double counts = offset(study.sequence[i], result.row);
      const double place = static_cast<double>(p.command.targets[i]) + 0.5 + counts;
      trial::MoveOutcome& move = result.outcome.moves[i];
      move.final_position = (place - p.initial.encoder_phase) * 2.0 * std::numbers::pi / p.encoder.fine;
      move.final_error = -static_cast<std::int64_t>(std::floor(0.5 + counts));
    }
  }
  const testing::TemporaryFolder folder;
  testing::write_sequence_file(folder / "study.h5", study, results);
  return summary::summarise(reading::AllTrialsFile(folder / "study.h5"));
}

/// Every approach from above ends one count higher.
double one_count_of_reversal(const study::SequenceMove& move, std::int64_t) {
  return move.direction > 0 ? 0.0 : 1.0;
}

TEST(RepeatabilitySummary, TellsOfTheAxisInArcsecAndCounts) {
  const std::string text =
      testing::summary_text(summary_of(testing::sequence_study(), one_count_of_reversal));
  EXPECT_NE(text.find("\nrepeatability after ISO 230-2: 3 targets approached from both sides in 3 cycles:\n"),
            std::string::npos);
  const auto rows = rows_of(text, "fine");
  ASSERT_EQ(rows.size(),
            1U + 2U + 6U + 1U);  // the usual table, the axis, three targets, what is shown of all axes
  // A count is 0.8 arcsec: point, from, (unit), trials, then B, R↑, R↓, R, E, M, A as median (p95).
  const std::vector<std::string> truly(rows[1].begin() + 3, rows[1].begin() + 6);
  EXPECT_EQ(truly, (std::vector<std::string>{"80", "0.8", "(0.8)"}));
  EXPECT_EQ(rows[1][2], "(arcsec)");
  const std::vector<std::string> encoder(rows[2].begin() + 1, rows[2].begin() + 6);
  EXPECT_EQ(encoder, (std::vector<std::string>{"encoder", "(count)", "80", "1", "(1)"}));
}

TEST(RepeatabilitySummary, OfASequenceFromOneSideHasItsValuesOnly) {
  const study::Study study = testing::sequence_study("cycles: 2, approach: negative");
  const std::string text = testing::summary_text(summary_of(study, one_count_of_reversal));
  EXPECT_NE(text.find("3 targets approached from above in 2 cycles:\n"), std::string::npos);
  const auto heads = rows_of(text, "point");
  EXPECT_EQ(heads[2], (std::vector<std::string>{"point", "target", "from", "x̄↓", "R↓"}));
  EXPECT_NE(text.find("at most 3.7 % of axes do not"),  // 1 − 0.05^(1/80) = 0.0368
            std::string::npos)
      << text;
}

// Where R is not defined, no trial has it, and none has it at 0 either: that is not 0 trials of 80.
TEST(RepeatabilitySummary, OfASingleCycleCountsNoZeros) {
  const nlohmann::ordered_json json =
      testing::summary_json(summary_of(testing::sequence_study("cycles: 1"), one_count_of_reversal));
  const nlohmann::ordered_json& point = json["points"][0]["repeatability"];
  EXPECT_EQ(point["trials"], 80);
  for (const char* name : {"zero_repeatability", "zero_repeatability_rate"}) {
    EXPECT_TRUE(point.at(name).is_null()) << name;
  }
}

TEST(RepeatabilitySummary, DeviationsOfManyCountsAreShownInFull) {
  const auto far = [](const study::SequenceMove& move, std::int64_t row) {
    return move.target == 2 ? 12345.0 : static_cast<double>(row % 2) * 0.0;
  };
  const std::string text = testing::summary_text(summary_of(testing::sequence_study(), far));
  EXPECT_EQ(rows_of(text, "fine")[8][4], "12345");
}

TEST(RepeatabilitySummary, IsASectionOfTheJson) {
  const nlohmann::ordered_json json =
      testing::summary_json(summary_of(testing::sequence_study(), one_count_of_reversal));
  const auto& point = json["points"][0]["repeatability"];
  EXPECT_TRUE(point["trials"].is_number_integer());
  EXPECT_EQ(point["evaluated"], 80);
  EXPECT_EQ(point["zero_repeatability"], 0);
  EXPECT_EQ(point["true"]["unit"], "rad");
  EXPECT_NEAR(point["true"]["axis"]["reversal"]["median"].get<double>(), 2.0 * std::numbers::pi / 1620000.0,
              1e-15);
  EXPECT_EQ(point["encoder"]["axis"]["mean_reversal"]["max"], -1.0);
  EXPECT_EQ(point["encoder"]["targets"][2]["reversal"]["p95"], -1.0);
}

}  // namespace
}  // namespace zerocount::iso230
