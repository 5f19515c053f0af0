#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/trial/outcome.hpp"

namespace zerocount::measures {

/// The moves of trials of a design point that follow one another.
struct MovesOfTrials {
  std::int64_t first_trial{0};                       ///< its index at the point
  std::size_t of_trial{1};                           ///< moves
  std::span<const trial::MoveOutcome* const> moves;  ///< [trial, move]

  std::int64_t trials() const { return std::ssize(moves) / static_cast<std::int64_t>(of_trial); }
};

}  // namespace zerocount::measures
