#include "analysis/history/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/parameters/earlier_defaults.hpp"
#include "experiments/study/condition_study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "results/storage/checksum_trailer.hpp"

namespace zerocount::history {
namespace {

bool drawn_per_study(const manifest_text::ManifestValues& values, const study::Study& study) {
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

RunValue proportion_value(const std::string& label, std::string measure, const goal::BoundedProportion& found,
                          std::int64_t n) {
  RunValue value{label, std::move(measure), "1"};
  value.kind = statistics::MeasurementKind::proportion;
  value.value = found.value;
  value.bounds = {found.low, found.high};
  value.n = n;
  return value;
}

/// The judgement of a goal at a point, with two-sided bounds as those of other values; with worlds in the
/// worst, with bounds of the lowest of all. @param question of this goal alone
std::vector<RunValue> goal_values(const goal::Question& question, const measures::PointSummary& point,
                                  const std::string& label, double confidence) {
  study::Goal both_sides = *question.claim();
  both_sides.confidence = 0.5 * (1.0 + confidence);
  const measures::CellCounts& counts = point.goals[question.parts.front().number];
  const goal::Verdict verdict = goal::judge_goal(both_sides, counts, 1);
  const auto name = [&](std::string_view measure) {
    return comparison::name_of_goal_measure(measure, both_sides.name);
  };
  std::vector<RunValue> values{
      proportion_value(label, name("goal_rate"), verdict.moves, rate_of(question, point).events)};
  if (goal::is_of_machines(question)) {
    const std::int64_t worlds = std::max<std::int64_t>(question.worlds, 1);
    values.push_back(proportion_value(label, name("goal_machines"), verdict.machines, point.rigs.n / worlds));
  }
  const statistics::Quantile& p95 = settling_of(question, point).p95;
  RunValue time{label, name("goal_settling_time"), "s"};
  time.value = p95.value;
  time.bounds = {p95.low, p95.high};
  time.n = counts.sum().moves;
  values.push_back(std::move(time));
  return values;
}

/// Adds the values of trials, all of one condition. @param condition empty without conditions
void add_values(std::vector<RunValue>& values, const summary::StudySummary& summary,
                const std::string& condition) {
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    const measures::PointSummary& point = summary.points[i];
    const std::string label = study::label_under(summary.labels[i], condition);
    std::vector<RunValue> of_point;
    for (const goal::JudgedPart& part : summary.question.parts) {
      if (!part.claim) continue;  // success is one of the gate measures
      std::ranges::move(goal_values(only(summary.question, part.number), point, label, summary.confidence),
                        std::back_inserter(of_point));
    }
    for (const comparison::GateMeasure& measure : comparison::gate_measures(summary.table()))
      of_point.push_back(value_of(measure, point, label));
    for (RunValue& value : of_point) {
      if (std::isfinite(value.value)) values.push_back(std::move(value));
    }
  }
}

[[noreturn]] void fail_without_values(const std::string& name) {
  throw Failure(
      ExitCode::inconclusive,
      fmt::format("{}: measures nothing that a history keeps: it has torque levels in place of targets, "
                  "or no finite trial; nothing is added",
                  name));
}

}  // namespace

std::string series_sha256(const reading::AllTrialsFile& file) {
  const layout::FileHeader& header = file.header();
  manifest_text::ManifestValues values = layout::manifest_values(header, file.path().string());
  for (const char* const key : {"description", "trials"}) values.erase(key);
  std::erase_if(values,
                [](const auto& entry) { return entry.first.ends_with(manifest_text::order_of_keys); });
  if (!drawn_per_study(values, file.study())) values.erase("seed");
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

RunRecord record_of(const reading::AllTrialsFile& file) {
  const std::string name = file.path().string();
  const study::StudyFeatures& features = file.study().features;
  if (features.dependent_trials) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: its trials depend on each other (design: saltelli), so that its bounds are "
                    "too narrow for a history; expected another design",
                    name));
  }
  const layout::FileHeader& header = file.header();
  RunRecord run{{header.name, series_sha256(file), header.study_sha256,
                 storage::recorded_checksum(file.path()), std::to_string(header.seed), header.trials,
                 header.provenance.zerocount_version, header.provenance.git_commit,
                 header.provenance.created}};
  reading::for_each_condition(file, [&](const reading::AllTrialsFile& one, const std::string& condition) {
    add_values(run.values, summary::summarise(one, statistics::summary_confidence, /*bootstrap=*/true),
               condition);
  });
  if (run.values.empty() || features.open_loop) fail_without_values(name);
  return run;
}

}  // namespace zerocount::history
