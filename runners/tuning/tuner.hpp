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
  /// Whether the loop has no transfer function, because a plugin controls, so that there are no margins.
  bool blind{false};
  Searched searched{};
  Unfound unfound{};  ///< Explanation for missing values. Set if no candidate keeps the margins.
  /// The best values, with their margins and moves. Without values if no candidate keeps the margins.
  Examined tuned{};
  std::optional<Proof> proof{};
  Extras extras{};  ///< Results of the extras. Extras::left_out also names missing parts of the other stages.
  /// Time that the tuning took so far, s, including earlier runs of an interrupted tuning.
  double seconds{0.0};
  std::int64_t spent_trials{0};  ///< Number of trials spent by all stages together.
  /// Whether the tuning was interrupted after the proof. Given again, the same command makes the extras that
  /// were left out.
  bool interrupted{false};

  bool is_met() const { return status == goal::Status::met; }

  /// Behaviour of the moves (such as overshoot) of the proof. Before the proof: of some machines of the
  /// search.
  const std::vector<summary::MoveBehaviour>& moves() const { return proof ? proof->moves : tuned.moves; }

  /// Result of the extra (optional part of the answer) that returns this type; null if the extra did not run.
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
  const study::Study& study;     ///< Study that was tuned, with the values of its manifest.
  std::filesystem::path output;  ///< Path of the results file with the proof.
  bool drawn{false};             ///< Whether the report is drawn with figures.
  /// Whether the answer describes a results file of a proof that was made before, so that nothing was
  /// searched.
  bool is_of_file{false};
};

/// A behaviour of the tuned axis that a drive engineer would refuse, although the goals do not forbid it.
struct Refusal {
  std::string finding;  ///< Kind of the behaviour: "overshoot", "saturation", "phase margin", "torque noise".
  /// Sentence such as "95 % of the moves of goal 'large' overshoot by up to 59 % of the step".
  std::string text;
  double value{0.0};    ///< Value that is refused, in the unit of `largest`.
  double largest{0.0};  ///< Largest value that passes. For the phase margin: the smallest, degrees.
  /// Text that a user can add to the manifest against it, such as "limits: {overshoot: 50}".
  std::string remedy;
};

/// Refusals of a tuned behaviour. Refused are: an overshoot of more than 25 % of the step in 5 % of the
/// moves, if it leaves the goal's band; a converter that clips in more than 1 % of the moves; a phase margin
/// below 30°; and torque changes at rest with an rms above a tenth of the converter's largest torque.
std::vector<Refusal> refusals_of(const std::vector<summary::MoveBehaviour>& behaviour,
                                 const std::optional<SmallestMargins>& margins, const study::Study& study);

/// Settings of a tuning, with callbacks that get the answer after each stage.
struct TuneSettings {
  std::filesystem::path output;  ///< Path of the results file that the proof writes.
  TuneBudget budget{};
  int threads{0};
  bool quiet{false};
  bool page{false};  ///< Whether a page is written afterwards; some of the time is kept for it.
  std::vector<const Extra*> extras{};
  bool force{false};  ///< Whether to replace an existing output and unfinished runs of other studies.
  status::Listener listener{};
  /// Called after each generation of the search with its state.
  std::function<void(const SearchProgress&)> searching{};
  /// Called after the search and before the proof, with the behaviour of the values that are to be proven.
  std::function<void(const TuneAnswer&)> found{};
  /// Called after the proof with the answer so far, before the extras.
  std::function<void(const TuneAnswer&)> proven{};
  /// Called after each extra, with the answer so far.
  std::function<void(const Extra&, const TuneAnswer&)> ready{};
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

/// Computes the extras for the values in TuneSettings::output, the results file of an earlier proof. The
/// bounds of the answer do not allow for the attempts of that tuning. The margins are those of margins_in().
/// @param study study of the file
/// @throws Failure as tune()
TuneAnswer describe_tuned(const study::Study& study, const TuneSettings& settings,
                          const std::stop_token& stop);

/// Makes an answer that has only the stability margins of the values in the file's study, on the machines of
/// this study. Machines of a proof differ from those of the search, so their worst margins may be a little
/// smaller.
/// @param file results of a study with one design point and a section `tune`
TuneAnswer margins_in(const reading::AllTrialsFile& file);

}  // namespace zerocount::tuning
