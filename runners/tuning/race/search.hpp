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
/// generation of candidates is drawn around the best of those before it, and races over units that are the
/// same for all of them. A candidate that cannot win is dropped after few units.
namespace zerocount::tuning {

/// Numbers of candidates and units of a search. A race begins with all candidates on the first units. At each
/// doubling of the units fewer stay, so that every round costs about the same.
struct SearchSize {
  std::int64_t first_candidates{96};  ///< of the first generation, which fills the ranges
  std::int64_t face_candidates{0};    ///< of it, for each face (SearchProblem::faces)
  std::int64_t candidates{32};  ///< of each later generation that runs max_units; the more the fewer it runs
  std::int64_t elites{8};       ///< that a generation leaves to the next
  std::int64_t first_units{64};
  std::int64_t climbing_units{256};  ///< at most, while the best candidate seems to miss the goal
  std::int64_t max_units{2048};      ///< of a candidate
};

/// Candidates at most that stay in a race after `units` units.
std::int64_t max_after(const SearchSize& size, std::int64_t units);

/// Units that a race of the first generation runs at most, over all candidates.
std::int64_t first_race_units(const SearchSize& size, std::size_t faces);

/// What the size of a search depends on, beside the effort.
struct SearchScope {
  std::size_t free{1};           ///< parameters
  std::size_t faces{0};          ///< SearchProblem::faces
  std::int64_t max_units{2048};  ///< of the largest search
  std::int64_t worlds{0};        ///< each is to have some units; 0: none
};

/// The largest search whose first generation takes at most half of so many units; the smallest one if there
/// is none.
SearchSize search_size(const SearchScope& scope, std::int64_t units);

/// The smallest search that finds something.
SearchSize smallest_search(const SearchScope& scope);

/// Those that stay in a race after so many units: without the ones that cannot win, which surely miss the
/// goal, or are surely later than one that surely meets it. Of the others max_after(units) stay, as in
/// successive halving, so that a race between equals ends: by turns the best and the most reliable, because
/// few units make fast points look as if they met the goal. Those with more units stay.
/// @param candidates the best first
std::vector<Candidate> dropped(const Aim& aim, const SearchSize& size, std::vector<Candidate> candidates,
                               std::int64_t units);

/// The problem as the search sees it.
struct SearchProblem {
  std::vector<study::FreeParameter> free;
  Aim aim;
  std::vector<Values> starts{};  ///< such as the manifest's values: the result is worse only by chance
  /// Faces of the ranges on which the search seeks too, each the free parameters that are at their low ends:
  /// a control with fewer blocks, which may be the better one, and the only admissible one.
  std::vector<std::vector<std::size_t>> faces{};
  SearchSize size{};
  std::int64_t trials_of_unit{1};

  /// Appends the results of the units up to `to` to every candidate; to none of them if it throws
  /// trial::Interrupted, because the time is over.
  std::function<void(std::span<Candidate* const>, std::int64_t to)> evaluate;
  /// [candidate] whether it may be tried at all, or go on after what its units did. Cheap: called for many
  /// candidates.
  std::function<std::vector<bool>(std::span<const Candidate>)> admissible;
  /// How far values are from being admissible before any unit is run: 0 where they are. Where it is given,
  /// the first generation walks to what is admissible if the ranges have little of it.
  std::function<std::vector<double>(std::span<const Values>)> shortfall{};
  /// Whether a candidate keeps all conditions, also those that are costly to examine. Called for candidates
  /// that lead; what `admissible` says may become stricter by it.
  std::function<bool(const Candidate&)> verified;
};

/// Progress of a search.
struct SearchProgress {
  int generation{0};
  std::int64_t points{0};
  std::int64_t trials{0};
  const Candidate* best{nullptr};
  Estimate estimate{};
};

struct SearchSettings {
  std::uint64_t seed{0};
  int generations{30};      ///< at most, unless it begins anew
  bool begins_anew{false};  ///< where generations improve nothing, until the effort is spent
  trials::Effort effort{};  ///< the search spends its trials
  std::function<void(const SearchProgress&)> tell{};  ///< called after each generation
};

struct SearchResult {
  std::vector<Candidate> finalists;  ///< the best first; none if no candidate is admissible
  std::vector<Estimate> estimates;   ///< [finalist] by all units
  std::vector<TriedPoint> tried;     ///< all that were simulated
  std::int64_t points{0};            ///< candidates that were simulated
  std::int64_t trials{0};
  int generations{0};
  bool converged{false};  ///< the last generations improved nothing
  /// The effort ended while the last generations came nearer to a goal that the best candidate misses: more
  /// of it may reach the goal.
  bool approaching{false};
  bool cut{false};  ///< the effort ended within a generation
};

/// Seeks the best values within the effort.
///
///     most_units = climbing_units
///     population = the best of `starts`, by a race
///     candidates = points that fill the ranges and the faces                     // first generation
///     if too few of them are admissible: those that differential evolution of `shortfall` finds
///     repeat until generations improve nothing, or the effort is spent:
///       for units = first_units, 2·first_units, … most_units, while any move meets the goal:   // race
///         evaluate all candidates up to `units`
///         drop those not admissible, significantly worse than the best, or beyond max_after(units), but
///         none that have more units already
///         where the best seems to meet the goal at most_units: double them, up to max_units
///       population = the best `elites`
///       candidates = points near them, or on a face near them, the more the smaller most_units is; or, where
///       no move of theirs meets the goal, and where the search begins anew, points that fill the ranges and
///       the faces
///     race of the population up to max_units
///
/// Where the effort ends within a race, the candidates with the most units stay. Differential evolution is
/// that of Walk.
/// @throws trial::Interrupted
SearchResult search(const SearchProblem& problem, const SearchSettings& settings);

}  // namespace zerocount::tuning
