#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/identification/fit_refusals.hpp"
#include "analysis/identification/identification.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::identification {
namespace {

std::string left_out_text(const RecordSummary& record) {
  std::string text;
  if (!record.note.empty()) text += fmt::format("    {}\n", record.note);
  if (record.excluded > 0) text += fmt::format("    {} samples masked by --exclude\n", record.excluded);
  return text;
}

std::string record_line(const RecordSummary& record) {
  const std::string noise =
      record.noise > 0.0 ? fmt::format(", noise {:.3g}", record.noise) : std::string(", no noise");
  return fmt::format(
             "  {}: {} samples, {:.4g} s; {} branches, {} reversals, {} holds, {} ring-downs\n"
             "    read in {} of {:.6g} {}{}; the model leaves {:.3g} (root mean square)\n",
             text::printable(record.name), record.samples, record.duration, record.branches, record.reversals,
             record.holds, record.ring_downs, record.counted ? "counts" : "units", record.unit,
             parameters::unit_on(record.axis, "rad"), noise, record.misfit) +
         left_out_text(record);
}

std::string time_offset_text(const Identification& identification) {
  if (identification.parameters.empty() || identification.parameters.back().name != "time_offset") return "";
  const ParameterEstimate& offset = identification.parameters.back();
  const auto in_us = [&](double samples) { return 1e6 * identification.sample_time * samples; };
  switch (offset.status) {
    case EstimateStatus::estimated:
      return fmt::format(
          "The {} acts {:.4g} us (95 %: {:.4g} to {:.4g} us) later than recorded, which the other\n"
          "intervals take into account.\n",
          parameters::text_on(identification.axis, "$torque"), in_us(offset.value), in_us(offset.low),
          in_us(offset.high));
    case EstimateStatus::kept:
      return fmt::format(
          "The time offset is kept at {:g} samples, because {}.\n"
          "The other intervals hold if that is right.\n",
          offset.value, offset.reason);
    case EstimateStatus::known:
    case EstimateStatus::not_identifiable:
      break;
  }
  return "";
}

std::string correlations_text(const Identification& identification) {
  if (identification.correlations.empty()) return "";
  std::vector<std::string> pairs;
  for (const Identification::Correlation& pair : identification.correlations)
    pairs.push_back(fmt::format("{} and {} {:.2f}", pair.one, pair.other, pair.value));
  return fmt::format("Errors correlate strongly: {}. --posterior writes joint draws.\n",
                     fmt::join(pairs, ", "));
}

std::string checks_text(const record_fit::ResidualChecks& checks) {
  std::string text = fmt::format(
      "Residuals of {} observations, beside those of records made up from the fit:\n"
      "  spread {:.3f}, expected {:.3f}: as large by chance in {:.1f} %\n"
      "  runs of one sign {:.0f}, expected {:.0f}: as far off by chance in {:.1f} %\n",
      checks.observations, checks.spread, checks.expected_spread, 100.0 * checks.spread_chance, checks.runs,
      checks.expected_runs, 100.0 * checks.runs_chance);
  if (checks.passed) return text + "  They are what the encoder's steps and noise explain.\n";
  return text + fmt::format(
                    "  LACK OF FIT: {}.\n"
                    "  These values are not to be trusted. The intervals were widened by the factor {:.3g}, "
                    "and hold\n"
                    "  only as far as the model does.\n",
                    reason_of_misfit(checks), checks.widening);
}

}  // namespace

std::string second_mass_text(const Identification& identification) {
  if (!identification.residual_line) return "";
  const record_fit::ResidualLine& line = *identification.residual_line;
  return fmt::format(
      "The residuals of the ring-downs of {} have a spectral line at {:.3g} Hz; the fitted axis itself "
      "rings at {:.3g} to {:.3g} Hz. A second mass on a spring is likely, such as a load (plant.load), "
      "a coupling or the base",
      text::printable(identification.records[line.record].name), line.frequency,
      identification.own_ringing.low, identification.own_ringing.high);
}

std::vector<std::string> estimate_heads() {
  return {"parameter", "value", "unit", "95 % interval", "±", "status"};
}

std::vector<std::string> estimate_row(const ParameterEstimate& parameter) {
  const std::string& name = parameter.name;
  if (parameter.status == EstimateStatus::not_identifiable) {
    return {name, "–", parameter.unit, "–", "–", "not identifiable"};
  }
  const std::string value = with_digits(parameter.value, parameter);
  if (parameter.status == EstimateStatus::known) return {name, value, parameter.unit, "–", "–", "given"};
  if (parameter.status == EstimateStatus::kept) return {name, value, parameter.unit, "–", "–", "kept"};
  const double half_width = 0.5 * (parameter.high - parameter.low);
  const bool relative = parameter.name != "time_offset";
  return {
      name,
      value,
      parameter.unit,
      fmt::format("{} to {}", with_digits(parameter.low, parameter), with_digits(parameter.high, parameter)),
      relative ? fmt::format("{:.2g} %", 100.0 * half_width / std::abs(parameter.value))
               : fmt::format("{:.2g}", half_width),
      "estimated"};
}

std::string identification_text(const Identification& identification) {
  std::vector<std::vector<std::string>> cells{estimate_heads()};
  for (const ParameterEstimate& parameter : identification.parameters)
    cells.push_back(estimate_row(parameter));
  std::string text = text::aligned_table(cells, {false, true, false, true, true, false});
  text += "\n";
  for (const ParameterEstimate& parameter : identification.parameters) {
    if (parameter.status != EstimateStatus::not_identifiable) continue;
    text += fmt::format("{} is not identifiable from this, because {}.\n", parameter.name, parameter.reason);
  }
  text += time_offset_text(identification);
  text += correlations_text(identification);
  text += "Records:\n";
  for (const RecordSummary& record : identification.records) text += record_line(record);
  text += checks_text(identification.checks);
  if (identification.residual_line) text += "  " + second_mass_text(identification) + ".\n";
  if (identification.search_ended) {
    text += "  " + left_out_text(identification.effort) + ".\n";
  }
  return text + "\nTo paste into a manifest:\n\n" + manifest_fragment(identification);
}

}  // namespace zerocount::identification
