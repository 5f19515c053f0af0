#include "analysis/record/fit/report.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"

namespace zerocount::fit {

namespace {

using document::in_data;

std::string_view to_string(EstimateStatus status) {
  switch (status) {
    case EstimateStatus::estimated:
      return "estimated";
    case EstimateStatus::known:
      return "given";
    case EstimateStatus::kept:
      return "kept";
    case EstimateStatus::not_identifiable:
      break;
  }
  return "not_identifiable";
}

std::optional<std::string> value_text(const ParameterEstimate& estimate) {
  if (estimate.status == EstimateStatus::not_identifiable) return {};
  return with_digits(estimate.value, estimate);
}

/// Text of half the width of the 95 % interval: relative to the value, for the time offset in samples. Null
/// if there is no estimate.
std::optional<std::string> half_width_text(const ParameterEstimate& estimate) {
  if (!is_estimated(estimate)) return {};
  return estimate.name == "time_offset"
             ? fmt::format("{:.2g}", estimate.half_width())
             : fmt::format("{:.2g} %", 100.0 * estimate.half_width() / std::abs(estimate.value));
}

}  // namespace

std::optional<std::string> interval_text(const ParameterEstimate& estimate) {
  if (!is_estimated(estimate)) return {};
  return fmt::format("{} to {}", with_digits(estimate.low, estimate), with_digits(estimate.high, estimate));
}

void leave_open(ParameterEstimate& parameter, std::string reason) {
  parameter.value = parameter.standard_error = parameter.low = parameter.high = statistics::unknown;
  parameter.status = EstimateStatus::not_identifiable;
  parameter.reason = std::move(reason);
}

RecordExtent extent_of(const TestRecord& record) {
  const std::size_t samples = sample_count(record);
  return {record.name, record.axis, samples, samples - used_samples(record), record.note};
}

document::Description<FitReport> estimates_description() {
  return document::Description<FitReport>()
      .value(axis_item(),
             [](const FitReport& report) {
               return parameters::axis_labels.at(static_cast<std::size_t>(report.axis));
             })
      .table({.key = "parameters", .meaning = "the parameters"}, estimate_description(),
             &FitReport::parameters)
      .sentence([](const FitReport& report) { return missing_parameters_text(report.parameters); });
}

document::Description<ParameterEstimate> estimate_description() {
  using Text = std::optional<std::string>;
  return document::Description<ParameterEstimate>()
      .value({"name", "parameter", "name of the parameter"}, &ParameterEstimate::name)
      .value(in_data("key", "dotted path in a manifest; null: it has none"),
             [](const ParameterEstimate& p) { return p.key.empty() ? Text() : p.key; })
      .value(for_people("value_text", "value"), value_text)
      .value({"unit", "unit", "unit of its numbers"}, &ParameterEstimate::unit)
      .value(with_words(in_data("status", "whether the records determine it"),
                        {"estimated", "given", "kept", "not_identifiable"}),
             [](const ParameterEstimate& p) { return to_string(p.status); })
      .value(in_data("value", "estimate, in the unit"), &ParameterEstimate::value)
      .value(in_data("standard_error", "its standard error, in the unit"), &ParameterEstimate::standard_error)
      .value(in_data("low", "lower end of its 95 % interval, in the unit"), &ParameterEstimate::low)
      .value(in_data("high", "upper end of its 95 % interval, in the unit"), &ParameterEstimate::high)
      .value(for_people("interval", "95 % interval"), interval_text)
      .value(for_people("half_width", "±"), half_width_text)
      .value(for_people("status_text", "status", false),
             [](const ParameterEstimate& p) {
               return p.status == EstimateStatus::not_identifiable ? "not identifiable" : to_string(p.status);
             })
      .value({.key = "reason",
              .meaning = "why it is not identifiable, or kept",
              .shown = document::Visibility::in_data,
              .optional = true},
             [](const ParameterEstimate& p) { return p.reason.empty() ? Text() : p.reason; })
      .value({.key = "distribution",
              .meaning = "distribution in a manifest whose central 95 % are the interval",
              .shown = document::Visibility::in_data,
              .optional = true},
             [](const ParameterEstimate& p) {
               return is_estimated(p) && !p.key.empty() ? distribution_text(p) : Text();
             });
}

std::string missing_parameters_text(std::span<const ParameterEstimate> parameters) {
  std::string text;
  for (const ParameterEstimate& parameter : parameters) {
    if (parameter.status != EstimateStatus::not_identifiable) continue;
    text += fmt::format("{} is not identifiable from this, because {}.\n", parameter.name, parameter.reason);
  }
  return text;
}

std::string length_text(double length, parameters::AxisKind axis) {
  return fmt::format("{:.3g} {}", length, parameters::unit_on(axis, "rad"));
}

document::Item axis_item() {
  return with_words(in_data("axis", "kind of axis"),
                    {parameters::axis_labels.begin(), parameters::axis_labels.end()});
}

document::Item fragment_item() {
  return {.key = "manifest",
          .heading = "To paste into a manifest",
          .meaning = "the parameters as a fragment of a manifest",
          .verbatim = true};
}

}  // namespace zerocount::fit
