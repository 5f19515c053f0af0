#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/layout.hpp"

/// What the tables of trials of a results file tell of their study.
namespace zerocount::reading {

/// Point and index, in /trial.
inline constexpr std::size_t columns_before_inputs = 2;

/// The columns of the group `input` of /trial or /rig; none without such a group.
std::vector<study::InputColumn> read_input_columns(const hdf5::Group& table);

/// The axis by the unit of a position, and the features by their columns.
study::StudyFeatures read_features(const hdf5::File& file, const layout::MeasureTable& table);

/// Position of the first of `size` rising numbers that is not below `number`.
std::int64_t first_not_below(const hdf5::Dataset& numbers, std::int64_t size, std::int64_t number);

}  // namespace zerocount::reading
