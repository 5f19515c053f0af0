#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/extras.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/tune_answer.hpp"

namespace zerocount::tuning {

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
