#include "core/trial/last_half.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/numerics/sign.hpp"

namespace zerocount::trial {

void LastHalf::start(std::int64_t samples) {
  begun_ = false;
  rises_.clear();
  oldest_ = 0;
  reserve_ =
      static_cast<std::size_t>(std::min<std::int64_t>(samples - first_of_last_half(samples), max_rises));
}

void LastHalf::begin(std::int64_t count) {
  begun_ = true;
  first_ = min_ = max_ = count;
}

void LastHalf::add_rise(const Rise& rise) {
  if (rises_.size() < max_rises) {
    rises_.reserve(reserve_);
    rises_.push_back(rise);
    return;
  }
  rises_[oldest_] = rise;
  oldest_ = (oldest_ + 1) % max_rises;
}

bool LastHalf::only_approaches(std::int64_t target) const {
  const std::int64_t error = target - first_;
  // The errors lie between target − max and target − min.
  const auto may_be = [&](std::int64_t count) {
    return numerics::sign_of(target - count) == numerics::sign_of(error) &&
           std::abs(target - count) <= std::abs(error);
  };
  return may_be(min_) && may_be(max_);
}

double LastHalf::amplitude() const {
  return 0.5 * static_cast<double>(max_ - min_);
}

double LastHalf::period(double sample_time) const {
  // For whole counts, c_{k−1} < m ≤ c_k is equivalent to the condition with m rounded up.
  const std::int64_t middle = min_ + (max_ - min_ + 1) / 2;
  std::int64_t crossings = 0;
  std::int64_t first = 0;
  std::int64_t last = 0;
  for (std::size_t i = 0; i < rises_.size(); ++i) {
    const Rise& rise = rises_[(oldest_ + i) % rises_.size()];
    if (!(rise.from < middle && middle <= rise.to)) continue;
    if (crossings++ == 0) first = rise.k;
    last = rise.k;
  }
  if (crossings < 2) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(last - first) / static_cast<double>(crossings - 1) * sample_time;
}

}  // namespace zerocount::trial
