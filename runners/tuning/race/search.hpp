#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiments/study/goal.hpp"
#include "runners/trials/effort.hpp"
#include "runners/tuning/race/candidate.hpp"

/// Iterated racing (López-Ibáñez et al., "The irace package", Operations Research Perspectives 3, 2016): a
/// generation of candidates is drawn around the best of those before it, and races over machines that are the
/// same for all candidates. A candidate that cannot win is dropped after few machines.
namespace zerocount::tuning {

/// Numbers of candidates and machines of a search. A race begins with all candidates on the first
/// machines. At each doubling of the machines fewer candidates stay, so every round costs about the same.
struct SearchSize {
  /// Number of candidates in the first generation, which is spread over the ranges of all parameters.
  std::int64_t first_candidates{96};
  /// Number of additional candidates of the first generation on each face (SearchProblem::faces).
  std::int64_t face_candidates{0};
  /// Number of candidates in a later generation that runs max_machines. A generation that runs fewer machines
  /// has proportionally more candidates.
  std::int64_t candidates{32};
  std::int64_t elites{8};  ///< Number of candidates that survive a generation.
  /// Number of machines that each candidate runs in the first round of a race.
  std::int64_t first_machines{64};
  /// Maximum number of machines per candidate while the best candidate seems to miss the goal.
  std::int64_t climbing_machines{256};
  std::int64_t max_machines{2048};  ///< Maximum number of machines that each candidate runs.
};

/// Maximum number of candidates that stay in a race after each has run `machines` machines.
std::int64_t max_after(const SearchSize& size, std::int64_t machines);

/// Upper limit of the machines that a race of the first generation simulates, summed over its candidates.
/// @param faces number of SearchProblem::faces
std::int64_t first_race_machines(const SearchSize& size, std::size_t faces);

/// Properties of a tuning problem that set the size of its search, besides the effort.
struct SearchScope {
  std::size_t free{1};  ///< Number of free parameters, the dimension of the search.
  /// Number of SearchProblem::faces, the sets of parameters that may stay at their low ends.
  std::size_t faces{0};
  /// SearchSize::max_machines of the largest search, the machines that each candidate may run there.
  std::int64_t max_machines{2048};
  /// Number of worlds (draws of the values that all machines share and nobody knows), each of which needs
  /// some machines; 0: no worlds.
  std::int64_t worlds{0};
};

/// Size of the largest search whose first generation simulates at most half of `machines` machines, summed
/// over its candidates. If none does, the smallest search.
SearchSize search_size(const SearchScope& scope, std::int64_t machines);

/// Size of the smallest search that is still likely to find good values.
SearchSize smallest_search(const SearchScope& scope);

/// Returns the candidates that stay in a race after each has run `machines` machines.
///
/// Candidates that cannot win are dropped: those that surely miss the goal, and those whose criterion is
/// surely worse than that of a candidate that surely meets the goal. At most max_after(machines) of the
/// others stay, as in successive halving, so that a race between equals ends. The best and the most reliable
/// ones are taken alternately, because few machines make fast points look as if they met the goal. Candidates
/// that have run more than `machines` machines always stay.
/// @param candidates the best first
std::vector<Candidate> dropped(const Aim& aim, const SearchSize& size, std::vector<Candidate> candidates,
                               std::int64_t machines);

/// Problem that search() solves: the free parameters, the aim, and the functions that simulate and check
/// candidates.
struct SearchProblem {
  std::vector<study::FreeParameter> free;
  Aim aim;
  /// Values that are raced first, such as those of the manifest. So the result of the search is worse than
  /// these only by chance.
  std::vector<Values> starts{};
  /// Faces of the box of parameter ranges that are searched too. A face is a set of free parameters that stay
  /// at their low ends. It stands for a control law with fewer blocks, which may be the better one or the
  /// only admissible one.
  std::vector<std::vector<std::size_t>> faces{};
  SearchSize size{};
  /// Number of trials of each machine, in all settings (conditions at ages) together.
  std::int64_t trials_of_replicate{1};

  /// Simulates every candidate and appends the results, until each has those of `to` machines. Throws
  /// trial::Interrupted if the time is over; then no candidate is changed.
  std::function<void(std::span<Candidate* const>, std::int64_t to)> evaluate;
  /// [candidate] Whether the candidate may be simulated or, if it already has results, may go on. Must be
  /// cheap, because it is called for many candidates.
  std::function<std::vector<bool>(std::span<const Candidate>)> admissible;
  /// Distance of values from being admissible before any machine is run; 0 if they are admissible. If this
  /// function is given and few values are admissible, the first generation walks to the admissible ones.
  std::function<std::vector<double>(std::span<const Values>)> shortfall{};
  /// Whether a candidate fulfils all requirements, including those that are costly to examine, such as
  /// stability margins of all machines. Called for leading candidates. A call may make `admissible` stricter.
  std::function<bool(const Candidate&)> verified;
};

/// State of a search after a generation, for progress messages.
struct SearchProgress {
  int generation{0};
  std::int64_t points{0};
  std::int64_t trials{0};
  const Candidate* best{nullptr};
  RateEstimate estimate{};
};

struct SearchSettings {
  std::uint64_t seed{0};
  int generations{30};  ///< Maximum number of generations; no limit if begins_anew is set.
  /// Whether to fill the ranges again, when generations improve nothing, until the effort is spent.
  bool begins_anew{false};
  trials::Effort effort{};  ///< Trials and time that the search may spend.
  /// Called after each generation with the state of the search.
  std::function<void(const SearchProgress&)> tell{};
};

struct SearchResult {
  /// The best candidates of the search, the best first; empty if no candidate is admissible.
  std::vector<Candidate> finalists;
  /// [finalist] Success rates and criterion, estimated from all machines that the finalist ran.
  std::vector<RateEstimate> estimates;
  std::vector<TriedPoint> tried;  ///< All simulated sets of values, with their estimates.
  std::int64_t points{0};         ///< Number of simulated candidates (sets of values).
  std::int64_t trials{0};
  int generations{0};
  bool converged{false};  ///< Whether the search ended because the last generations improved nothing.
  /// Whether the last generations came closer to a goal that the best candidate still misses. More effort may
  /// then reach the goal.
  bool approaching{false};
  bool cut{false};  ///< Whether the effort ended within a generation, so that the search is incomplete.
};

/// Seeks the best values within the effort.
///
///     most_machines = climbing_machines
///     population = the best of `starts`, by a race
///     candidates = points that fill the ranges and the faces                     // first generation
///     if too few of them are admissible: add points that differential evolution of `shortfall` finds
///     repeat until generations improve nothing, or the effort is spent:
///       race, for machines = first_machines, 2·first_machines, … most_machines, while any move meets the
///       goal:
///         evaluate all candidates up to `machines`
///         drop those not admissible, significantly worse than the best, or beyond max_after(machines), but
///         none that have more machines already
///         if the best seems to meet the goal at most_machines: double them, up to max_machines
///       population = the best `elites`
///       candidates = points near them, or on a face near them, the more the smaller most_machines is;
///       if no move of theirs meets the goal, or if the search begins anew: points that fill the ranges
///       and the faces
///     race of the population up to max_machines
///
/// If the effort ends within a race, the candidates with the most machines stay. Walk implements the
/// differential evolution.
/// @throws trial::Interrupted
SearchResult search(const SearchProblem& problem, const SearchSettings& settings);

}  // namespace zerocount::tuning
