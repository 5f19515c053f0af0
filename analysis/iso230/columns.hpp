#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/iso230/point_statistics.hpp"
#include "analysis/iso230/repeatability.hpp"
#include "analysis/iso230/trial_values.hpp"
#include "results/layout/layout.hpp"

/// The columns of the tables of the group /repeatability of a results file: of values for every source in the
/// order of deviation_sources() and axis_fields() or target_fields(), of points for every statistic of these
/// in the order of value_statistic_fields(). The tables, the CSV summary and the export have them from here.
namespace zerocount::iso230 {

/// A column of numbers.
template <typename Row>
struct RepeatabilityColumn {
  std::string_view source;  ///< name of the source; empty where the numbers are from none
  std::string name;
  std::string_view unit;
  std::string long_name;
  std::function<double(const Row&, std::size_t)>
      value;  ///< of a row and target; target 0 where there is none
};

template <typename Row>
using RepeatabilityColumns = std::vector<RepeatabilityColumn<Row>>;

/// A trial as a row of the tables of trials.
struct SequenceTrial {
  std::vector<double> positions;             ///< [target], counts
  std::optional<TrialRepeatability> values;  ///< none where a move is nonfinite
};

/// The values of the axis, in a trial.
RepeatabilityColumns<SequenceTrial> trial_axis_columns();
/// `position`, then the values of the targets, in a trial.
RepeatabilityColumns<SequenceTrial> trial_target_columns();
/// point_repeatability_fields(), then the statistics of the axis, at a point.
RepeatabilityColumns<PointRepeatability> point_axis_columns();
/// `position_min`, `position_max`, then the statistics of the targets, at a point.
RepeatabilityColumns<PointRepeatability> point_target_columns();

/// /repeatability/trial: `evaluated`, then trial_axis_columns(), [trial].
layout::Table trial_table_of_axis();
/// /repeatability/trial_target: trial_target_columns(), [trial, target].
layout::Table trial_table_of_targets();
/// /repeatability/point: point_axis_columns(), [point].
layout::Table point_table_of_axis();
/// /repeatability/point_target: point_target_columns(), [point, target].
layout::Table point_table_of_targets();

/// The scale by which the deviations are measured.
struct DeviationSource {
  std::string_view name;       ///< "true" or "encoder"
  std::string_view unit;       ///< of the deviations, and of all values made of them
  std::string_view long_name;  ///< ends the long_name of a value
  Repeatability TrialRepeatability::*values;
};

/// The true position, then the encoder.
std::span<const DeviationSource> deviation_sources();

template <typename Values>
struct RepeatabilityField {
  std::string_view name;
  std::string_view symbol;  ///< of the standard
  std::string_view long_name;
  double Values::*value;
};

std::span<const RepeatabilityField<AxisRepeatability>> axis_fields();
std::span<const RepeatabilityField<TargetRepeatability>> target_fields();

}  // namespace zerocount::iso230
