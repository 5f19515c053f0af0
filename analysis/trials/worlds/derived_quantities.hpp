#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/worlds/world_rule.hpp"
#include "core/friction/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::worlds {

/// A property of a friction contact that follows from several of its parameters. A record shows it more
/// directly than each parameter, because k1, k2, β, α, λ and n are coefficients of a law; the unit of λ even
/// depends on n.
struct DerivedQuantity {
  std::string_view name;
  std::string_view unit;     ///< Unit on a rotary axis.
  std::string_view meaning;  ///< Formula in words, with the placeholders of parameters::text_on().
  /// Parameter that the command `zerocount identify` estimates from the same kind of record, see record_of().
  std::string_view parameter;
  bool (*exists)(friction::FrictionModel model);
  /// Computes the quantity in `unit`.
  /// @param torque torque that the contact carries at rest, N m, above 0
  double (*value)(const friction::FrictionParameters& contact, double torque);
};

/// The table of all derived quantities.
std::span<const DerivedQuantity> derived_quantities();

/// The derived quantities that differ between the worlds (draws of what all machines share and nobody knows)
/// at a design point, each of the median machine of every world: all that differs between machines has the
/// quantile ½. One common torque is taken for all worlds, the root mean square of what contacts carry at the
/// end of a move: the holding torque and the constant disturbance.
/// @param holding_torque statistics of the holding torque at this design point
std::vector<WorldInput> derived_of_worlds(const study::Study& study, std::int64_t point,
                                          const measures::MeasureStatistics& holding_torque);

}  // namespace zerocount::worlds
