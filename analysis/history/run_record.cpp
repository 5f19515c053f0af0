#include "analysis/history/run_record.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/manifest_differences.hpp"
#include "analysis/statistics/clustered_proportion.hpp"
#include "analysis/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/parameters/earlier_defaults.hpp"
#include "results/layout/header.hpp"
#include "results/storage/checksum_trailer.hpp"

namespace zerocount::history {
namespace {

bool drawn_per_study(const comparison::ManifestValues& values, const study::Study& study) {
  return study.worlds > 0 ||  // another seed draws other worlds
         std::any_of(
             values.begin(), values.end(),
             [](const auto& entry) { return entry.first.ends_with(".per") && entry.second == "study"; }) ||
         std::any_of(study.profiles.begin(), study.profiles.end(),
                     [](const study::RealisedProfile& profile) { return !profile.of_rig; });
}

RunValue value_of(const comparison::GateMeasure& measure, const measures::PointSummary& point,
                  const std::string& label) {
  const measures::MeasureStatistics& found = point.of(*measure.measure);
  RunValue value{label, std::string(measure.name), std::string(measure.unit)};
  if (measure.proportion()) {
    value.kind = statistics::MeasurementKind::proportion;
    value.value = found.rate.value;
    value.bounds = found.rate.clopper_pearson;
    value.n = point.judged;
  } else {
    value.value = found.mean;
    value.bounds = found.mean_bounds;
    value.n = found.n;
  }
  return value;
}

/// The proportion of moves that meet the goal, with two-sided bounds as those of other proportions; with
/// worlds that of the worst, with bounds of the lowest of all.
RunValue goal_value(const measures::MoveCounts& goal, const std::string& label, double confidence) {
  RunValue value{label, "goal_rate", "1"};
  value.kind = statistics::MeasurementKind::proportion;
  const std::vector<measures::MoveCounts> worlds =
      goal.worlds > 0 ? measures::in_worlds(goal) : std::vector<measures::MoveCounts>{goal};
  const double each =
      goal.worlds > 0 ? statistics::confidence_of_each(confidence, worlds.size()) : confidence;
  for (const measures::MoveCounts& world : worlds) {
    const auto found = statistics::clustered_proportion(measures::clusters_of(world), each);
    const bool first = value.n == 0;
    value.bounds.low = first ? found.korn_graubard.low : std::min(value.bounds.low, found.korn_graubard.low);
    value.bounds.high =
        first ? found.korn_graubard.high : std::min(value.bounds.high, found.korn_graubard.high);
    if (!first && !(found.value < value.value)) continue;
    value.value = found.value;
    value.n = world.moves;
  }
  return value;
}

std::vector<RunValue> values_of(const summary::StudySummary& summary) {
  std::vector<RunValue> values;
  for (std::size_t point = 0; point < summary.points.size(); ++point) {
    if (summary.points[point].goal) {
      values.push_back(goal_value(*summary.points[point].goal, summary.labels[point], summary.confidence));
    }
    for (const comparison::GateMeasure& measure : comparison::gate_measures(summary.table())) {
      RunValue value = value_of(measure, summary.points[point], summary.labels[point]);
      if (std::isfinite(value.value)) values.push_back(std::move(value));
    }
  }
  return values;
}

[[noreturn]] void fail_without_values(const std::string& name) {
  throw Failure(
      ExitCode::inconclusive,
      fmt::format("{}: measures nothing that a history keeps: it has torque levels in place of targets, "
                  "or no finite trial; nothing is added",
                  name));
}

}  // namespace

std::string series_sha256(const reading::StudyFile& file) {
  const layout::FileHeader& header = file.header();
  comparison::ManifestValues values = comparison::manifest_values(header, file.path().string());
  for (const char* const key : {"description", "trials"}) values.erase(key);
  std::erase_if(values, [](const auto& entry) { return entry.first.ends_with(manifest::order_of_keys); });
  if (!drawn_per_study(values, layout::recorded_study(header, file.path()))) values.erase("seed");
  for (const parameters::EarlierDefault& earlier : parameters::earlier_defaults()) {
    const parameters::Parameter& parameter =
        parameters::parameter_table()[parameters::find_parameter(earlier.name).value()];
    values[fmt::format("default of {}", earlier.name)] =
        fmt::format("{}", parameters::default_value_in(parameter, header.version));
  }
  std::string text;
  for (const auto& [key, value] : values) text += fmt::format("{}: {}\n", key, value);
  return hash::sha256_hex(text);
}

RunRecord record_of(const reading::StudyFile& file) {
  const std::string name = file.path().string();
  const summary::StudySummary summary =
      summary::summarise(file, statistics::summary_confidence, /*bootstrap=*/true);
  if (summary.features.dependent_trials) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: its trials depend on each other (design: saltelli), so that its bounds are "
                    "too narrow for a history; expected another design",
                    name));
  }
  const layout::FileHeader& header = file.header();
  RunRecord run{header.name,
                series_sha256(file),
                header.study_sha256,
                storage::recorded_checksum(file.path()),
                std::to_string(header.seed),
                header.trials,
                header.provenance.zerocount_version,
                header.provenance.git_commit,
                header.provenance.created};
  run.values = values_of(summary);
  if (run.values.empty() || summary.features.open_loop) fail_without_values(name);
  return run;
}

}  // namespace zerocount::history
