#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/basis/document/description.hpp"
#include "analysis/record/fit/model.hpp"
#include "analysis/record/fit/record.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::fit {

/// The report of all kinds of identification, and its description in their answers.

enum class EstimateStatus {
  estimated,  ///< The value was estimated from the records.
  known,      ///< The user has given the value.
  /// The records do not determine the parameter, and the fit was repeated with a fixed value. Only the time
  /// offset is kept, at 0: the torque acts with the delay that the record states.
  kept,
  not_identifiable  ///< The records do not determine the parameter.
};

/// Estimate of one parameter in its own unit, with the 95 % interval. All four numbers are NaN if the
/// parameter is not identifiable. The standard error is 0 if the parameter is known or kept.
struct ParameterEstimate : QuantityEstimate {
  std::string name;
  std::string key;  ///< Manifest key of the parameter; empty if it has none.
  std::string unit;
  EstimateStatus status{EstimateStatus::not_identifiable};
  /// Reason why the parameter is not identifiable, or was kept fixed; otherwise empty.
  std::string reason{};
};

inline bool is_estimated(const ParameterEstimate& parameter) {
  return parameter.status == EstimateStatus::estimated;
}

/// Marks a parameter as not identifiable for this reason, and sets its numbers to NaN.
void leave_open(ParameterEstimate& parameter, std::string reason);

/// The parameters that were identified from records of one axis.
struct FitReport {
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  std::vector<ParameterEstimate> parameters;
  std::string fragment;  ///< Lines for a manifest with the identified parameters, see fragment_text().
};

/// Name and size of a record, and the readings that were left out of it.
struct RecordExtent {
  std::string name;
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  std::size_t samples{0};
  std::size_t excluded{0};  ///< Number of masked samples, which the fit does not use.
  std::string note{};       ///< Note on what was cut out of the record; empty if nothing was.
};

RecordExtent extent_of(const TestRecord& record);

/// Description of an estimate: name, key, unit and status of the parameter, and the numbers in that unit.
document::Description<ParameterEstimate> estimate_description();

/// Description of a report: the kind of axis, the table of the estimates, and a sentence on each parameter
/// that is not identifiable.
document::Description<FitReport> estimates_description();

/// Text of the 95 % interval: "109.98 to 110.02", with as many digits as the interval justifies; null if the
/// parameter is not estimated.
std::optional<std::string> interval_text(const ParameterEstimate& estimate);

/// A sentence on each parameter that is not identifiable, on a line of its own.
std::string missing_parameters_text(std::span<const ParameterEstimate> parameters);

/// Creates an item of an answer that is shown to people only and does not appear in data output.
inline document::Item for_people(const char* key, const char* heading, bool numeric = true) {
  return {.key = key, .heading = heading, .shown = document::Visibility::to_people, .numeric = numeric};
}

/// Text of a length on an axis with its unit: "1.23e-06 m".
/// @param axis kind of the axis: rad for rotary, m for linear
std::string length_text(double length, parameters::AxisKind axis);

/// The item of an answer that states the kind of axis, with the words of parameters::axis_labels.
document::Item axis_item();

/// The item of an answer that holds a fragment of a manifest.
document::Item fragment_item();

/// A fragment of a manifest with identified parameters: the maps `plant` and `friction`, for a linear axis
/// preceded by `axis`.
struct Fragment {
  std::vector<std::string> records;  ///< Names of the records from which the parameters were identified.
  /// Comment lines with remarks, which follow the sentence on the intervals; ends with a newline.
  std::string remarks;
  std::string plant;     ///< Text of the lines of the map `plant`, for example from manifest_lines().
  std::string friction;  ///< Text of the lines of the map `friction`.
  const char* source{"Identified from"};
};

/// The text of a manifest fragment; ends with a newline. A map whose lines are all comments is written as a
/// comment itself.
std::string fragment_text(const Fragment& fragment, parameters::AxisKind axis);

/// The comment line that states that the model does not explain the residuals; empty if it does.
/// @param explained whether the model explains them
std::string lack_of_fit_comment(bool explained);

/// The manifest lines of those parameters whose keys are in the map `group`, "plant" or "friction".
std::string manifest_lines(std::span<const ParameterEstimate> parameters, const std::string& group);

/// The manifest line with the key `name` for a parameter; ends with a newline. For an estimated parameter it
/// gives a distribution whose central 95 % are the interval, for a known or kept parameter the value,
/// otherwise a comment.
///
/// Positive parameters are lognormal. n has a normal distribution truncated below 1, coulomb_ratio one
/// truncated to 0 … 1.
std::string manifest_line(const ParameterEstimate& parameter, const std::string& name);

/// The distribution of one estimated parameter, as text for a manifest.
std::string distribution_text(const ParameterEstimate& parameter);

/// Text of `value` with one digit more than the half-width of the parameter's interval justifies.
std::string with_digits(double value, const ParameterEstimate& parameter);

/// A number for a manifest, with two digits more than the relative uncertainty justifies; with all digits if
/// the uncertainty is 0. It has a decimal point and a sign of the exponent, because some YAML readers take
/// 2e5 and 2.0e5 for texts.
std::string manifest_number(double value, double relative_uncertainty);

}  // namespace zerocount::fit
