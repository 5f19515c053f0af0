#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "results/hdf5/chunk_filters.hpp"
#include "results/layout/table_io.hpp"
#include "runners/forecast/forecast.hpp"

namespace zerocount::forecast {
namespace {

template <class Value>
std::span<const std::byte> bytes_of(const std::vector<Value>& values) {
  return std::as_bytes(std::span(values));
}

/// Smallest number of trailing mantissa bits that are 0, over all values. It is large for counts stored as
/// real numbers.
int trailing_zeros(std::span<const double> values) {
  constexpr int mantissa_bits = 52;
  int fewest = mantissa_bits;
  for (const double value : values)
    if (value != 0.0 && std::isfinite(value))
      fewest = std::min(fewest, std::countr_zero(std::bit_cast<std::uint64_t>(value)));
  return fewest;
}

/// Generator of column elements that are similar to a sample, to see how well they are compressed.
template <class Value>
class Population {
 public:
  Population(std::vector<Value> sample, double period) : sample_(std::move(sample)) {
    std::ranges::copy_if(sample_, std::back_inserter(sorted_), [](Value value) { return value == value; });
    std::ranges::sort(sorted_);
    if constexpr (std::is_floating_point_v<Value>) kept_bits_ = ~std::uint64_t{0} << trailing_zeros(sample_);
    rises_ = std::is_integral_v<Value> && sample_.size() > sampled_places &&
             sample_.front() != sample_.back() && std::ranges::is_sorted(sample_);
    find_repetition(period);
  }

  /// Generates `count` elements like those of a column with `all` elements.
  std::vector<Value> some(std::size_t count, double all) {
    std::vector<Value> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (rises_) {
        const double of_all = static_cast<double>(i) / static_cast<double>(count - 1);
        const double last = static_cast<double>(sample_.back()) * all / static_cast<double>(sample_.size());
        values[i] = static_cast<Value>(last * of_all * static_cast<double>(count) / all);
      } else {
        const bool repeats = period_ > 0 && i >= period_ && chance() < repetition_;
        values[i] = repeats ? values[i - period_] : like(sample_[place_of(i, count)]);
      }
    }
    return values;
  }

 private:
  double chance() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  /// Measures the proportion of values in the sample that equal the value one period (design point) before.
  void find_repetition(double period) {
    const std::size_t length = sample_.size() / sampled_places;
    if (!(period >= 1.0) || period >= static_cast<double>(length)) return;
    period_ = static_cast<std::size_t>(period);
    std::size_t pairs = 0, equal = 0;
    for (std::size_t i = 0; i < sample_.size(); ++i) {
      if (i % length < period_) continue;
      ++pairs;
      equal += std::memcmp(&sample_[i], &sample_[i - period_], sizeof(Value)) == 0 ? 1 : 0;
    }
    repetition_ = static_cast<double>(equal) / static_cast<double>(pairs);
  }

  /// Random index in the part of the sample that represents the neighbourhood of element `i`.
  /// @param count number of generated elements
  std::size_t place_of(std::size_t i, std::size_t count) {
    const std::size_t length = std::max<std::size_t>(sample_.size() / sampled_places, 1);
    const std::size_t first = i * sample_.size() / count / length * length;
    return std::min<std::size_t>(first + random_() % length, sample_.size() - 1);
  }

  Value like(Value value) {
    const auto [first, after] = std::ranges::equal_range(sorted_, value);
    constexpr std::ptrdiff_t levels = 128;  // of a measure that is no label
    const std::ptrdiff_t often = std::max<std::ptrdiff_t>(std::ssize(sorted_) / levels, 1);
    if (first == after || after - first > often || (after == sorted_.end() && first == sorted_.begin()))
      return value;  // NaN, or a value that occurs again
    const auto next = after == sorted_.end() ? first - 1 : after;
    const double made =
        static_cast<double>(value) + chance() * (static_cast<double>(*next) - static_cast<double>(value));
    if (!std::isfinite(made)) return value;
    if constexpr (std::is_floating_point_v<Value>)
      return std::bit_cast<double>(std::bit_cast<std::uint64_t>(made) & kept_bits_);
    return static_cast<Value>(made);
  }

  std::vector<Value> sample_;
  std::vector<Value> sorted_;  ///< Values of the sample without NaN, in ascending order.
  std::uint64_t kept_bits_{0};
  std::size_t period_{0};
  double repetition_{0.0};
  bool rises_{false};  ///< Whether the values of the sample rise throughout, as row numbers do.
  std::mt19937_64 random_{1};
};

template <class Value>
double bytes_like(const ColumnSample& sample, double count,
                  const std::function<std::int64_t(std::int64_t)>& twin_of) {
  std::vector<Value> values(sample.values.size() / sizeof(Value));
  std::memcpy(values.data(), sample.values.data(), values.size() * sizeof(Value));
  const auto made = static_cast<std::size_t>(std::min(count, static_cast<double>(layout::chunk_elements)));
  if (values.empty() || made == 0) return 0.0;
  if (made > values.size()) values = Population<Value>(std::move(values), sample.period).some(made, count);
  values.resize(made);
  if (twin_of) {
    const std::vector<Value> first = values;
    for (std::size_t i = 0; i < made; ++i)
      values[i] = first[static_cast<std::size_t>(twin_of(static_cast<std::int64_t>(i)))];
  }
  return stored_bytes(sample.element, bytes_of(values)) * count / static_cast<double>(made);
}

}  // namespace

double stored_bytes(hdf5::Element element, std::span<const std::byte> values) {
  const std::size_t size = hdf5::size_of(element);
  const std::size_t chunk = size * static_cast<std::size_t>(layout::chunk_elements);
  const hdf5::ChunkFilters filters{size, 1};
  double bytes = 0.0;
  for (; !values.empty(); values = values.subspan(std::min(chunk, values.size()))) {
    const std::span<const std::byte> elements = values.first(std::min(chunk, values.size()));
    const auto stored = hdf5::encode_chunk(filters, elements);
    bytes += static_cast<double>(stored.size());
  }
  return bytes;
}

double stored_bytes(const ColumnSample& sample, double count,
                    const std::function<std::int64_t(std::int64_t)>& twin_of) {
  switch (sample.element) {
    case hdf5::Element::float64:
      return bytes_like<double>(sample, count, twin_of);
    case hdf5::Element::int64:
      return bytes_like<std::int64_t>(sample, count, twin_of);
    case hdf5::Element::int32:
      return bytes_like<std::int32_t>(sample, count, twin_of);
    case hdf5::Element::int8:
    case hdf5::Element::flag:
      return bytes_like<std::int8_t>(sample, count, twin_of);
    case hdf5::Element::text:
      break;
  }
  return 0.0;
}

}  // namespace zerocount::forecast
