#pragma once

#include <numbers>

#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/controller/control_block.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::loop {

/// The pole a = exp(−2π·f·T) of the derivative filter; 0 with an infinite cutoff.
inline double derivative_pole(const ControlBlocks& blocks, double sample_rate) {
  return numerics::exp(-2.0 * std::numbers::pi * blocks.derivative_cutoff / sample_rate);
}

/// The difference of successive counts, through a first-order low-pass filter:
///
///   d_k = a·d_{k−1} + (1 − a)·(count_k − count_{k−1}),   a = exp(−2π·f·T),
///
///   D(z) = (1 − a)·(1 − z⁻¹)/(1 − a·z⁻¹)·Count(z).
///
/// The count before the first is the first, d before it is 0.
class CountDifference {
 public:
  explicit CountDifference(double pole) : pole_(pole) {}

  /// d at this sample, counts.
  double step(double count) {
    if (!started_) last_count_ = count;
    started_ = true;
    difference_ = filtered_difference(pole_, difference_, count - last_count_);
    last_count_ = count;
    return difference_;
  }

  /// A sample that leaves d as it is.
  void pass(double count) { last_count_ = count; }
  double value() const { return difference_; }  ///< d of the last step, counts

  /// `gain`·D(z).
  TransferFunction transfer(double gain) const {
    const double b = gain * (1.0 - pole_);
    if (pole_ == 0.0) return {{b, -b}};
    return {{b, -b}, {1.0, -pole_}};
  }

 private:
  double pole_;
  double difference_{0.0};
  double last_count_{0.0};
  bool started_{false};
};

}  // namespace zerocount::loop
