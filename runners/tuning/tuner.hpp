#pragma once

#include <any>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "runners/tuning/extras.hpp"

namespace zerocount::tuning {

/// The result of tuning: what its stages found.
struct TuneAnswer {
  goal::Status status{goal::Status::undecided};
  std::vector<study::FreeParameter> free{};
  TuneBudget budget{};
  bool blind{false};  ///< the loop has no transfer function: no margins
  Searched searched{};
  Unfound unfound{};  ///< where no candidate keeps the margins
  Examined tuned{};   ///< without values then
  std::optional<Proof> proof{};
  Extras extras{};  ///< what is left out is of all stages
  double seconds{0.0};
  std::int64_t spent_trials{0};
  bool interrupted{false};  ///< after the proof: the extras that are left out wait for the same command

  bool is_met() const { return status == goal::Status::met; }

  /// The moves of the proof, or before it those of the search's machines.
  const std::vector<summary::MoveBehaviour>& moves() const { return proof ? proof->moves : tuned.moves; }

  /// The result of the extra of this type; null if the extra did not run.
  template <class Found>
  const Found* extra() const {
    for (const std::any& one : extras.found) {
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
///     space; search: half of the budget; found: what the best values do
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
