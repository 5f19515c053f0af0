#pragma once

#include <cstddef>
#include <limits>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/document/figure.hpp"
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/history/series.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/trials/sensitivity/sensitivity.hpp"

namespace zerocount::experiment_design {
struct ExperimentDesign;
}

namespace zerocount::fit {
struct FittedRecord;
struct Identification;
struct RecordSummary;
}  // namespace zerocount::fit

/// Answers of other commands, completed with figures for an HTML page.
namespace zerocount::report {

/// comparison::comparison_answer() with a figure of the changes of all measures relative to their margins,
/// and one of the success rate or the goal at each design point.
document::AnswerDescription<comparison::StudyComparison> comparison_answer();

/// sensitivity::sensitivity_answer() with a figure of the Sobol' indices for each output.
document::AnswerDescription<sensitivity::StudySensitivity> sensitivity_answer();

/// history::history_answer() with a figure for each series of results over time, at most `max_figures`.
/// Series that changed come first. The caption of the first figure says how many series have no figure.
document::AnswerDescription<history::History> history_answer(std::size_t max_figures = 48);

/// Figure of a designed experiment: its torque over time, and the encoder readings that the median machine
/// would give.
document::Figure experiment_figure(const experiment_design::ExperimentDesign& design);

/// Figures for each measured record of an identification: the readings and the fit over time, the residuals
/// over time with the band of rounding and noise, and the torque over the measured and the fitted angle.
std::vector<Figure> identification_figures(const fit::Identification& identification);

/// The samples of a record that a figure needs. The record is divided into at most `buckets` groups of equal
/// length, and each group into masked and unmasked parts. Kept are the first and the last sample of each
/// part, and those with the extreme torque, reading, fitted value and residual.
std::vector<std::size_t> drawn_samples(const fit::FittedRecord& record, std::size_t buckets);

/// Standard deviation of the noise of a record's readings, in their unit. For readings that are not counts it
/// comes from the differences of successive residuals, to which slow deviations of the model contribute
/// little: σ² is half the mean square of the differences (von Neumann et al., Ann. Math. Statist. 12 (1941)
/// 153).
double reading_noise(const fit::RecordSummary& record, const fit::FittedRecord& fit);

/// Half the width of the band in which the residuals lie because of rounding and noise, in the record's unit:
/// half a count for counts, plus 1.96 standard deviations of the noise.
double residual_band(const fit::RecordSummary& record, const fit::FittedRecord& fit);

}  // namespace zerocount::report
