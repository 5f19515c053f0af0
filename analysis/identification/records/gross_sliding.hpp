#pragma once

#include <cstddef>
#include <optional>

#include "analysis/records/raw_series.hpp"

namespace zerocount::identification {

/// A stretch in which the rotor slides, seen from torque and angle.
struct GrossSliding {
  std::size_t first{0};     ///< sample at or shortly before the breakaway
  std::size_t seen{0};      ///< sample at which sliding is certain
  double travel{0.0};       ///< in the window that ends there, in the unit of the series' angle
  double travel_before{0};  ///< maximum − minimum angle before that window, in the same unit
};

/// Finds the first gross sliding of a material test.
///
/// Before the rotor slides, its travel is that of a spring with creep. Elastic travel grows with the range of
/// the torque, creep with its power n. Both are largest at the first visit of a torque. The rotor slides if
///
///   |θ(k) − θ(k − w)| ≥ 5·X·(U₁/U₀)³,
///
/// with the travel X up to the sample k − w, the range U₁ of the torque up to k, and the range U₀ up to
/// k − 3w, so that the rotor has had time to follow. The factor 5 allows for overshoot after a step and for
/// a spring that softens, the exponent for creep with n up to 3. The windows w are 8, 16, 32 … samples, at
/// most a quarter of the record before, so that they have little creep.
///
/// A leap between two samples is a fault of the reading and not motion: no step may be more than half of the
/// travel in the window. Masked readings are replaced by the last one before.
///
/// Not found: slides that are short compared with the travel before, and slides without pre-sliding travel
/// before them.
std::optional<GrossSliding> find_gross_sliding(const records::RawSeries& series);

}  // namespace zerocount::identification
