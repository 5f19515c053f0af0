#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "results/hdf5/element.hpp"

namespace zerocount::forecast {

inline constexpr std::size_t sampled_places = 8;

/// Bytes that a results file stores for these elements of a column, after its filters.
double stored_bytes(hdf5::Element element, std::span<const std::byte> values);

/// Some elements of a column in their order: from `sampled_places` of it, as many that follow one another.
struct ColumnSample {
  hdf5::Element element;
  std::span<const std::byte> values;
  double period{0.0};  ///< elements to the same trial of the next design point, whose value may be equal
};

/// Estimate of stored_bytes() of `count` elements, of which some are known. A chunk of elements like them is
/// made up and filtered: a value that occurs often is drawn again, another stands for those between it and
/// the next (a smoothed bootstrap). They keep their place: the sample's beginning stands for the beginning of
/// the column. As many as in the sample equal the value one period before.
/// @param twin_of the first element that equals element i in every study, such as that of the same machine;
/// empty: none does
double stored_bytes(const ColumnSample& sample, double count,
                    const std::function<std::int64_t(std::int64_t)>& twin_of = {});

}  // namespace zerocount::forecast
