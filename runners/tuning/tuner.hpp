#pragma once

#include <any>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/cells_of_point.hpp"
#include "analysis/summary/move_behaviour.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/race/candidate.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/search/study_search.hpp"
#include "runners/tuning/tune_plan.hpp"
#include "runners/tuning/units/loop_examiner.hpp"
#include "runners/tuning/units/unit_runner.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

/// What follows the proof of a tuning, by simulation; none of it is proven.
namespace zerocount::tuning {

/// How the moves of the first `count` units are made, each with one trial under each condition. The torque at
/// rest is measured from the dwell within `verdict.rest_band` on; where the study does not measure it, within
/// the largest band or tolerance of its goals.
/// @throws trial::Interrupted, trials::Spent
std::vector<summary::MoveBehaviour> simulated_behaviour(const study::Study& study,
                                                        const trials::Replicates& units, std::int64_t count,
                                                        const trials::Effort& effort);

/// Something that a drive engineer refuses, although the goals do not forbid it.
struct Refusal {
  std::string finding;  ///< "overshoot", "saturation", "phase margin", "torque noise"
  std::string text;     ///< "95 % of the moves of goal 'large' overshoot by up to 59 % of the step"
  double value{0.0};
  double largest{0.0};  ///< that passes; of the phase margin the smallest
  std::string remedy;   ///< "limits: {overshoot: 50}", as it stands in a manifest
};

/// Overshoot of more than 25 % of the step in 5 % of the moves (where it leaves the goal's band), a converter
/// that clips in more than 1 % of the moves, a phase margin below 30°, a torque whose changes at rest have an
/// rms of more than a tenth of the converter's largest torque.
std::vector<Refusal> refusals_of(const std::vector<summary::MoveBehaviour>& behaviour,
                                 const std::optional<SmallestMargins>& margins, const study::Study& study);

/// Trials of the tuned study on machines that the search never saw.
struct Proof {
  study::Study study;
  goal::Verdict verdict;               ///< its confidence allows for all attempts
  std::optional<goal::Needs> needs{};  ///< that would decide an undecided one
  int attempts{1};                     ///< candidates or sizes that were proven, this one included
  /// Each goal under each condition, with bounds that allow for all attempts.
  std::vector<summary::CellOfPoint> claims{};
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
      behaviour;                       ///< of the proof's moves; before the proof of the search's machines
  std::vector<Refusal> refusals;       ///< what an engineer would refuse of it
  std::vector<std::string> at_edges;   ///< free parameters at an end of their range, "controller.ki = 5000"
  std::optional<WorstMachine> worst;   ///< of the proof
  SearchResult search{};               ///< its points and trials with those for other controls
  std::vector<TriedPoint> frontier;    ///< between success and speed, by the search
  std::int64_t examined{0};            ///< points whose margins were examined
  MissedSearch missed{};               ///< decides the status of a goal that the proof misses
  std::vector<std::string> obstacles;  ///< what keeps the tuned axis from a goal that is not met, in theory
  std::vector<std::any> extras;        ///< what each has found: see extra()
  double seconds{0.0};
  TuneBudget budget{};
  std::int64_t spent_trials{0};               ///< of all: search, proof, and what follows
  std::vector<std::string> left_out;          ///< parts of the answer for which the budget was not enough
  std::vector<std::string_view> left_extras;  ///< names of the extras among them
  bool interrupted{false};  ///< after the proof: the extras that are left out wait for the same command
  std::optional<double>
      default_seconds{};  ///< that the search may take without a budget, as measured here, s

  bool is_met() const { return status == goal::Status::met; }

  /// The result of the extra of this type; null if the extra did not run.
  template <class Found>
  const Found* extra() const {
    for (const std::any& one : extras) {
      if (const auto* const found = std::any_cast<Found>(&one)) return found;
    }
    return nullptr;
  }
};

/// What `tune` found so far, as its answer shows it.
struct Tuning {
  const TuneAnswer& answer;
  const study::Study& study;     ///< that was tuned
  std::filesystem::path output;  ///< the results file of the proof
  bool drawn{false};             ///< with figures
  bool is_of_file{false};        ///< nothing was searched: the proof was made before
};

/// A tuned axis and the effort that its extras may spend.
struct TunedAxis {
  const study::Study& study;  ///< that was tuned
  StudySearch& search;        ///< whose machines are simulated
  TuningJournal& journal;     ///< of the searches for other controls
  trials::Effort effort;
  double speed;           ///< by which a budget is planned, trials/s; infinite without a limit of time
  double measured_speed;  ///< by which times are estimated, trials/s; 0 where nothing was measured
  TuneAnswer& answer;     ///< with the tuned values and their proof
  study::Study tuned{search.candidate(answer.gains)};  ///< on the units of the search
  RestPlan plan{};
  std::int64_t later{0};  ///< trials that the extras after this one take of the plan

  bool has_budget() const { return answer.budget.trials || answer.budget.seconds; }
  /// Trials of a point on the planned units.
  std::int64_t trials_of_point() const { return plan.units * search.units().trials_each; }
  /// All units of the search, with a budget those of the plan.
  trials::Replicates units() const;
  /// The tuned study on units().
  study::Study on_units(std::vector<std::string> overrides = {}) const;
  /// The worst claim (Aim::claims) that the first planned units do not meet; nothing if they meet all.
  /// @param study tuned, or with other values @param change null: none
  std::optional<std::size_t> lost_claim(const study::Study& study, const Change* change) const;
  /// One of so many parts of what a budget leaves beside the later extras; without a budget `by_default`
  /// trials.
  trials::Effort one_of_shares(double parts, std::int64_t by_default) const;
  /// Whether the work ended within the effort, and without an interruption.
  bool ended(const std::function<void()>& work) const;
};

/// What an extra takes.
struct ExtraCost {
  bool applies{true};        ///< to this answer
  std::int64_t points{0};    ///< that share the planned units
  std::int64_t searches{0};  ///< trials of its smallest searches
  std::int64_t maps{0};      ///< trials that are planned only where the others leave them
  std::int64_t trials{0};    ///< at most, by the plan
  double usual_part{1.0};    ///< of these, which must be affordable
};

/// A part of the answer that a user may want or not.
struct Extra {
  std::string_view name;      ///< in --extras
  std::string_view question;  ///< its heading on a page
  std::string_view part{};    ///< its name where it is left out; empty: `name`
  /// Why a study cannot have it, in the words of a refused option; empty if it can. Null: every study can.
  std::string (*refusal)(const study::Study& study, bool with_page){nullptr};
  ExtraCost (*cost)(const TunedAxis&);
  /// Makes it; what it returns is found by TuneAnswer::extra(). Parts that it leaves out stand in the answer.
  /// @throws trial::Interrupted, trials::Spent
  std::any (*run)(TunedAxis&);
  void (*describe)(document::Description<Tuning>&);
};

/// Names a part of an extra that is left out.
void leave_out(TuneAnswer& answer, std::string_view extra, std::string part);

/// Makes the wanted extras.
///
///     plan: so many units for each point that the budget is enough for all of them
///     for each:
///       what it takes is more than what is left: it is left out, so that later ones may fit
///       tell what remains; run it; ready(extra)
///       the effort ended: it is left out, and named
///       a stop is requested: it and all later ones are left out
void make_extras(const std::vector<const Extra*>& wanted, TunedAxis& axis, bool quiet,
                 status::StatusLine& line, const std::function<void(const Extra&)>& ready);

struct TuneSettings {
  std::filesystem::path output;  ///< the results file of the proof
  TuneBudget budget{};
  int threads{0};
  bool quiet{false};
  bool page{false};  ///< a page is written afterwards, for which some of the time is kept
  std::vector<const Extra*> extras{};
  bool force{false};  ///< replace the output, and unfinished runs of other studies
  status::Listener listener{};
  std::function<void(const SearchProgress&)> searching{};  ///< called after each generation of the search
  /// Called before the proof, with what the values that are to be proven do.
  std::function<void(const TuneAnswer&)> found{};
  std::function<void(const TuneAnswer&)> proven{};               ///< when the proof stands, before the extras
  std::function<void(const Extra&, const TuneAnswer&)> ready{};  ///< called after each extra
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
