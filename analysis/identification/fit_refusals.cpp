#include "analysis/identification/fit_refusals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/identification/contact_fit.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::identification {

namespace {

/// Maximum residual, as a fraction of a record's travel.
constexpr double max_unexplained = 0.02;

/// Maximum residual spread, as a multiple of the expected one.
constexpr double max_spread = 30.0;

/// Hint if the search stopped at its effort limit.
std::string early_end_text(const ContactFit& fit) {
  if (!has_ended_early(fit)) return "";
  return ". " + left_out_text(fit.effort);
}

/// @throws Failure (bad_data) with the words and units of the record's axis.
[[noreturn]] void refuse(const TestRecord& record, const std::string& reason) {
  throw Failure(ExitCode::bad_data, record.name + ": " + parameters::text_on(record.axis, reason));
}

}  // namespace

std::string left_out_text(double effort) {
  return fmt::format("Other starting points were left out to save time: --effort {:g} tries more of them",
                     4.0 * effort);
}

void refuse_glitches(Records records, const FitPoint& point, const FitSetting& setting) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    const TestRecord& record = records[r];
    Eigen::VectorXd path = modelled_path(record, setting.model, point.axis);
    path.array() += point.offset[static_cast<Eigen::Index>(r)];
    const std::optional<std::size_t> glitch = record_fit::find_glitch(record, path);
    if (!glitch) continue;
    refuse(record,
           fmt::format(
               "the reading at sample {} ({:.6g} s) is off by {:.3g} $rad, those before and after it are "
               "not, probably a read error. Replace it by a neighbouring value, or shorten the record",
               *glitch, static_cast<double>(*glitch) * record.sample_time,
               (record.reading[*glitch] - path[static_cast<Eigen::Index>(*glitch)]) * record.unit));
  }
}

void refuse_unexplained(Records records, const ContactFit& fit, double tolerance) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    const auto [low, high] = std::minmax_element(records[r].reading.begin(), records[r].reading.end());
    const double allowed = std::max(records[r].counted ? 2.0 : 0.0, max_unexplained * (*high - *low));
    if (fit.misfit[r] <= tolerance * allowed) continue;
    const std::size_t sample = record_fit::largest_misfit_growth(records[r], fit.model.motions[r].path);
    refuse(
        records[r],
        fmt::format("the pre-sliding model does not explain this record: its residuals are {:.3g} $rad (root "
                    "mean square) of a travel of {:.3g} $rad, and grow most at {:.4g} s. Did the axis slide, "
                    "was the $torque clipped, is the contact not as it was said to be at the start? --model "
                    "all compares other friction laws{}",
                    fit.misfit[r] * records[r].unit, (*high - *low) * records[r].unit,
                    static_cast<double>(sample) * records[r].sample_time, early_end_text(fit)));
  }
}

void refuse_gross_misfit(Records records, const ContactFit& fit, const record_fit::ResidualChecks& checks,
                         const std::string& cause) {
  if (!(checks.spread > max_spread * checks.expected_spread)) return;
  const auto worst =
      static_cast<std::size_t>(std::max_element(fit.misfit.begin(), fit.misfit.end()) - fit.misfit.begin());
  const std::size_t sample = record_fit::largest_misfit_growth(records[worst], fit.model.motions[worst].path);
  refuse(
      records[worst],
      fmt::format(
          "the pre-sliding model does not explain the records: the residuals are {:.0f} times those that "
          "the encoder's steps and noise give, and grow most at {:.4g} s of this record. Does a record "
          "begin under load, is the $torque of another time than the $angle (--delay), did the axis slide? "
          "{}--model all compares other friction laws{}",
          checks.spread / checks.expected_spread, static_cast<double>(sample) * records[worst].sample_time,
          cause.empty() ? "" : cause + ". ", early_end_text(fit)));
}

namespace {

/// A hold in which the rotor creeps.
struct CreepingHold {
  double torque{0.0};  ///< magnitude, N m
  double creep{0.0};   ///< fitted travel from a quarter of the hold to its end, in units of the readings
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

}  // namespace

namespace {

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

}  // namespace zerocount::identification
