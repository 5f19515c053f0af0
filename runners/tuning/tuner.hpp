#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "experiments/study/study.hpp"
#include "runners/tuning/answer_details.hpp"
#include "runners/tuning/limits.hpp"
#include "runners/tuning/loop_examiner.hpp"
#include "runners/tuning/nearest_point.hpp"
#include "runners/tuning/race/frontier.hpp"
#include "runners/tuning/tune_plan.hpp"
#include "runners/tuning/tuning_map.hpp"
#include "runners/tuning/worst_machines.hpp"

namespace zerocount::tuning {

struct TuneAnswer;

struct TuneSettings {
  std::filesystem::path output;  ///< the results file of the proof
  TuneBudget budget{};
  int threads{0};
  bool quiet{false};
  bool maps{false};   ///< simulate the maps too
  bool force{false};  ///< replace the output, and unfinished runs of other studies
  std::function<void(const TuneAnswer&)> proven{};  ///< called with what is proven, before the rest is found
};

/// Trials of the tuned study on machines that the search never saw.
struct Proof {
  study::Study study;
  goal::Verdict verdict;               ///< its confidence allows for all attempts
  std::optional<goal::Needs> needs{};  ///< that would decide an undecided one
  int attempts{1};                     ///< candidates or sizes that were proven, this one included
};

/// A simpler or another control at its own best values.
struct Alternative {
  std::string name;  ///< "controller.kd = 0", "observer added"
  std::vector<std::pair<std::string, double>> fixed;
  std::vector<std::pair<std::string, double>> gains;  ///< empty if none keeps the margins
  std::optional<goal::Verdict> verdict{};             ///< on machines that the search for it never saw
  double criterion{0.0};                              ///< on these machines
  std::optional<std::string> worst_goal{}, worst_condition{};  ///< of several goals, and with conditions
};

/// The result of tuning.
struct TuneAnswer {
  goal::Status status{goal::Status::undecided};
  std::vector<study::FreeParameter> free;
  Values gains;                            ///< empty if no candidate keeps the margins
  std::optional<SmallestMargins> margins;  ///< of the gains
  bool blind{false};                       ///< the loop has no transfer function: no margins
  std::optional<NearestPoint> nearest;     ///< where no candidate keeps them
  std::optional<Proof> proof;
  double criterion{0.0};  ///< by the proof
  /// Quantile study::Goal::moves of the criterion's values of the worst goal, under its worst condition.
  double late_limit{0.0};
  std::optional<DelayLost> delay_lost;  ///< controller.delay from which on a goal seems to be lost
  bool delay_sought{false};             ///< whether up to 5 samples more were tried
  double delay{0.0};                    ///< controller.delay of the tuned study
  std::vector<std::string> at_edges;    ///< free parameters at an end of their range, "controller.ki = 5000"
  std::vector<Room> room;
  std::vector<Alternative> alternatives;
  std::vector<Limit> limits;
  std::vector<TriedPoint> tried;     ///< by the search
  std::vector<TriedPoint> frontier;  ///< between success and speed, by the search
  std::vector<TuningMap> maps;
  /// Of the worst goal by the proof with a band one count wider, where it is not met.
  std::optional<double> wider_band_rate;
  std::optional<WorstMachine> worst;  ///< of the proof
  std::int64_t examined{0};           ///< points whose margins were examined
  std::int64_t points{0};             ///< that were simulated
  std::int64_t trials{0};             ///< of the search, and of those for other controls
  bool converged{false};
  double seconds{0.0};
  TuneBudget budget{};
  std::int64_t spent_trials{0};       ///< of all: search, proof, and what follows
  std::vector<std::string> left_out;  ///< parts of the answer for which the budget was not enough
};

/// Tunes the study. An interrupted tuning goes on where it was when it is called again.
/// @throws Failure: bad_input if the study cannot be tuned, the output exists, or the budget has too few
/// trials; inconclusive if it has too little time; interrupted
TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop);

}  // namespace zerocount::tuning
