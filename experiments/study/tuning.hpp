#pragma once

#include <optional>
#include <string>
#include <vector>

namespace zerocount::study {

/// A parameter that tuning may change.
struct FreeParameter {
  std::string name;         ///< dotted path, e.g. "controller.ki"
  std::string unit{"1"};    ///< in the manifest; "1" if dimensionless
  double low{0.0};          ///< lowest value
  double high{0.0};         ///< highest value
  bool logarithmic{false};  ///< sought on a logarithmic scale; low is above 0
  bool whole{false};        ///< takes whole numbers only
};

/// Machines of the margins differ from those that the study draws by up to these parts, both ways, in all
/// combinations: what a data sheet does not tell exactly. Only of what the study does not draw. Each is off
/// where it has no value.
struct LoopSpread {
  std::optional<double> inertia{};          ///< of plant.inertia, and of the load
  std::optional<double> damping{};          ///< of the contact's damping, before sliding and while sliding
  std::optional<double> torque_constant{};  ///< of the torque, or force, that a code makes
};

/// Spread that data sheets usually leave open.
constexpr LoopSpread typical_spread{.inertia = 0.1, .damping = 0.3, .torque_constant = 0.05};

/// Margins that the linear loop of every machine must keep, at every stiffness of the contact before it
/// slides. Each is off where it has no value.
struct LoopMargins {
  std::optional<double> gain{6.0};      ///< dB, both ways
  std::optional<double> phase{30.0};    ///< degrees
  std::optional<double> delay{0.5};     ///< samples by which the delay may grow
  std::optional<double> sensitivity{};  ///< largest |S|, S = 1/(1 + L)
  LoopSpread spread{};
};

/// What is accepted when a loop is commissioned: 6 dB, 45°, a sensitivity of at most 1.6, a sample of delay,
/// of machines with a typical spread.
constexpr LoopMargins commissioning_margins{
    .gain = 6.0, .phase = 45.0, .delay = 1.0, .sensitivity = 1.6, .spread = typical_spread};

/// The task of `zerocount tune` (`tune`): values of the free parameters that meet the goal of the study and
/// keep the margins, and of these the ones with the smallest criterion.
struct Tuning {
  std::vector<FreeParameter> free{};
  std::string minimise{"band_settling_time.p95"};  ///< the criterion; without [band] of the goal's band
  LoopMargins margins{};
};

}  // namespace zerocount::study
