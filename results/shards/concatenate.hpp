#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include "results/hdf5/hdf5.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::shards {

/// Function that maps a trial's row in the shards to its row in the file that is written. Empty: the rows are
/// the same.
using Renumbering = std::function<std::int64_t(std::int64_t row)>;

struct JoinOptions {
  Renumbering renumber{};  ///< Applied to the values of the column `trial`, in a table that has one
  std::stop_token stop{};
  timeline::Timeline* timeline{nullptr};  ///< Records which thread works at what time; null: no record
};

/// Creates `table` in `file` and fills it with the rows of that table in the shards (files with finished
/// trials), in the order of the shards.
///
/// Copies chunks (stored blocks of rows) without decoding where a shard has the same chunks. Otherwise
/// decodes and encodes a few chunks per column at a time, so that memory is bounded. The order of writing, a
/// chunk of each column after the other, does not depend on how the rows are divided among the shards.
/// @param width        size of the second dimension, 1 if the table has none
/// @param first_number first value of the scale of the rows; none: the caller writes the scale
/// @throws Failure (interrupted) if a stop is requested before the last chunk is written
void concatenate(hdf5::File& file, const layout::Table& table, std::span<const ShardInfo> shards,
                 std::int64_t width, std::optional<std::int64_t> first_number,
                 const JoinOptions& options = {});

}  // namespace zerocount::shards
