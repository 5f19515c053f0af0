#pragma once

#include <cstdint>
#include <vector>

#include "runners/tuning/race/candidate.hpp"
#include "runners/tuning/race/search_size.hpp"

namespace zerocount::tuning {

/// Those that stay in a race after so many units: without the ones that cannot win, which surely miss the
/// goal, or are surely later than one that surely meets it. Of the others max_after(units) stay, as in
/// successive halving, so that a race between equals ends: by turns the best and the most reliable, because
/// few units make fast points look as if they met the goal. Those with more units stay.
/// @param candidates the best first
std::vector<Candidate> dropped(const Aim& aim, const SearchSize& size, std::vector<Candidate> candidates,
                               std::int64_t units);

}  // namespace zerocount::tuning
