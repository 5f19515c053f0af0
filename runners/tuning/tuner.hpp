#pragma once

#include <any>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "runners/tuning/extras.hpp"

namespace zerocount::tuning {

/// Result of a tuning, filled in by its stages.
struct TuneAnswer {
  goal::Status status{goal::Status::undecided};
  std::vector<study::FreeParameter> free{};
  TuneBudget budget{};
  bool blind{false};  ///< The loop has no transfer function, so there are no margins.
  Searched searched{};
  Unfound unfound{};  ///< Set if no candidate keeps the margins.
  Examined tuned{};   ///< The best values. Without values if no candidate keeps the margins.
  std::optional<Proof> proof{};
  Extras extras{};  ///< Extras::left_out also names missing parts of the other stages.
  /// Time since the start, including earlier runs of an interrupted tuning, s.
  double seconds{0.0};
  std::int64_t spent_trials{0};  ///< Trials spent by all stages together.
  /// Whether the tuning was interrupted after the proof. The same command makes the extras that were left
  /// out.
  bool interrupted{false};

  bool is_met() const { return status == goal::Status::met; }

  /// Behaviour of the moves of the proof. Before the proof: of machines of the search.
  const std::vector<summary::MoveBehaviour>& moves() const { return proof ? proof->moves : tuned.moves; }

  /// Result of an extra, found by its type; null if the extra did not run.
  template <class Found>
  const Found* extra() const {
    for (const std::any& one : extras.found) {
      if (const auto* const found = std::any_cast<Found>(&one)) return found;
    }
    return nullptr;
  }
};

/// Answer of `tune` so far, with all that its report needs.
struct Tuning {
  const TuneAnswer& answer;
  const study::Study& study;     ///< Study that was tuned.
  std::filesystem::path output;  ///< Results file of the proof.
  bool drawn{false};             ///< Whether the report has figures.
  bool is_of_file{false};        ///< The proof was made before and nothing was searched.
};

/// A behaviour that a drive engineer would refuse, although the goals do not forbid it.
struct Refusal {
  std::string finding;  ///< "overshoot", "saturation", "phase margin", "torque noise"
  std::string text;     ///< "95 % of the moves of goal 'large' overshoot by up to 59 % of the step"
  double value{0.0};    ///< Value that is refused.
  double largest{0.0};  ///< Largest value that passes. For the phase margin: the smallest.
  std::string remedy;   ///< Text for a manifest, such as "limits: {overshoot: 50}".
};

/// Refusals of a tuned behaviour. Refused are: an overshoot of more than 25 % of the step in 5 % of the
/// moves, if it leaves the goal's band; a converter that clips in more than 1 % of the moves; a phase margin
/// below 30°; and torque changes at rest with an rms above a tenth of the converter's largest torque.
std::vector<Refusal> refusals_of(const std::vector<summary::MoveBehaviour>& behaviour,
                                 const std::optional<SmallestMargins>& margins, const study::Study& study);

/// Settings of a tuning, with the callbacks that receive its stages.
struct TuneSettings {
  std::filesystem::path output;  ///< Results file of the proof.
  TuneBudget budget{};
  int threads{0};
  bool quiet{false};
  bool page{false};  ///< A page is written afterwards; some of the time is kept for it.
  std::vector<const Extra*> extras{};
  bool force{false};  ///< Replace the output and unfinished runs of other studies.
  status::Listener listener{};
  std::function<void(const SearchProgress&)> searching{};  ///< Called after each generation of the search.
  /// Called before the proof, with the behaviour of the values that are to be proven.
  std::function<void(const TuneAnswer&)> found{};
  /// Called after the proof, before the extras.
  std::function<void(const TuneAnswer&)> proven{};
  std::function<void(const Extra&, const TuneAnswer&)> ready{};  ///< Called after each extra.
};

/// Tunes the study. Called again after an interruption, it resumes where it was. If it is interrupted after
/// the proof, it returns the answer so far.
///
///     space; search with half of the budget; found(answer): behaviour of the best values
///     prove the values on fresh machines: FILE is complete, proven(answer)
///     for each extra: ready(extra, answer)
///
/// @throws Failure: bad_input if the study cannot be tuned, the output exists, or the budget has too few
/// trials; inconclusive if it has too little time; interrupted before the proof
TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop);

/// Makes the extras for the values in TuneSettings::output, the results file of a proof. The bounds of the
/// answer do not allow for the attempts of the tuning. The margins are those of margins_in().
/// @param study study of the file
/// @throws Failure as tune()
TuneAnswer describe_tuned(const study::Study& study, const TuneSettings& settings,
                          const std::stop_token& stop);

/// Answer with only the margins of the values in the file's study, on the machines of this study. Machines of
/// a proof differ from those of the search, so their worst margins may be a little smaller.
/// @param file results of a study with one design point and a section `tune`
TuneAnswer margins_in(const reading::AllTrialsFile& file);

}  // namespace zerocount::tuning
