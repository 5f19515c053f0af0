#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::loop {

/// The pole a = exp(−2π·f·T) of the low-pass filter on the difference of counts, f its cutoff; 0 if the
/// cutoff is infinite.
inline double derivative_pole(const ControlBlocks& blocks, double sample_rate) {
  return numerics::exp(-2.0 * std::numbers::pi * blocks.derivative_cutoff / sample_rate);
}

/// Mean difference of successive counts over a window of N samples, filtered by a first-order low-pass:
///
///   d_k = a·d_{k−1} + (1 − a)·(count_k − count_{k−N})/N,   a = exp(−2π·f·T),
///
///   D(z) = (1 − a)·(1 − z⁻ᴺ)/(N·(1 − a·z⁻¹))·Count(z).
///
/// CountsBefore gives the counts before the first sample. d before it is their mean difference v₀·T/Δx, the
/// steady state of the filter.
class CountDifference {
 public:
  explicit CountDifference(double pole, int window = 1, const CountsBefore& before = {})
      : pole_(pole),
        window_(static_cast<std::size_t>(window)),
        before_(before),
        difference_(counts_per_sample(before)) {}

  /// Updates the filtered mean difference d by the count of this sample.
  /// @returns d, counts.
  double step(double count) {
    if (last_counts_.empty()) start(count);
    const double change = (count - last_counts_[oldest_]) / static_cast<double>(window_);
    difference_ = filtered_difference(pole_, difference_, change);
    pass(count);
    return difference_;
  }

  /// Takes the count of a sample into the window without changing the filtered difference d.
  void pass(double count) {
    last_counts_[oldest_] = count;
    oldest_ = (oldest_ + 1) % window_;
  }
  double value() const { return difference_; }  ///< Filtered mean difference d of the last step(), counts

  /// Transfer function from the count to `gain` times the filtered difference: gain·D(z)/Count(z).
  TransferFunction transfer(double gain) const {
    const double b = gain * (1.0 - pole_) / static_cast<double>(window_);
    std::vector<double> of_counts(window_ + 1);
    of_counts.front() = b;
    of_counts.back() = -b;
    if (pole_ == 0.0) return {of_counts};
    return {of_counts, {1.0, -pole_}};
  }

 private:
  void start(double first_count) {
    for (std::size_t j = window_; j > 0; --j) last_counts_.push_back(first_count - counted_since(before_, j));
  }

  double pole_;
  std::size_t window_;  // N
  CountsBefore before_;
  std::vector<double> last_counts_;  // of the last N samples, in a ring; empty before the first
  std::size_t oldest_{0};            // count_{k−N} in it
  double difference_;
};

}  // namespace zerocount::loop
