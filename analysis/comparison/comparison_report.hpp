#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/comparison/comparison.hpp"
#include "analysis/document/answer.hpp"

/// A comparison as text for people and for machines.
namespace zerocount::comparison {

/// Judgements with this verdict of the gate.
std::int64_t count(const StudyComparison& comparison, GateVerdict verdict);
/// Measures that have changed so.
std::int64_t count(const StudyComparison& comparison, ChangeVerdict change);

/// Judgements that have enough values.
std::int64_t judged(const StudyComparison& comparison);

/// The verdict in a sentence.
std::string verdict_sentence(const StudyComparison& comparison);

/// The smallest changes for the worse that the trials find with decision_probability, of each measure over
/// the points: "Detectable changes: success_rate 3.4 % to 6.7 %, ...". Empty where nothing was measured.
std::string detectable_sentence(const StudyComparison& comparison);

/// A value of a measure or requirement with its unit: proportions in per cent.
std::string value_text(double value, std::string_view quantity, std::string_view unit);

/// A number of trials to two digits, rounded up.
std::string trials_text(double trials);

/// The answer of `compare`. A long table shows only the noteworthy rows to people, with the number of the
/// others.
document::AnswerDescription<StudyComparison> comparison_answer();

/// JUnit XML: a test suite with one case per point and measure or requirement. What fails the gate is a
/// failure, an inconclusive verdict an error, and a measure without values is skipped.
std::string comparison_junit(const StudyComparison& comparison);

}  // namespace zerocount::comparison
