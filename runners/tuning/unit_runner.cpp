#include "runners/tuning/unit_runner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "analysis/comparison/gate_rules.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/trial_value.hpp"
#include "core/failure/failure.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t units_at_once = 64;

/// A part of an entry that one thread runs.
struct Part {
  const UnitsToRun* entry;
  std::int64_t from;
  std::int64_t to;
};

double value_of(const Criterion& criterion, const trial::MoveOutcome& move) {
  const double value = measures::counted_value(*criterion.measure, move);
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

/// Adds the moves of a trial to the result of its unit.
class TrialCounter {
 public:
  explicit TrialCounter(const study::Study& study)
      : goal_(measures::asked_of_moves(study).front()), criterion_(criterion_of(study)) {}

  void add(std::span<const trial::MoveOutcome> moves, UnitResult& result) const {
    for (const trial::MoveOutcome& move : moves) {
      if (!measures::asks(goal_, move)) continue;
      ++result.moves;
      result.met += measures::meets(goal_, move) ? 1 : 0;
      result.values.push_back(value_of(criterion_, move));
      result.slid = result.slid || move.broke_away;
    }
  }

 private:
  measures::CountedGoal goal_;
  Criterion criterion_;
};

std::vector<trial::TrialParameters> trials_of(const Part& part, const trials::Replicates& units) {
  std::vector<trial::TrialParameters> trials;
  for (std::int64_t unit = part.from; unit < part.to; ++unit) {
    for (std::int64_t i = 0; i < units.trials_each; ++i) {
      trials.push_back(
          study::study_trial(*part.entry->study, units.point, i * units.count + unit).parameters);
      if (part.entry->change != nullptr) (*part.entry->change)(trials.back());
    }
  }
  return trials;
}

void add_outcomes(const Part& part, const trials::Replicates& units,
                  std::span<const trial::TrialOutcome> outcomes) {
  const TrialCounter counter(*part.entry->study);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto unit = static_cast<std::size_t>(part.from) + i / static_cast<std::size_t>(units.trials_each);
    counter.add(outcomes[i].moves, (*part.entry->results)[unit]);
  }
}

}  // namespace

std::vector<std::string> names_of(std::span<const study::FreeParameter> free) {
  std::vector<std::string> names;
  for (const study::FreeParameter& one : free) names.push_back(one.name);
  return names;
}

std::optional<study::Study> at_values(const study::Study& study, std::span<const study::FreeParameter> free,
                                      const Values& values) {
  return trials::with_values(study, names_of(free), values);
}

std::vector<std::string> overrides_of(std::span<const study::FreeParameter> free, const Values& values) {
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < free.size(); ++i)
    overrides.push_back(fmt::format("{}={}", free[i].name, values[i]));
  return overrides;
}

namespace {

/// A quantile of a measure of the true motion or the position error, such as rest_torque_noise.p95.
std::optional<Criterion> motion_criterion(const study::Study& study, std::string_view text) {
  const auto dot = text.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const auto quantile = std::ranges::find(comparison::quantile_names, text.substr(dot + 1),
                                          &std::pair<std::string_view, double>::first);
  if (quantile == comparison::quantile_names.end()) return std::nullopt;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    bool study::StudyFeatures::*const use = measure.file.only_with;
    const bool is_motion = use == &study::StudyFeatures::motion || use == &study::StudyFeatures::following ||
                           use == &study::StudyFeatures::reversals;
    if (measure.field.column.name != text.substr(0, dot)) continue;
    if (measure.tolerance || (is_motion && study.features.*use)) return Criterion{&measure, quantile->second};
  }
  return std::nullopt;
}

}  // namespace

Criterion criterion_of(const study::Study& study) {
  const std::string default_text = study::Tuning{}.minimise;
  const std::string of_goal = goal::settling_measure(goal::question_of(study)) + ".p95";
  const std::string text =
      study.tuning && study.tuning->minimise != default_text ? study.tuning->minimise : of_goal;
  if (const std::optional<Criterion> criterion = motion_criterion(study, text)) return *criterion;
  const auto dot = text.rfind('.');
  const std::string name = text.substr(0, dot);
  const bool lacks_band = name.starts_with("band_") && !name.ends_with("]") && dot != std::string::npos;
  const std::string with_band =
      lacks_band ? fmt::format("{}[{}]{}", name, study::first_goal(study)->band, text.substr(dot)) : text;
  const auto quantity = comparison::find_requirable(with_band);
  if (!quantity || quantity->kind != comparison::RequirementKind::quantile) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: tune.minimise: '{}' is no quantile of a measure; expected one such as "
                              "band_settling_time.p95, settling_time.median or, with verdict.motion, "
                              "rest_torque_noise.p95",
                              study.name, text));
  }
  const layout::Measure& wanted = *quantity->measure.measure;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    if (measure.field.column.name == wanted.field.column.name && measure.band == wanted.band)
      return {&measure, quantity->probability};
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: tune.minimise: '{}' is of an error band that the study does not measure; "
                            "expected one of verdict.bands or the goal's",
                            study.name, text));
}

Aim aim_of(const study::Study& study) {
  const study::Goal claim = study.goals.empty() ? study::Goal{.moves = 1.0} : study.goals.front();
  return {claim.moves, claim.machines, criterion_of(study).quantile, study.worlds};
}

void run_units(std::span<const UnitsToRun> entries, const trials::Replicates& units,
               const trials::Effort& effort) {
  std::vector<Part> parts;
  trials::TrialSet set;
  for (const UnitsToRun& entry : entries) {
    entry.results->resize(static_cast<std::size_t>(entry.to));
    set.count += (entry.to - entry.from) * units.trials_each;
    for (std::int64_t from = entry.from; from < entry.to; from += units_at_once)
      parts.push_back({&entry, from, std::min(from + units_at_once, entry.to)});
  }
  set.blocks = parts.size();
  set.draw = [&](std::size_t block) { return trials_of(parts[block], units); };
  trials::run(set, effort, [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
    add_outcomes(parts[block], units, outcomes);
  });
}

std::vector<UnitResult> results_of(const study::Study& study, const trials::Replicates& units,
                                   std::int64_t count, const Change* change, const trials::Effort& effort) {
  std::vector<UnitResult> results;
  const UnitsToRun all{&study, 0, std::min(count, units.count), &results, change};
  run_units({&all, 1}, units, effort);
  return results;
}

std::vector<UnitResult> results_in(const reading::AllTrialsFile& file, const study::Study& study,
                                   const trials::Replicates& units) {
  const TrialCounter counter(study);
  std::vector<UnitResult> results(static_cast<std::size_t>(units.count));
  measures::visit_trials(file, file.rows(), [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
    counter.add(moves, results[static_cast<std::size_t>(row % units.count)]);
  });
  return results;
}

}  // namespace zerocount::tuning
