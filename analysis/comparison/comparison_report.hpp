#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "analysis/document/answer.hpp"

/// A comparison as text for people and for machines.
namespace zerocount::comparison {

/// "passed", "regression", "changed", "inconclusive" or "not measured".
std::string_view to_string(GateVerdict verdict);

/// "worse", "better", "equivalent", "not worse", "undecided" or "not measured".
std::string_view to_string(ChangeVerdict change);

/// "bits", "paired" or "two_samples".
std::string_view to_string(ComparisonLayer layer);

/// Measures and requirements by their verdicts, and measures by their change.
struct VerdictCounts {
  std::int64_t passed{0};
  std::int64_t regressions{0};
  std::int64_t changed{0};
  std::int64_t inconclusive{0};
  std::int64_t not_measured{0};
  std::int64_t worse{0};
  std::int64_t better{0};
  std::int64_t equivalent{0};
  std::int64_t not_worse{0};
  std::int64_t undecided{0};

  std::int64_t judged() const { return passed + regressions + changed + inconclusive; }
  std::int64_t failed() const { return regressions + changed; }
};

VerdictCounts count_verdicts(const StudyComparison& comparison);

/// The verdict in a sentence.
std::string verdict_sentence(const StudyComparison& comparison);

/// The smallest changes for the worse that the trials find with decision_probability, of each measure over
/// the points: "Detectable changes: success_rate 3.4 % to 6.7 %, ...". Empty where nothing was measured.
std::string detectable_sentence(const StudyComparison& comparison);

/// A value of a measure or requirement with its unit: proportions in per cent.
std::string value_text(double value, std::string_view quantity, std::string_view unit);

/// The adjusted p against the change that is shown: for the better if the measure is better, otherwise for
/// the worse.
double shown_p(const MeasureComparison& measure);

/// A number of trials to two digits, rounded up.
std::string trials_text(double trials);

/// The answer of `compare`. A long table shows only the noteworthy rows to people, with the number of the
/// others.
document::AnswerDescription<StudyComparison> comparison_answer();

/// JUnit XML: a test suite with one case per point and measure or requirement. What fails the gate is a
/// failure, an inconclusive verdict an error, and a measure without values is skipped.
std::string comparison_junit(const StudyComparison& comparison);

/// One judgement as the cells of a table.
struct ComparisonRow {
  std::string point;
  std::string measure;
  std::string baseline;
  std::string current;
  std::string worse_by;  ///< the effect
  std::string bounds;
  std::string margin;   ///< or the limit of a requirement
  std::string detects;  ///< smallest detectable change
  std::string p;        ///< adjusted
  std::string verdict;  ///< the change of a measure; the gate's verdict on a requirement
  GateVerdict gate{GateVerdict::not_measured};
  std::string note;
  bool noteworthy{false};  ///< it did not simply pass
};

/// The measures and requirements of all points, in order.
std::vector<ComparisonRow> comparison_rows(const StudyComparison& comparison);

}  // namespace zerocount::comparison
