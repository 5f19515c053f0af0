#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace zerocount::trial {

/// The number h = ⌈N/2⌉ of the first sample in the last half of a move of N samples.
constexpr std::int64_t first_of_last_half(std::int64_t samples) {
  return (samples + 1) / 2;
}

/// Motion of the count in the last half of a move, samples h … N − 1: whether it only approaches its target,
/// and otherwise amplitude and period of its oscillation.
///
/// The amplitude is A = (c_max − c_min)/2. An upward crossing of the middle m = (c_max + c_min)/2 is a sample
/// k > h with c_{k−1} < m ≤ c_k. The period is the mean time between successive ones,
///
///   (k_last − k_first)·T/(crossings − 1).
///
/// The middle is known only at the end. Therefore all rises of the count are stored, at most the last
/// max_rises, from which the period of a longer half is computed.
class LastHalf {
 public:
  static constexpr std::size_t max_rises = 131'072;

  /// Starts recording for a move of `samples` samples. Keeps the allocated memory. The first rise of the
  /// count allocates all the memory that the half can need.
  void start(std::int64_t samples);

  /// Takes the count at sample k ≥ h.
  /// @param before count at sample k − 1, or `count` itself at sample h. Samples without a change of the
  /// count may be left out, as long as finish() is called.
  void add(std::int64_t k, std::int64_t before, std::int64_t count) {
    if (!begun_) begin(before);
    if (count > before) {
      add_rise({k, before, count});
      if (count > max_) max_ = count;
    } else if (count < min_) {
      min_ = count;
    }
  }

  /// Ends the last half of the move.
  /// @param count count at its last sample.
  void finish(std::int64_t count) {
    if (!begun_) begin(count);
  }

  /// Count at sample h, the first of the half; valid once add() or finish() was called
  std::int64_t first() const { return first_; }

  /// Whether the count only approaches the target in the last half: sgn(target − c_k) is the same for all k ≥
  /// h, and |target − c_k| ≤ |target − c_h|.
  bool only_approaches(std::int64_t target) const;

  double amplitude() const;                 ///< Amplitude of the count's oscillation, (c_max − c_min)/2,
                                            /// < counts
  double period(double sample_time) const;  ///< Mean period of the count's oscillation, s; NaN for fewer than
                                            /// < two upward crossings.
                                            /// @param sample_time T, s.

 private:
  struct Rise {
    std::int64_t k;
    std::int64_t from;
    std::int64_t to;
  };

  void begin(std::int64_t count);
  void add_rise(const Rise& rise);

  bool begun_{false};
  std::int64_t first_{0};
  std::int64_t min_{0};
  std::int64_t max_{0};
  std::vector<Rise> rises_;  ///< The rises of the count so far; used as a ring buffer once there are
                             /// < max_rises
  std::size_t oldest_{0};
  std::size_t reserve_{0};
};

}  // namespace zerocount::trial
