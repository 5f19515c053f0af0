#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "runners/rare/splitting.hpp"

namespace zerocount::rare {

/// State of an estimate, from which it can go on: what has been learned, and the trials drawn since.
struct EstimatorState {
  std::int64_t trials{0};          ///< that were run, all together
  std::int64_t plain_trials{0};    ///< of these, trials drawn from their own distribution, in all phases
  std::int64_t plain_failures{0};  ///< of these, with a move that failed
  std::vector<ScoreSearch> searches;
  bool learned{false};        ///< the proposal is ready
  std::int64_t searched{0};   ///< learnings begun before this one that did not end
  std::int64_t learnings{0};  ///< how often a proposal was learned
  Proposal proposal;
  double cap{0.0};           ///< largest weight of a failure that the bounds allow for
  std::vector<Trial> drawn;  ///< from this proposal, without scores

  std::int64_t failures() const {  ///< of the drawn trials
    return std::ranges::count_if(drawn, [](const Trial& trial) { return trial.failed > 0.0; });
  }
};

struct EstimatorSettings {
  TrialSpace space{};
  std::size_t scores{1};
  double confidence{statistics::summary_confidence};
  double ratio{2.0};  ///< wanted of the bounds, high / low
  std::uint64_t seed{0};
};

/// Largest number of trials that are drawn from a proposal. One takes some hundred bytes.
inline constexpr std::size_t max_drawn = 2'000'000;
/// Largest number of values of a discrete draw that is tried value by value.
inline constexpr std::int64_t max_tried_values = 100'000;

enum class EstimateStatus {
  estimated,
  no_failure,   ///< no score leads to a failure, and no plain trial failed
  not_covered,  ///< failures keep having weights above the cap: the proposal hardly draws them
  too_many,     ///< the bounds are not narrow after as many trials as are kept
  budget        ///< ended before the bounds were narrow enough
};

struct Estimate {
  EstimateStatus status{EstimateStatus::budget};
  bool narrow{false};       ///< the bounds by the drawn trials are as narrow as asked
  double probability{0.0};  ///< expected proportion of failing moves
  /// As narrow as asked if it is estimated; otherwise `high` is not below that of the plain trials.
  statistics::ConfidenceInterval bounds{};
  /// Upper bound that needs no score: Clopper–Pearson, of the trials drawn from their own distribution.
  double plain_high{1.0};
};

/// Estimates the expected proportion of failing moves by importance sampling.
///
///     run plain trials
///     if few of them fail:                                   // learning
///       run trials at every value of each rare discrete draw, more at the worst ones
///       split() along each score, twice along the first
///     repeat:
///       proposal = pinned values + mixture fitted to the failures + a normal for each level of splitting
///       improve it by 1 to 8 rounds of its own draws
///       until the bounds are as narrow as asked:             // estimation
///         draw z from the proposal; add w(z)·failed(z)
///     until no failure has a weight above the cap; each time with a smaller part of the error probability
///
/// A discrete value is rare below a probability of 1 %; values at which failures are frequent are pinned
/// (PinnedValue). The normals of the levels keep failures that splitting lost on its way from large weights.
/// A tenth of the draws are from the trials' own distribution, so that the likelihood ratio w is at most 10;
/// the expectation of w·failed is the probability. The bounds are betting_bounds(), whose cap is twice
/// the 99.8 % quantile of the weights of failures, and at least those of plain ones.
///
/// `low` always holds; `high` if the failures that no score, and no value of a discrete draw, leads to are
/// less probable than those that are found. Where nothing can be learned, or learning did not help, plain
/// trials go on to the end of the budget: their bounds need no premise.
///
/// @param state empty, or of an interrupted estimate, which then goes on
/// @param go_on asked between parts of some hundred or thousand trials, with the state; false ends it
Estimate estimate(EstimatorState& state, const EstimatorSettings& settings, const Simulation& simulate,
                  const std::function<bool(const EstimatorState&)>& go_on);

/// The answer as far as the state goes.
Estimate answer_of(const EstimatorState& state, const EstimatorSettings& settings);

}  // namespace zerocount::rare
