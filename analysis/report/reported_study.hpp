#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "analysis/summary/summary.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount {

/// A results file that is reported, with what all parts of the report need of it.
struct ReportedStudy {
  const StudyFile& file;
  Study study;
  StudySummary summary;
  std::vector<ConfidenceInterval> success_bounds{};  ///< 95 %, [point]
  std::string bounds_name{};                         ///< what kind of bounds these are
  std::int64_t focus{0};                             ///< design point whose trials are shown one by one
};

/// What is said beside results of a study whose trials are not independent (StudyFeatures::dependent_trials).
inline constexpr std::string_view dependence_sentence =
    "The trials of a saltelli design are not independent: those of a row share most of their draws.";
inline constexpr std::string_view too_narrow_sentence =
    "Bounds take trials for independent, and are too narrow here.";

/// Reads the file once from beginning to end. The focus is the best point.
/// @param file a complete study.
ReportedStudy reported_study(const StudyFile& file);

/// The point with the highest success rate, of those the one that settles fastest in the median; the first
/// where there are several, and in an open-loop study.
std::int64_t best_point(const std::vector<PointSummary>& points);

/// The point whose success rate is nearest to one half: where most is to be learnt about what makes trials
/// fail.
std::int64_t most_telling_point(const std::vector<PointSummary>& points);

/// The global rows of the trials of a point.
RowRange rows_of(const ReportedStudy& reported, std::int64_t point);

/// What one trial of a study was like, by its moves.
using TrialVisitor = std::function<void(std::int64_t row, std::span<const MoveOutcome> moves)>;

/// Visits the trials of these rows in order, reading the file in blocks.
void visit_trials(const StudyFile& file, RowRange rows, const TrialVisitor& visit);

/// At most `most` of `size` things, spread evenly over them: their indices, rising.
std::vector<std::int64_t> spread_over(std::int64_t size, std::int64_t most);

/// "controller.ki (N m/count)".
std::string axis_title(const SweepAxis& axis);

/// A proportion as a percentage, with as many digits as keep it apart from 100 %; only 1 is "100 %".
std::string proportion_text(double proportion);

}  // namespace zerocount
