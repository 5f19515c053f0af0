#pragma once

#include "tests/benchmarks/peers/cvode_memory.hpp"

namespace zerocount::testing {

/// The rotor on its friction contact, integrated by SUNDIALS CVODE with its root finding.
class CvodePlant {
 public:
  /// @param parameters parameters of the trial; must outlive the plant
  /// @param memory must outlive the plant, and must not be used for another plant meanwhile
  CvodePlant(const trial::TrialParameters& parameters, CvodeMemory& memory);

  /// Applies the torque (N m) from now on.
  void set_torque(double torque);
  /// Advances the motion by `duration` (s).
  /// @throws std::runtime_error if the integration fails
  void advance(double duration);

  double theta() const { return contact().theta(now_); }  ///< Rotor angle θ, rad
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
  double clock_{0.0};  ///< time since the last restart of the integration, s
  /// The rotor's torque was the same at the last sample, so that the integration need not be restarted.
  bool stood_{false};
};

}  // namespace zerocount::testing
