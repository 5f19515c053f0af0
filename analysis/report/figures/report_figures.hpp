#pragma once

#include <optional>
#include <vector>

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/thinned_trace.hpp"
#include "analysis/report/reported_study.hpp"

/// The figures of a report. A figure is omitted if the study lacks its data.
namespace zerocount::report {

/// Success per point with bounds: over a swept number if there is one, otherwise one line per point. Several
/// goals have a figure each, and points a line under each condition.
std::vector<Figure> success_figures(const ReportedStudy& reported);

/// Success over two swept numbers, with the curves of the criteria (6) and (7): one map for each combination
/// of the other axes.
std::vector<Figure> stability_maps(const ReportedStudy& reported);

/// Distribution functions with bounds: of the arrival at several points, and of the times from which the
/// error of the chosen point stays within each band.
std::vector<Figure> distribution_figures(const ReportedStudy& reported);

/// At the chosen point of a study with worlds: the times of settling in each, and the rates over each
/// parameter that differs between them (at most six).
std::vector<Figure> world_figures(const ReportedStudy& reported);

/// Jerks of single moves, and the rate of jerks, at the point with the most jerks.
std::vector<Figure> jerk_figures(const ReportedStudy& reported);

/// Profiles along the rotor with the failed trials, and the success rate by position.
std::vector<Figure> rotor_figures(const ReportedStudy& reported);

/// Bode plot of the open loops of trial 0 of the chosen point (theory::trial_loops).
std::optional<Figure> bode_figure(const ReportedStudy& reported);

/// A shown trial of the study.
struct SampleTrial {
  std::string name;   ///< "median", "worst", "first-failure"
  std::string title;  ///< plain text
  std::int64_t point{0};
  std::int64_t index{0};
  std::int64_t buckets{400};  ///< resolution of its samples (see TraceThinner)
};

/// The median, the worst and the first failed trial of the chosen point, without repetitions. If no trial
/// failed there, the first failed trial of the study. Empty for an open-loop study.
std::vector<SampleTrial> sample_trials(const ReportedStudy& reported);

/// Error and torque of a trial over time.
Figure trace_figure(const ReportedStudy& reported, const SampleTrial& trial, const ReplayedTrial& replayed);

/// A figure of the paper that the study can reproduce from some trials.
struct PaperFigure {
  std::string name;                   ///< "paper-fig7"
  std::vector<SampleTrial> trials{};  ///< to be simulated again
};

/// The figures of the paper that the study can reproduce: Fig. 4 and 6 for torque levels, Fig. 7 for moves to
/// different targets, Fig. 8 for one long move with jerks.
std::vector<PaperFigure> paper_figures(const ReportedStudy& reported);
Figure paper_figure(const ReportedStudy& reported, const PaperFigure& wanted,
                    const std::vector<ReplayedTrial>& replayed);

}  // namespace zerocount::report
