#pragma once

#include "tests/benchmarks/peers/cvode_memory.hpp"

namespace zerocount::testing {

/// The plant by SUNDIALS CVODE with its root finding.
class CvodePlant {
 public:
  /// @param parameters, memory must outlive the plant, and the memory serve no other meanwhile.
  CvodePlant(const trial::TrialParameters& parameters, CvodeMemory& memory);

  /// Applies the torque (N m) from now on.
  void set_torque(double torque);
  /// Moves on by `duration` (s).
  /// @throws std::runtime_error where the motion cannot be followed.
  void advance(double duration);

  double theta() const { return contact().theta(now_); }  ///< rad
  const PeerState& state() const { return now_; }
  const PeerContact& contact() const { return system_.contact(); }
  PeerContact& contact() { return system_.contact(); }

 private:
  void restart();
  void limit_step();
  PeerEvent earliest_event();

  CvodeSystem system_;
  CvodeMemory& memory_;
  PeerState now_{};
  double clock_{0.0};  ///< s since the last restart
  bool stood_{false};  ///< the torque did not change at the last sample
};

}  // namespace zerocount::testing
