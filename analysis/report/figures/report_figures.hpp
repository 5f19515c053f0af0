#pragma once

#include <optional>
#include <vector>

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/thinned_trace.hpp"
#include "analysis/report/reported_study.hpp"

/// The figures of a report. A figure is omitted if the study lacks its data.
namespace zerocount::report {

/// Gives each condition its colour, the same in all figures; without conditions the legend goes. @param
/// colour the channel, of names of conditions
void colour_conditions(nlohmann::ordered_json& colour, const ReportedStudy& reported);

/// Success per point with bounds and what is asked: over a swept number if there is one, otherwise a row per
/// point and condition. Several goals have a panel each. Nothing for an open-loop study.
std::optional<Figure> success_figure(const ReportedStudy& reported);

/// Success over two swept numbers, with the curves of the criteria (6) and (7): one map for each combination
/// of the other axes.
std::vector<Figure> stability_maps(const ReportedStudy& reported);

/// Distribution functions with bounds: of the times from which the error of the chosen point stays within
/// what each goal asks, under each condition, with the goals; without a goal, of the arrival at several
/// points, and of settling in each band.
std::vector<Figure> distribution_figures(const ReportedStudy& reported);

/// At the chosen point of a study with ages: the proportions of moves and machines in the goal at each, and
/// the lives of the machines as a survival curve.
std::vector<Figure> age_figures(const ReportedStudy& reported);

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
  std::string name;  ///< "median", "worst"
  std::int64_t point{0};
  std::int64_t index{0};
  std::int64_t buckets{400};  ///< resolution of its samples (see TraceThinner)
  std::string condition{};    ///< empty without conditions
};

/// The median and the worst trial of the chosen point under each condition, in order of goal::Badness. Empty
/// for an open-loop study.
std::vector<SampleTrial> sample_trials(const ReportedStudy& reported);

/// Errors of these trials over time with the goals, and the torque of the worst. @param replayed [trial]
Figure response_figure(const ReportedStudy& reported, const std::vector<SampleTrial>& trials,
                       const std::vector<ReplayedTrial>& replayed);

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
