#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "runners/tuning/race/candidate.hpp"

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

/// trials::Replicates that a race of the first generation runs at most, over all candidates.
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

}  // namespace zerocount::tuning
