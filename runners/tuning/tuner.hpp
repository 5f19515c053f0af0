#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/claims_of_point.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/ages/lost_ages.hpp"
#include "runners/tuning/ages/retuning.hpp"
#include "runners/tuning/answer_details.hpp"
#include "runners/tuning/behaviour.hpp"
#include "runners/tuning/effects/limits.hpp"
#include "runners/tuning/effects/robustness.hpp"
#include "runners/tuning/race/frontier.hpp"
#include "runners/tuning/race/landscape.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/search/nearest_point.hpp"
#include "runners/tuning/tune_plan.hpp"
#include "runners/tuning/tuning_map.hpp"
#include "runners/tuning/units/loop_examiner.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

namespace zerocount::tuning {

struct TuneAnswer;

/// What follows the proof, in the order of what it tells.
enum class Extra {
  margins,     ///< what more delay loses; of a goal that is missed, what a wider band would change
  ages,        ///< at which each claim is lost, of a study with ages
  room,        ///< of each free parameter
  robustness,  ///< with other seeds, spreads and delays
  retuning,    ///< gains per interval of a life, with TuneSettings::retune_every
  controls,    ///< others, each at its own best values
  limits,      ///< what stands between the values and the goal
  maps         ///< over pairs of free parameters, for a page
};
inline constexpr std::array all_extras{Extra::margins,  Extra::ages,     Extra::room,   Extra::robustness,
                                       Extra::retuning, Extra::controls, Extra::limits, Extra::maps};

/// "margins", "room", …
std::string_view name_of(Extra extra);
std::optional<Extra> extra_named(std::string_view name);

struct TuneSettings {
  std::filesystem::path output;  ///< the results file of the proof
  TuneBudget budget{};
  int threads{0};
  bool quiet{false};
  bool page{false};  ///< a page is written afterwards, for which some of the time is kept
  std::vector<Extra> extras{};
  std::optional<double> retune_every{};  ///< in the unit of the study's ages
  bool force{false};                     ///< replace the output, and unfinished runs of other studies
  status::Listener listener{};
  std::function<void(const SearchProgress&)> searching{};  ///< called after each generation of the search
  /// Called before the proof, with what the values that are to be proven do.
  std::function<void(const TuneAnswer&)> found{};
  std::function<void(const TuneAnswer&)> proven{};        ///< called when the proof stands, before the extras
  std::function<void(Extra, const TuneAnswer&)> ready{};  ///< called after each extra
};

/// Trials of the tuned study on machines that the search never saw.
struct Proof {
  study::Study study;
  goal::Verdict verdict;               ///< its confidence allows for all attempts
  std::optional<goal::Needs> needs{};  ///< that would decide an undecided one
  int attempts{1};                     ///< candidates or sizes that were proven, this one included
  /// Each goal under each condition, with bounds that allow for all attempts.
  std::vector<summary::ClaimOfPoint> claims{};
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
  std::optional<double> lowest_mode;       ///< of a load, that the loops bear (LoopExaminer::lowest_mode), Hz
  bool blind{false};                       ///< the loop has no transfer function: no margins
  std::optional<NearestPoint> nearest;     ///< where no candidate keeps them
  std::string refusal{};                   ///< why no point at all was allowed; empty if any was
  std::optional<Proof> proof;
  double criterion{0.0};  ///< by the proof
  /// Quantile study::Goal::moves of the criterion's values of the worst goal, under its worst condition.
  double late_limit{0.0};
  std::vector<summary::MoveBehaviour>
      behaviour;                        ///< of the proof's moves; before the proof of the search's machines
  std::vector<Refusal> refusals;        ///< what an engineer would refuse of it
  std::optional<DelayLost> delay_lost;  ///< from which on a goal seems to be lost
  bool delay_sought{false};             ///< whether up to 5 samples more were tried
  std::vector<double> delays;           ///< [condition] controller.delay of the tuned study, samples
  std::vector<std::string> at_edges;    ///< free parameters at an end of their range, "controller.ki = 5000"
  std::optional<LostAges> lost_ages;    ///< of a study with ages
  std::vector<Room> room;
  std::vector<Variation> robustness;
  std::optional<Retuning> retuning;  ///< with TuneSettings::retune_every
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
  MissedSearch missed{};               ///< decides the status of a goal that the proof misses
  std::vector<std::string> obstacles;  ///< what keeps the tuned axis from a goal that is not met, in theory
  double seconds{0.0};
  TuneBudget budget{};
  std::int64_t spent_trials{0};       ///< of all: search, proof, and what follows
  std::vector<std::string> left_out;  ///< parts of the answer for which the budget was not enough
  std::vector<Extra> left_extras;     ///< extras among them
  bool interrupted{false};  ///< after the proof: the extras that are left out wait for the same command
  std::optional<double>
      default_seconds{};  ///< that the search may take without a budget, as measured here, s
};

/// Tunes the study. An interrupted tuning goes on where it was when it is called again. Interrupted after the
/// proof, it returns what it has.
///
///     search: half of the budget; found: what the best values do
///     prove them on fresh machines: FILE is complete, proven(answer)
///     for each extra: ready(extra, answer)
///
/// @throws Failure: bad_input if the study cannot be tuned, the output exists, or the budget has too few
/// trials; inconclusive if it has too little time; interrupted before the proof
TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop);

/// Makes the extras for the values that TuneSettings::output, the results file of a proof, has. Its bounds do
/// not allow for the attempts of the tuning; its margins are those of margins_in().
/// @param study of the file
/// @throws Failure as tune()
TuneAnswer describe_tuned(const study::Study& study, const TuneSettings& settings,
                          const std::stop_token& stop);

/// The margins of the values that the file's study has, on its machines, and nothing else of the answer:
/// those of a proof are others than the search's, and their worst may keep a little less.
/// @param file of a study with one point and a section tune
TuneAnswer margins_in(const reading::AllTrialsFile& file);

}  // namespace zerocount::tuning
