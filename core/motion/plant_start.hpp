#pragma once

#include <vector>

namespace zerocount::motion {

/// The plant at t = 0, where θ = 0.
struct PlantStart {
  double position{0.0};   ///< rotor angle of θ = 0 on the friction profiles, rad
  double hardening{0.0};  ///< xh of the contact, rad
  double preload{0.0};    ///< torque of a slow load-and-unload from virgin before t = 0, without creep, N m
  /// Torques reached after the preload, one after the other, slowly and without creep, and then back to 0, N
  /// m. Magnitudes below the breakaway torque.
  std::vector<double> history{};
  double velocity{0.0};  ///< ω, rad/s
  /// Arrival from sliding: where velocity ≠ 0 the hook slides, and the spring had the breakaway torque when
  /// it began to. There is no contact then, so that hardening, preload and history have no effect. A Coulomb
  /// contact slides wherever velocity ≠ 0, whatever stands here.
  bool sliding{false};
};

}  // namespace zerocount::motion
