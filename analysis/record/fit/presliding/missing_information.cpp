#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/record/fit/presliding/contact_fit.hpp"

namespace zerocount::fit {
namespace {

/// A part of a record with constant torque in which the rotor creeps.
struct CreepingHold {
  double torque{0.0};  ///< Magnitude of the torque, N m.
  /// Fitted creep travel from a quarter of the hold to its end, in units of the readings.
  double creep{0.0};
};

std::vector<CreepingHold> creeping_holds(Records records, const ContactFit& fit) {
  std::vector<CreepingHold> holds;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd& path = fit.model.motions[r].path;
    for (const TorqueHold& hold : records[r].parts.holds) {
      const std::size_t settled = hold.first + (hold.last - hold.first) / 4;
      const double creep =
          path[static_cast<Eigen::Index>(hold.last)] - path[static_cast<Eigen::Index>(settled)];
      holds.push_back({std::abs(hold.torque), std::abs(creep)});
    }
  }
  return holds;
}

std::string of_spring(const ContactFit& fit, Records records) {
  const double softening = std::exp(-fit.model.point.axis[log_beta]) / records.front().unit;
  return fmt::format(
      "the readings show too little of how the spring softens after a reversal (within about "
      "{:.2g} of their steps): reverse more often, or read finer",
      softening);
}

std::string of_ring_down(Records records) {
  if (std::none_of(records.begin(), records.end(),
                   [](const TestRecord& record) { return record.parts.ring_downs() > 0; })) {
    return "there is no ring-down: the $torque never steps (by 5 % of its range within 8 samples) and then "
           "stays";
  }
  return "the ring-downs are too small, or die out too fast for the sampling, to show it";
}

std::string of_creep(const std::vector<CreepingHold>& holds, Coordinate coordinate) {
  if (holds.empty())
    return "the $torque is never held (for 20 samples or more), and so creep is not seen alone";
  double max_creep = 0.0;
  for (const CreepingHold& hold : holds) max_creep = std::max(max_creep, hold.creep);
  constexpr double min_creep = 2.0;
  if (max_creep < min_creep) {
    return fmt::format("the axis creeps by {:.2g} steps of the readings at most while the torque is held",
                       max_creep);
  }
  double low = 0.0;
  double high = 0.0;
  for (const CreepingHold& hold : holds) {
    if (hold.creep < min_creep) continue;
    if (low == 0.0 || hold.torque < low) low = hold.torque;
    high = std::max(high, hold.torque);
  }
  constexpr double one_level = 1.1;
  if (coordinate != log_alpha && high < one_level * low) {
    return fmt::format("creep is seen at one $torque only, {:.3g} $Nm: hold another, or give friction.n",
                       high);
  }
  return "the holds are too short, or too much alike, to show the course of creep";
}

std::string of_time_offset() {
  return "the $torque changes too slowly for the readings to show it: record a step, or give it with "
         "--fix time_offset=0";
}

std::string missing(Records records, const ContactFit& fit, Coordinate coordinate) {
  switch (coordinate) {
    case log_k1:
    case log_k2:
    case log_beta:
      return of_spring(fit, records);
    case log_damping:
    case log_inertia:
      return of_ring_down(records);
    case log_alpha:
    case log_limit:
    case creep_exponent:
      break;
    case time_offset:
      return of_time_offset();
  }
  return of_creep(creeping_holds(records, fit), coordinate);
}

}  // namespace

std::string missing_information(Records records, const ContactFit& fit, Coordinate coordinate) {
  return parameters::text_on(records.front().axis, missing(records, fit, coordinate));
}

}  // namespace zerocount::fit
