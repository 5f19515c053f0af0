#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/fit/model.hpp"
#include "analysis/fit/record.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::fit {

/// The report of all kinds of identification, and its description in their answers.

enum class EstimateStatus {
  estimated,        ///< from the records
  known,            ///< given by the user
  kept,             ///< the records do not determine it, and the fit kept the given value
  not_identifiable  ///< the records do not determine it
};

/// Estimate of one parameter in its own unit, with its 95 % interval; all four numbers are NaN if it is not
/// identifiable, and the standard error is 0 if it is known or kept.
struct ParameterEstimate : QuantityEstimate {
  std::string name;
  std::string key;  ///< in a manifest; empty: it has none
  std::string unit;
  EstimateStatus status{EstimateStatus::not_identifiable};
  std::string reason{};  ///< why it is not identifiable, or kept
};

inline bool is_estimated(const ParameterEstimate& parameter) {
  return parameter.status == EstimateStatus::estimated;
}

/// Makes a parameter not identifiable.
void leave_open(ParameterEstimate& parameter, std::string reason);

/// The parameters that were identified from records of one axis.
struct FitReport {
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  std::vector<ParameterEstimate> parameters;
  std::string fragment;  ///< see fragment_text()
};

/// A record, and what was left out of it.
struct RecordExtent {
  std::string name;
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  std::size_t samples{0};
  std::size_t excluded{0};  ///< masked samples
  std::string note{};       ///< what was cut out of it; empty: nothing
};

RecordExtent extent_of(const TestRecord& record);

/// An estimate: its name, key, unit and status, and its numbers in that unit.
document::Description<ParameterEstimate> estimate_description();

/// The kind of axis, the table of the estimates, and a sentence on each one that is not identifiable.
document::Description<FitReport> estimates_description();

/// "109.98 to 110.02", with as many digits as the interval justifies; nothing if it is not estimated.
std::optional<std::string> interval_text(const ParameterEstimate& estimate);

/// A sentence on each parameter that is not identifiable, on a line of its own.
std::string missing_parameters_text(std::span<const ParameterEstimate> parameters);

/// An item that data do not have.
inline document::Item for_people(const char* key, const char* heading, bool numeric = true) {
  return {.key = key, .heading = heading, .shown = document::Shown::to_people, .numeric = numeric};
}

/// "1.23e-06 m", a length on an axis.
std::string length_text(double length, parameters::AxisKind axis);

/// The item of the kind of axis; the words of parameters::axis_labels.
document::Item axis_item();

/// The item of a fragment of a manifest.
document::Item fragment_item();

/// A fragment of a manifest with identified parameters: the maps `plant` and `friction`, before them `axis`
/// of a linear axis.
struct Fragment {
  std::vector<std::string> records;  ///< names
  std::string remarks;               ///< after the sentence on the intervals; ends with a newline
  std::string plant;                 ///< lines of the map, such as those of manifest_lines()
  std::string friction;
  const char* source{"Identified from"};
};

/// The text of a fragment; ends with a newline. A map whose lines are all comments is a comment, too.
std::string fragment_text(const Fragment& fragment, parameters::AxisKind axis);

/// The comment on a lack of fit, on a line of its own; empty if the model explains the residuals.
std::string lack_of_fit_comment(bool explained);

/// The lines of the parameters whose keys are in the map `group`, "plant" or "friction".
std::string manifest_lines(std::span<const ParameterEstimate> parameters, const std::string& group);

/// The line `name`: of a parameter in its map of a manifest: for an estimated one a distribution whose
/// central 95 % are its interval, for a given one its value, for another a comment. Ends with a newline.
///
/// Positive parameters are lognormal, n is a truncated normal from 1, and coulomb_ratio one from 0 to 1.
std::string manifest_line(const ParameterEstimate& parameter, const std::string& name);

/// The distribution of one estimated parameter in the fragment.
std::string distribution_text(const ParameterEstimate& parameter);

/// `value` with one digit more than the half-width of the parameter's interval justifies.
std::string with_digits(double value, const ParameterEstimate& parameter);

/// A number for a manifest, with two digits more than its relative uncertainty justifies; all digits if that
/// is 0. It has a decimal point and a sign of the exponent, because some YAML readers take 2e5 and 2.0e5 for
/// texts.
std::string manifest_number(double value, double relative_uncertainty);

}  // namespace zerocount::fit
