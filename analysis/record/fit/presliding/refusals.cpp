#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "analysis/record/fit/observations.hpp"
#include "analysis/record/fit/presliding/contact_fit.hpp"
#include "analysis/record/fit/residuals.hpp"

namespace zerocount::fit {
namespace {

/// Largest root mean square of the residuals that is accepted, as a fraction of a record's travel.
constexpr double max_unexplained = 0.02;

/// Largest accepted spread of the residuals, as a multiple of the expected one.
constexpr double max_spread = 30.0;

/// Sentence that tells the user that the search stopped at its effort limit; empty if it did not.
std::string early_end_text(const ContactFit& fit) {
  if (!has_ended_early(fit)) return "";
  return ". " + left_out_text(fit.effort);
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
    const std::optional<std::size_t> glitch = find_glitch(record, path);
    if (!glitch) continue;
    refuse(record.axis, record.name,
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
    const double misfit = misfit_of(records, fit, r);
    if (misfit <= tolerance * allowed) continue;
    const std::size_t sample = largest_misfit_growth(records[r], fit.model.motions[r].path);
    refuse(records[r].axis, records[r].name,
           fmt::format(
               "the pre-sliding model does not explain this record: its residuals are {:.3g} $rad (root "
               "mean square) of a travel of {:.3g} $rad, and grow most at {:.4g} s. Did the axis slide, "
               "was the $torque clipped, did the contact start in another state than was stated? --model "
               "all compares other friction laws{}",
               misfit * records[r].unit, (*high - *low) * records[r].unit,
               static_cast<double>(sample) * records[r].sample_time, early_end_text(fit)));
  }
}

void refuse_gross_misfit(Records records, const ContactFit& fit, const ResidualChecks& checks,
                         const std::string& cause) {
  if (!(checks.spread > max_spread * checks.expected_spread)) return;
  std::size_t worst = 0;
  for (std::size_t r = 1; r < records.size(); ++r)
    if (misfit_of(records, fit, r) > misfit_of(records, fit, worst)) worst = r;
  const std::size_t sample = largest_misfit_growth(records[worst], fit.model.motions[worst].path);
  refuse(records[worst].axis, records[worst].name,
         fmt::format(
             "the pre-sliding model does not explain the records: the residuals are {:.0f} times those that "
             "the encoder's steps and noise give, and grow most at {:.4g} s of this record. Does a record "
             "begin under load, is the $torque delayed against the $angle (--delay), did the axis slide? "
             "{}--model all compares other friction laws{}",
             checks.spread / checks.expected_spread, static_cast<double>(sample) * records[worst].sample_time,
             cause.empty() ? "" : cause + ". ", early_end_text(fit)));
}

}  // namespace zerocount::fit
