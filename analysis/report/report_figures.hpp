#pragma once

#include <optional>
#include <vector>

#include "analysis/report/figure.hpp"
#include "analysis/report/reported_study.hpp"
#include "analysis/report/thinned_trace.hpp"

/// The figures of a report. Each is there only where the study has what it shows.
namespace zerocount {

/// Success per point with bounds: along a swept number where there is one, otherwise a line per point.
std::optional<Figure> success_figure(const ReportedStudy& reported);

/// Success over two swept numbers with the curves of the criteria (6) and (7): one map for each combination
/// of the other axes.
std::vector<Figure> stability_maps(const ReportedStudy& reported);

/// Distribution functions of the settling time with bounds.
std::optional<Figure> settling_figure(const ReportedStudy& reported);

/// Jerks move by move, and their rate, at the point that has the most.
std::vector<Figure> jerk_figures(const ReportedStudy& reported);

/// Profiles along the rotor with the trials that failed, and the success by place.
std::vector<Figure> rotor_figures(const ReportedStudy& reported);

/// A trial of the study, and why it is shown.
struct SampleTrial {
  std::string name;   ///< "median", "worst", "first-failure"
  std::string title;  ///< plain text
  std::int64_t point{0};
  std::int64_t index{0};
  std::int64_t buckets{400};  ///< how finely its samples are kept (see TraceThinner)
};

/// The median, the worst and the first failing trial of the point in focus, without repetitions. Where no
/// trial failed there, the first failing trial is that of the whole study. Empty for an open-loop study.
std::vector<SampleTrial> sample_trials(const ReportedStudy& reported);

/// Error and torque of a trial over time.
Figure trace_figure(const ReportedStudy& reported, const SampleTrial& trial, const ReplayedTrial& replayed);

/// A figure of the paper that a study can show, from these trials.
struct PaperFigure {
  std::string name;                   ///< "paper-fig7"
  std::vector<SampleTrial> trials{};  ///< to be run again
};

/// The figures of the paper for which the study has what they show: Fig. 4 and 6 for torque levels, Fig. 7
/// for moves to different targets, Fig. 8 for one long move with jerks.
std::vector<PaperFigure> paper_figures(const ReportedStudy& reported);
Figure paper_figure(const PaperFigure& wanted, const std::vector<ReplayedTrial>& replayed);

}  // namespace zerocount
