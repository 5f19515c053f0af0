#pragma once

#include <vector>

namespace zerocount::motion {

/// The plant at t = 0, where θ = 0.
struct PlantStart {
  double position{0.0};   ///< rotor angle of θ = 0 on the friction profiles, rad
  double hardening{0.0};  ///< xh of the contact, rad
  double preload{0.0};    ///< torque of a slow load-and-unload from virgin before t = 0, without creep, N m
  /// Torques (N m) reached slowly and without creep after the preload, in this order, then 0 again. Absolute
  /// values below the breakaway torque.
  std::vector<double> history{};
  double velocity{0.0};  ///< ω, rad/s
  /// Arrival from sliding: if velocity ≠ 0 the hook slides, and the spring had the breakaway torque when the
  /// slide began. Hardening, preload, history and holding then have no effect. A Coulomb contact slides
  /// whenever velocity ≠ 0, also without this.
  bool sliding{false};
  /// Torque (N m) to which the virgin contact has been loaded slowly and without creep, and which it carries
  /// at t = 0; not beside a preload or a history.
  double holding{0.0};
};

}  // namespace zerocount::motion
