#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/record/fit/presliding/contact_fit.hpp"
#include "analysis/record/fit/presliding/identification.hpp"

namespace zerocount::fit {

namespace {

using document::in_data;

std::string time_offset_text(const Identification& identification) {
  if (identification.parameters.empty() || identification.parameters.back().name != "time_offset") return "";
  const ParameterEstimate& offset = identification.parameters.back();
  const auto in_us = [&](double samples) { return 1e6 * identification.sample_time * samples; };
  switch (offset.status) {
    case EstimateStatus::estimated:
      return fmt::format(
          "The {} acts {:.4g} us (95 %: {:.4g} to {:.4g} us) later than recorded, which the other intervals "
          "take into account.",
          parameters::text_on(identification.axis, "$torque"), in_us(offset.value), in_us(offset.low),
          in_us(offset.high));
    case EstimateStatus::kept:
      return fmt::format(
          "The time offset is kept at {:g} samples, because {}. The other intervals hold if that is right.",
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
  return fmt::format("Errors correlate strongly: {}. --posterior writes joint draws.",
                     fmt::join(pairs, ", "));
}

std::string checks_text(const ResidualChecks& checks) {
  std::string text = fmt::format(
      "Residuals of {} observations, beside those of records made up from the fit:\n"
      "  spread {:.3f}, expected {:.3f}: as large by chance in {:.1f} %\n"
      "  runs of one sign {:.0f}, expected {:.0f}: as far off by chance in {:.1f} %\n",
      checks.observations, checks.spread, checks.expected_spread, 100.0 * checks.spread_chance, checks.runs,
      checks.expected_runs, 100.0 * checks.runs_chance);
  if (checks.passed) return text + "  They are what the encoder's steps and noise explain.\n";
  return text + fmt::format(
                    "  These values are not to be trusted. The intervals were widened by the factor {:.3g}, "
                    "and hold only as far as the model does.\n",
                    checks.widening);
}

std::string headline_of(const Identification& identification) {
  if (!identification.checks.passed)
    return fmt::format("LACK OF FIT: {}", reason_of_misfit(identification.checks));
  return fmt::format("the model explains the records: {} of {} parameters are estimated",
                     std::ranges::count_if(identification.parameters, is_estimated),
                     identification.parameters.size());
}

document::Description<RecordSummary> record_description() {
  constexpr auto digits = document::Notation::three_digits;
  return document::Description<RecordSummary>()
      .value({"name", "record", "file, and part of it"},
             [](const RecordSummary& r) { return text::printable(r.name); })
      .value({"samples", "samples", "samples of the record"}, &RecordSummary::samples)
      .value({"duration", "duration", "its duration", "s"}, &RecordSummary::duration)
      .value(in_data("counted", "whether it is read in counts"), &RecordSummary::counted)
      .value(in_data("unit", "size of a unit of the readings, rad or m"), &RecordSummary::unit)
      .value({.key = "unit_text", .heading = "read in", .shown = document::Visibility::to_people},
             [](const RecordSummary& r) {
               return fmt::format("{} of {:.6g} {}", r.counted ? "counts" : "units", r.unit,
                                  parameters::unit_on(r.axis, "rad"));
             })
      .value({"branches", "branches", "slow branches of the torque"}, &RecordSummary::branches)
      .value({"reversals", "reversals", "reversals of the torque"}, &RecordSummary::reversals)
      .value({"holds", "holds", "stretches of constant torque"}, &RecordSummary::holds)
      .value({"ring_downs", "ring-downs", "oscillations that die out after a step"},
             &RecordSummary::ring_downs)
      .value({"misfit", "residual rms", "root mean square of the residuals, in units of the readings", "",
              digits},
             &RecordSummary::misfit)
      .value({"noise", "noise", "standard deviation of the readings, in their unit", "", digits},
             &RecordSummary::noise)
      .value({"excluded", "masked", "samples masked by --exclude"}, &RecordSummary::excluded)
      .value({"note", "cut", "what was cut out of it"},
             [](const RecordSummary& r) { return text::printable(r.note); });
}

document::Description<ResidualChecks> checks_description() {
  using Checks = ResidualChecks;
  return document::Description<Checks>()
      .value(in_data("observations", "residuals"), &Checks::observations)
      .value(in_data("spread", "root mean square of the residuals over their standard deviations", "1"),
             &Checks::spread)
      .value(in_data("expected_spread", "its mean over the replicates", "1"), &Checks::expected_spread)
      .value(in_data("spread_chance", "proportion of replicates with at least this spread", "1"),
             &Checks::spread_chance)
      .value(in_data("runs", "runs of one sign"), &Checks::runs)
      .value(in_data("expected_runs", "their mean over the replicates"), &Checks::expected_runs)
      .value(in_data("runs_chance", "proportion of replicates at least as far off", "1"),
             &Checks::runs_chance)
      .value(in_data("correlation_length", "correlation length of the residuals, in residuals"),
             &Checks::correlation_length)
      .value(in_data("expected_correlation_length", "its mean over the replicates"),
             &Checks::expected_correlation_length)
      .value(in_data("passed", "whether encoder and noise explain the residuals"), &Checks::passed)
      .value(in_data("reason", "what they do not explain; null: nothing"),
             [](const Checks& checks) {
               return checks.passed ? std::optional<std::string>() : reason_of_misfit(checks);
             })
      .value(in_data("widening", "factor that widened the intervals", "1"), &Checks::widening);
}

using Matrix = std::vector<std::vector<double>>;

/// [row][column] A square matrix over the estimated parameters, as nested vectors for the answer.
/// @param value function that returns the element of a row and a column
template <class Value>
Matrix matrix_of(const JointErrors& errors, Value value) {
  const auto size = static_cast<std::size_t>(errors.covariance.rows());
  Matrix matrix(size, std::vector<double>(size));
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j)
      matrix[i][j] = value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  return matrix;
}

document::Description<JointErrors> errors_description() {
  return document::Description<JointErrors>()
      .value(in_data("parameters", "names, in the order of the matrices"), &JointErrors::names)
      .value(
          in_data(
              "covariance",
              "covariance of the errors of the logarithms; for n and the time offset: of the errors themselves"),
          [](const JointErrors& e) {
            return matrix_of(e, [&](auto i, auto j) { return e.covariance(i, j); });
          })
      .value(in_data("correlation", "correlation of the errors whose covariance is given", "1"),
             [](const JointErrors& e) {
               return matrix_of(e, [&](auto i, auto j) { return e.correlation(i, j); });
             });
}

struct LineOfRecord {
  std::string record;
  double frequency;
};

std::optional<LineOfRecord> line_of(const Identification& identification) {
  if (!identification.residual_line) return {};
  const ResidualLine& line = *identification.residual_line;
  return LineOfRecord{text::printable(identification.records[line.record].name), line.frequency};
}

}  // namespace

std::string second_mass_text(const Identification& identification) {
  if (!identification.residual_line) return "";
  const ResidualLine& line = *identification.residual_line;
  return fmt::format(
      "The residuals of the ring-downs of {} have a spectral line at {:.3g} Hz; the fitted axis itself "
      "rings at {:.3g} to {:.3g} Hz. A second mass on a spring is likely, such as a load (plant.load), "
      "a coupling or the base",
      text::printable(identification.records[line.record].name), line.frequency,
      identification.own_ringing.low, identification.own_ringing.high);
}

document::AnswerDescription<Identification> identification_answer() {
  using Correlation = Identification::Correlation;
  document::AnswerDescription<Identification> answer{
      {.name = "identify",
       .meaning = "friction, damping and inertia from material tests",
       .csv_table = "parameters"},
      {}};
  answer.items.headline(headline_of)
      .include(estimates_description(), [](const Identification& i) -> const FitReport& { return i; })
      .value(in_data("sample_time", "time between samples of the first record", "s"),
             &Identification::sample_time)
      .sentence(time_offset_text)
      .table(in_data("correlations", "pairs of parameters whose errors correlate by 0.9 and more"),
             document::Description<Correlation>()
                 .value(in_data("one", "a parameter"), &Correlation::one)
                 .value(in_data("other", "the other one"), &Correlation::other)
                 .value(in_data("value", "correlation of their errors", "1"), &Correlation::value),
             &Identification::correlations)
      .sentence(correlations_text)
      .object(in_data("errors", "joint errors of the estimates"), errors_description(),
              &Identification::errors)
      .table({"records", "Records", "what each record has of the tests"}, record_description(),
             &Identification::records)
      .object(in_data("residuals", "checks of the residuals"), checks_description(), &Identification::checks)
      .sentence([](const Identification& i) { return checks_text(i.checks); })
      .object(in_data("residual_line", "spectral line of the residuals that a second mass may make"),
              document::Description<LineOfRecord>()
                  .value(in_data("record", "record with the line"), &LineOfRecord::record)
                  .value(in_data("frequency", "its frequency", "Hz"), &LineOfRecord::frequency),
              line_of)
      .sentence([](const Identification& i) { return i.residual_line ? second_mass_text(i) + "." : ""; })
      .value(in_data("search_ended", "whether the search ended because of --effort"),
             &Identification::search_ended)
      .sentence([](const Identification& i) { return i.search_ended ? left_out_text(i.effort) + "." : ""; })
      .value(fragment_item(), &Identification::fragment);
  return answer;
}

}  // namespace zerocount::fit
