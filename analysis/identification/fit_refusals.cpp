#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "analysis/identification/residual_checks.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::identification {
namespace {

/// Maximum residual, as a fraction of a record's travel.
constexpr double max_unexplained = 0.02;

/// Maximum residual spread, as a multiple of the expected one.
constexpr double max_spread = 30.0;

/// Plausible natural frequencies, Hz. A time in ms or µs instead of s makes the rotor a thousand times
/// slower.
constexpr double min_frequency = 0.5;
constexpr double max_frequency = 2e4;

}  // namespace

void refuse_glitches(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    const TestRecord& record = records[r];
    Eigen::VectorXd path = angle_path(record, point.contact, setting.creep_torque);
    path.array() += point.offset[static_cast<Eigen::Index>(r)];
    const std::optional<std::size_t> glitch = find_glitch(record, path);
    if (!glitch) continue;
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the reading at sample {} ({:.6g} s) is off by {:.3g} rad, those before and "
                    "after it are not: a fault of the reading. Put in what they say, or cut the "
                    "record",
                    record.name, *glitch, static_cast<double>(*glitch) * record.sample_time,
                    (record.reading[*glitch] - path[static_cast<Eigen::Index>(*glitch)]) * record.unit));
  }
}

void refuse_unexplained(std::span<const TestRecord> records, const ContactFit& fit, double tolerance) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    const auto [low, high] = std::minmax_element(records[r].reading.begin(), records[r].reading.end());
    const double allowed = std::max(records[r].counted ? 2.0 : 0.0, max_unexplained * (*high - *low));
    if (fit.misfit[r] <= tolerance * allowed) continue;
    const std::size_t sample = largest_misfit_growth(records[r], fit.model.motions[r].path);
    throw Failure(
        ExitCode::bad_data,
        fmt::format(
            "{}: the pre-sliding model does not explain this record: what it leaves is {:.3g} rad (root "
            "mean square) of a travel of {:.3g} rad, and it parts from the record most at {:.4g} s. Did the "
            "rotor slide, was the torque clipped, is the contact not as it was said to be at the start? "
            "--model all compares other friction laws",
            records[r].name, fit.misfit[r] * records[r].unit, (*high - *low) * records[r].unit,
            static_cast<double>(sample) * records[r].sample_time));
  }
}

void refuse_gross_misfit(std::span<const TestRecord> records, const ContactFit& fit,
                         const ResidualChecks& checks) {
  if (!(checks.spread > max_spread * checks.expected_spread)) return;
  const auto worst =
      static_cast<std::size_t>(std::max_element(fit.misfit.begin(), fit.misfit.end()) - fit.misfit.begin());
  const std::size_t sample = largest_misfit_growth(records[worst], fit.model.motions[worst].path);
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: the pre-sliding model does not explain the records: what it leaves is {:.0f} "
                  "times what the encoder's steps and noise would, and it parts from this record "
                  "most at {:.4g} s. Does a record begin under load, is the torque of another time "
                  "than the angle, did the rotor slide? --model all compares other friction laws",
                  records[worst].name, checks.spread / checks.expected_spread,
                  static_cast<double>(sample) * records[worst].sample_time));
}

void refuse_implausible_frequency(std::span<const TestRecord> records, double k1, double inertia) {
  const bool believed = std::all_of(records.begin(), records.end(),
                                    [](const TestRecord& record) { return record.units_believed; });
  const double frequency = std::sqrt(k1 / inertia) / (2.0 * std::numbers::pi);
  if (believed || std::isnan(frequency) || (frequency >= min_frequency && frequency <= max_frequency)) return;
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: the rotor would swing on its friction with {:.4g} Hz, {} what is plausible "
                  "({:g} to {:g} Hz): is the time in ms or us? If it is right, give --any-magnitude",
                  records.front().name, frequency, frequency < min_frequency ? "below" : "above",
                  min_frequency, max_frequency));
}

}  // namespace zerocount::identification
