#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/numerics/sign.hpp"
#include "core/trial/outcome.hpp"

namespace zerocount::trial {

/// Counts the jerks of one move. A jerk is an excursion from the target after arrival: a maximal run of
/// samples with error e ≠ 0, after the error has first stayed 0 for the dwell time.
class Jerks {
 public:
  explicit Jerks(std::int64_t move = 0, double sample_time = 0.0) : move_(move), sample_time_(sample_time) {}

  /// Takes the error (counts) at sample k, which lies after the arrival. Samples with error 0 may be left out
  /// while no jerk lasts.
  /// @returns whether a jerk ended before this sample; then last() returns it.
  bool add(std::int64_t k, std::int64_t error) {
    if (error == 0) return end(k);
    if (!in_jerk_) {
      in_jerk_ = true;
      start_ = k;
      jerk_ = {move_, static_cast<double>(k) * sample_time_, 0.0, 0, -numerics::sign_of(error)};
    }
    jerk_.magnitude = std::max(jerk_.magnitude, std::abs(error));
    return false;
  }

  /// Ends the present jerk, if one lasts, before sample k.
  /// @returns whether there was one.
  bool end(std::int64_t k) {
    if (!in_jerk_) return false;
    in_jerk_ = false;
    jerk_.duration = static_cast<double>(k - start_) * sample_time_;
    samples_ += k - start_;
    ++(jerk_.direction > 0 ? up_ : down_);
    return true;
  }

  bool in_jerk() const { return in_jerk_; }
  const Jerk& last() const { return jerk_; }
  std::int64_t count() const { return up_ + down_; }  ///< Number of jerks that have ended
  std::int64_t up() const { return up_; }             ///< Number of ended jerks in the positive direction
  std::int64_t down() const { return down_; }         ///< Number of ended jerks in the negative direction
  std::int64_t samples() const { return samples_; }   ///< Number of samples in all ended jerks

 private:
  std::int64_t move_;
  double sample_time_;
  Jerk jerk_;
  bool in_jerk_{false};
  std::int64_t start_{0};
  std::int64_t up_{0};
  std::int64_t down_{0};
  std::int64_t samples_{0};
};

}  // namespace zerocount::trial
