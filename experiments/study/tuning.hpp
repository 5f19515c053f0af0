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

/// Margins that the linear loop of every machine must keep, at every stiffness of the contact before it
/// slides. Each is off where it has no value.
struct LoopMargins {
  std::optional<double> gain{6.0};    ///< dB, both ways
  std::optional<double> phase{30.0};  ///< degrees
  std::optional<double> delay{0.5};   ///< samples by which the delay may grow
};

/// The task of `zerocount tune` (`tune`): values of the free parameters that meet the goal of the study and
/// keep the margins, and of these the ones with the smallest criterion.
struct Tuning {
  std::vector<FreeParameter> free{};
  std::string minimise{"band_settling_time.p95"};  ///< the criterion; without [band] of the goal's band
  LoopMargins margins{};
};

}  // namespace zerocount::study
