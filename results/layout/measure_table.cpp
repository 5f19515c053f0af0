#include "results/layout/measure_table.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace zerocount::layout {
namespace {

MeasureTable measures_with(const trial::ErrorBands& bands, const trial::Tolerances& tolerances) {
  MeasureTable measures = move_measures();
  for (std::size_t slot = 0; slot < bands.count; ++slot) {
    for (Measure& measure : measures_of_band(bands, slot)) measures.push_back(std::move(measure));
  }
  for (std::size_t slot = 0; slot < tolerances.count; ++slot)
    for (Measure& measure : measures_of_tolerance(tolerances, slot)) measures.push_back(std::move(measure));
  return measures;
}

/// Names of the measures that come first in a report, in their order; each name appears once.
std::vector<std::string_view> first_of(ReportOrder order) {
  switch (order) {
    case ReportOrder::statistics:
      return {"outcome",           "stable",         "arrived",       "broke_away",
              "saturated",         "arrival_time",   "jerk_count",    "final_settling_time",
              "overshoot",         "holding_torque", "peak_torque",   "creep",
              "reversal_depth",    "final_error",    "zero_fraction", "oscillation_amplitude",
              "oscillation_period"};
    case ReportOrder::levels:
      return {"holding_torque", "final_position", "creep"};
    case ReportOrder::summary:
      return {"arrival_time", "jerk_count", "stopped", "travel_time", "final_error", "phase_changes"};
    case ReportOrder::outputs:
      return {"outcome",    "arrival_time", "arrived",    "stable",     "broke_away",
              "jerk_count", "overshoot",    "true_error", "peak_torque"};
  }
  return {};
}

}  // namespace

const MeasureTable& measure_table(const study::StudyFeatures& features) {
  // References into a map stay valid. Programs use few different limits.
  using Limits = std::pair<std::vector<std::int64_t>, std::vector<double>>;
  static std::mutex mutex;
  static std::map<Limits, MeasureTable> tables;
  const std::lock_guard lock(mutex);
  const trial::ErrorBands& bands = features.bands;
  const trial::Tolerances& tolerances = features.tolerances;
  const Limits limits{{bands.values().begin(), bands.values().end()},
                      {tolerances.values().begin(), tolerances.values().end()}};
  const auto found = tables.find(limits);
  return found != tables.end() ? found->second
                               : tables.emplace(limits, measures_with(bands, tolerances)).first->second;
}

std::string name_of_band(std::string_view name, std::int64_t band) {
  return fmt::format("{}[{}]", name, band);
}

std::string name_of_tolerance(std::string_view name, double tolerance) {
  return fmt::format("{}[{}]", name, tolerance);
}

bool is_in_file(const Measure& measure, const study::StudyFeatures& features) {
  return measure.only_with == nullptr || features.*measure.only_with;
}

bool is_quality(const Measure& measure) {
  return measure.reduction == MoveReduction::all || measure.reduction == MoveReduction::any;
}

bool has_quality(const Measure& measure, const trial::MoveOutcome& move) {
  const trial::MoveOutcome* const one = &move;
  double quality = 0.0;
  qualities_of(measure, std::span(&one, 1), std::span(&quality, 1));
  return quality != 0.0;
}

void qualities_of(const Measure& measure, std::span<const trial::MoveOutcome* const> moves,
                  std::span<double> qualities) {
  values_of(measure.field, moves, qualities);
  if (!std::holds_alternative<trial::Outcome trial::MoveOutcome::*>(measure.field.member)) return;
  for (double& value : qualities)
    value = trial::is_success(static_cast<trial::Outcome>(static_cast<std::int8_t>(value))) ? 1.0 : 0.0;
}

std::vector<const Measure*> measures_of(const MeasureTable& measures, ReportOrder order,
                                        bool (*belongs)(const Measure&)) {
  std::vector<const Measure*> found;
  const auto add = [&](const Measure& measure) {
    if (belongs(measure) && std::find(found.begin(), found.end(), &measure) == found.end())
      found.push_back(&measure);
  };
  for (const std::string_view name : first_of(order)) {
    for (const Measure& measure : measures) {
      if (measure.field.column.name == name) add(measure);
    }
  }
  for (const Measure& measure : measures) add(measure);
  return found;
}

}  // namespace zerocount::layout
