#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/comparison/compared_data.hpp"
#include "analysis/comparison/comparison.hpp"
#include "analysis/comparison/forecast.hpp"
#include "analysis/comparison/gate_rules.hpp"
#include "analysis/comparison/matching.hpp"
#include "analysis/comparison/measure_comparison.hpp"
#include "analysis/comparison/point_trials.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/goal/question.hpp"
#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "results/reading/first_difference.hpp"

namespace zerocount::comparison {
namespace {

/// Why the datasets of the two need not be equal to the bit; empty where they must be.
std::string why_bits_may_differ(const layout::FileHeader& one, const layout::FileHeader& other) {
  if (one.study_sha256 != other.study_sha256) return "the manifests or overrides differ";
  if (one.engine != other.engine) return "they are of different engines";
  if (!layout::same_build(one.provenance, other.provenance)) return "they are of different builds";
  if (one.provenance.compiler != other.provenance.compiler) return "they are of different compilers";
  if (one.version != other.version) return "they are of different versions of the layout";
  if (layout::is_dirty(one.provenance) || layout::is_dirty(other.provenance)) {
    return "a build had changes that were not committed, and need not be that of the other";
  }
  if (one.provenance.git_commit == "unknown") return "the commits they were built from are unknown";
  return {};
}

/// Finds the layer, and compares the datasets where that can be decisive.
void find_layer(StudyComparison& result, const reading::AllTrialsFile& baseline,
                const reading::AllTrialsFile& current) {
  const std::string different = why_bits_may_differ(baseline.header(), current.header());
  if (baseline.header().study_sha256 == current.header().study_sha256) {
    result.first_difference = reading::first_difference(baseline.root(), current.root()).value_or("");
    result.equal_to_the_bit = result.first_difference.empty();
  }
  if (different.empty() || result.equal_to_the_bit) {
    result.layer = ComparisonLayer::bits;
    result.layer_reason = different.empty() ? "one study by one build: every dataset must be equal to the bit"
                                            : different + ", and yet every dataset is equal to the bit";
    return;
  }
  result.layer_reason = different;
}

void require_same_kind(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                       const manifest_text::ManifestValues& old_values,
                       const manifest_text::ManifestValues& new_values) {
  const auto open_loop = [](const manifest_text::ManifestValues& values) {
    return std::any_of(values.begin(), values.end(),
                       [](const auto& value) { return value.first.starts_with("command.torque."); });
  };
  if (open_loop(old_values) == open_loop(new_values)) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("{} and {} cannot be compared: one has targets, the other torque levels",
                            baseline.path().string(), current.path().string()));
}

/// Every test here takes trials for independent, and those of a saltelli design share most of their
/// numbers.
void require_independent_trials(const reading::AllTrialsFile& file,
                                const manifest_text::ManifestValues& values) {
  const auto design = values.find("design");
  if (design == values.end() || design->second != "saltelli") return;
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: cannot be compared: the trials of `design: saltelli` are not independent; "
                            "expected a study of another design",
                            file.path().string()));
}

/// @param goal number of one of those that are judged @param claims as AlsoRead::claims
goal::Status status_of_goal(std::size_t goal, const PointTrials& trials, std::size_t claims) {
  const GoalTrials& judged = trials.judged[goal];
  return goal::judge_goal(judged.goal, judged.counts, 1, claims).status;
}

PointComparison compare_point(const StudyComparison& comparison, const GateRules& rules,
                              const MatchedPoint& point, const PointTrials& baseline,
                              const PointTrials& current, std::size_t claims) {
  PointComparison result;
  result.label = point.label;
  result.design_point = point.design_point;
  result.condition = point.condition;
  result.baseline_point = point.baseline;
  result.current_point = point.current;
  result.baseline_trials = baseline.trials;
  result.current_trials = current.trials;
  result.baseline_undecided = baseline.undecided;
  result.current_undecided = current.undecided;
  const bool paired = comparison.layer != ComparisonLayer::two_samples;
  if (paired) result.pairs = std::min(baseline.trials, current.trials);
  result.measures = paired ? compare_measures(rules, point.label, first_trials(baseline, result.pairs),
                                              first_trials(current, result.pairs), true)
                           : compare_measures(rules, point.label, baseline, current, false);
  for (std::size_t goal = 0; goal < comparison.goals.size(); ++goal)
    result.goals.push_back({comparison.goals[goal].name, status_of_goal(goal, baseline, claims),
                            status_of_goal(goal, current, claims)});
  return result;
}

std::int64_t count_requirements(const GateRules& rules, const std::vector<MatchedPoint>& points) {
  std::int64_t count = 0;
  for (const MatchedPoint& point : points) count += std::ssize(requirements_of(rules, point.label));
  return count;
}

/// The most trials per point that a forecast tries are at least these.
constexpr double min_tried_trials = 50'000.0;

/// The samples of a point for a forecast. No measure of equal data is open.
ForecastPoint forecast_point(const PointComparison& compared, const GateRules& rules,
                             const PointTrials& baseline, const PointTrials& current, bool equal) {
  ForecastPoint point{compared.baseline_trials, compared.current_trials, {}, {}, {}};
  const bool paired = compared.pairs > 0;
  if (!equal) {
    const std::vector<MeasureSample> samples =
        paired ? measure_samples(rules, compared.measures, first_trials(baseline, compared.pairs),
                                 first_trials(current, compared.pairs), true)
               : measure_samples(rules, compared.measures, baseline, current, false);
    for (std::size_t i = 0; i < compared.measures.size(); ++i) {
      const MeasureComparison& measure = compared.measures[i];
      if (!has_finite_bounds(measure)) continue;
      point.measures.push_back(samples[i]);
      point.found.push_back(measure);
    }
  }
  for (const Requirement& requirement : requirements_of(rules, compared.label))
    point.requirements.push_back(requirement_sample(requirement, current));
  return point;
}

void take_forecast(MeasureComparison& measure, const JudgementForecast& forecast) {
  if (measure.verdict != GateVerdict::inconclusive) return;
  measure.trials_to_decide = forecast.trials;
  if (!forecast.trials) measure.max_trials_margin = forecast.margin;
  measure.decided_margin =
      measure.changed_fails ? std::max(measure.bounds.high, -measure.bounds.low) : measure.bounds.high;
}

/// An open-loop study has moves, but none that could be judged. Its first moves tell.
bool judges_nothing(const reading::AllTrialsFile& file) {
  const std::int64_t trials = std::min(file.rows().count, layout::chunk_rows(file.moves()));
  const std::vector<double> outcomes = file.measure("outcome", {file.rows().first, trials});
  return std::all_of(outcomes.begin(), outcomes.end(), [](double outcome) {
    return outcome == static_cast<double>(trial::Outcome::open_loop);
  });
}

DrawComparison compare_draws_of(const ComparedData& data, const manifest_text::ManifestValues& old_values,
                                const manifest_text::ManifestValues& new_values) {
  return compare_draws(data.baseline, data.current, old_values, new_values, data.points,
                       std::min(data.baseline_trials, data.current_trials));
}

void judge_points(StudyComparison& result, const GateRules& rules, const ComparedData& data) {
  const double failing = failing_confidence(rules.confidence, count_requirements(rules, data.points));
  const bool nothing = judges_nothing(data.current) || judges_nothing(data.baseline);
  for (const MatchedPoint& point : data.points) {
    const TrialsOfBoth trials = read_trials(data, point);
    result.points.push_back(compare_point(result, rules, point, trials.baseline, trials.current,
                                          data.goals.size() * static_cast<std::size_t>(data.conditions)));
    PointComparison& compared = result.points.back();
    if (nothing) compared.measures.clear();
    for (const Requirement& requirement : requirements_of(rules, point.label)) {
      compared.requirements.push_back(
          judge_requirement(requirement, trials.current, rules.confidence, failing));
    }
  }
  result.tests = decide(result.points, rules);
  if (nothing)
    result.notes.push_back("the moves have torque levels and no targets: no measure of the gate applies");
}

/// Independent units of the samples of a forecast. Pairs are as many as the smaller file has; a requirement
/// is judged on all units of the current one.
std::array<std::int64_t, 2> units_of_samples(const StudyComparison& comparison, const GateRules& rules,
                                             const ComparedData& data) {
  const auto units = [](std::int64_t trials, std::int64_t rigs) { return rigs > 0 ? rigs : trials; };
  const std::int64_t before = units(data.baseline_trials, data.baseline_rigs);
  const std::int64_t after = units(data.current_trials, data.current_rigs);
  if (comparison.layer == ComparisonLayer::two_samples) return {before, after};
  const std::int64_t pairs = std::min(before, after);
  return {pairs, count_requirements(rules, data.points) > 0 ? after : pairs};
}

/// The trials of a design point for so many under each condition.
std::optional<double> under_all_conditions(std::optional<double> trials, const ComparedData& data) {
  if (trials) *trials *= static_cast<double>(data.conditions);
  return trials;
}

/// Finds the trials that would decide what is open. Reads the trials again: most comparisons leave nothing
/// open.
void forecast(StudyComparison& result, const GateRules& rules, const ComparedData& data) {
  const auto open = [](const auto& one) { return one.verdict == GateVerdict::inconclusive; };
  const bool any = std::any_of(result.points.begin(), result.points.end(), [&](const PointComparison& point) {
    return std::any_of(point.measures.begin(), point.measures.end(), open) ||
           std::any_of(point.requirements.begin(), point.requirements.end(), open);
  });
  if (!any) return;
  const bool all_forecast = std::ranges::all_of(result.points, [&](const PointComparison& point) {
    return std::ranges::all_of(point.measures, [&](const MeasureComparison& measure) {
      return !open(measure) || has_finite_bounds(measure);
    });
  });
  ForecastSamples samples(units_of_samples(result, rules, data), false);
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const TrialsOfBoth trials = read_trials(data, data.points[i]);
    samples.add(
        forecast_point(result.points[i], rules, trials.baseline, trials.current, result.equal_to_the_bit));
  }
  ForecastOptions options;
  options.confidence = rules.confidence;
  options.false_discovery_rate = rules.false_discovery_rate;
  options.failing_confidence = failing_confidence(rules.confidence, count_requirements(rules, data.points));
  options.probability = decision_probability;
  const auto trials = static_cast<double>(std::max(samples.trials_of(0), samples.trials_of(1)));
  options.max_factor = std::max(options.max_factor, min_tried_trials / trials);
  const Forecast found = forecast_decision(samples, options);
  if (all_forecast) result.max_trials_to_decide = *under_all_conditions(found.max_trials, data);
  if (all_forecast && result.verdict == GateVerdict::inconclusive) {
    if (found.trials > static_cast<double>(trial_limit(rules, data.current)))
      result.notes.push_back(
          fmt::format("more than {} trials of each point{} are judged only with --max-trials (here {:.0f})",
                      trial_limit(rules, data.current), data.conditions > 1 ? " under each condition" : "",
                      *found.trials));
    result.trials_to_decide = under_all_conditions(found.trials, data);
  }
  auto next = found.judgements.begin();
  for (PointComparison& point : result.points) {
    for (MeasureComparison& measure : point.measures) {
      if (!result.equal_to_the_bit && has_finite_bounds(measure)) take_forecast(measure, *next++);
      measure.trials_to_decide = under_all_conditions(measure.trials_to_decide, data);
    }
  }
  for (PointComparison& point : result.points) {
    for (RequirementResult& requirement : point.requirements) {
      if (open(requirement)) requirement.trials_to_decide = under_all_conditions(next->trials, data);
      ++next;
    }
  }
}

/// Equal data need no statistics: no measure can be worse.
void pass_equal_data(StudyComparison& result) {
  for (PointComparison& point : result.points) {
    for (MeasureComparison& measure : point.measures) {
      measure.test = "equal to the bit";
      if (measure.verdict == GateVerdict::inconclusive) measure.note.clear();
      if (measure.verdict == GateVerdict::not_measured) continue;
      measure.change = ChangeVerdict::equivalent;
      measure.verdict = GateVerdict::passed;
    }
  }
}

GateVerdict verdict_at(const PointComparison& point, bool equal) {
  std::vector<GateVerdict> verdicts;
  for (const MeasureComparison& measure : point.measures) verdicts.push_back(measure.verdict);
  for (const RequirementResult& requirement : point.requirements) verdicts.push_back(requirement.verdict);
  if (equal) verdicts.push_back(GateVerdict::passed);
  return worst_of(verdicts);
}

/// A point of which nothing was measured leaves the whole undecided.
GateVerdict verdict_of(StudyComparison& result) {
  std::vector<GateVerdict> verdicts;
  for (PointComparison& point : result.points) {
    point.verdict = verdict_at(point, result.equal_to_the_bit);
    verdicts.push_back(point.verdict == GateVerdict::not_measured ? GateVerdict::inconclusive
                                                                  : point.verdict);
  }
  if (result.layer == ComparisonLayer::bits && !result.equal_to_the_bit)
    verdicts.push_back(GateVerdict::regression);
  const GateVerdict worst = worst_of(verdicts);
  return worst == GateVerdict::not_measured ? GateVerdict::inconclusive : worst;
}

void note_undecided_moves(StudyComparison& result) {
  measures::UndecidedMoves before, after;
  for (const PointComparison& point : result.points) {
    before = measures::sum_of(before, point.baseline_undecided);
    after = measures::sum_of(after, point.current_undecided);
  }
  if (!measures::any_undecided(before) && !measures::any_undecided(after)) return;
  const auto text = [](const measures::UndecidedMoves& moves) {
    return measures::any_undecided(moves) ? measures::undecided_sentence(moves)
                                          : fmt::format("none of {} moves", moves.moves);
  };
  result.notes.push_back(fmt::format("undecided in the baseline: {}", text(before)));
  result.notes.push_back(fmt::format("undecided in the file: {}", text(after)));
  result.notes.emplace_back(measures::undecided_meaning);
}

/// @param file of one condition, or of a study without
void note_left_out(StudyComparison& result, const reading::AllTrialsFile& file, std::int64_t judged,
                   const ComparedData& data) {
  const std::int64_t trials = file.header().trials;
  if (judged == trials) return;
  result.notes.push_back(
      fmt::format("of the {} trials of each point{} in {}, the first {} are judged; more: --max-trials",
                  trials, data.conditions > 1 ? " under each condition" : "", file.path().string(), judged));
}

void note_unpaired_trials(StudyComparison& result, const ComparedData& data) {
  const std::int64_t before = data.baseline_trials;
  const std::int64_t after = data.current_trials;
  if (result.layer != ComparisonLayer::paired || before == after) return;
  result.notes.push_back(fmt::format(
      "compared are the first {} trials of each point: the trials after them in {} have no partner",
      std::min(before, after), before > after ? result.baseline.path : result.current.path));
}

void note_trials(StudyComparison& result, const ComparedData& data) {
  note_left_out(result, *data.points.front().in_baseline, data.baseline_trials, data);
  if (&data.current != &data.baseline)
    note_left_out(result, *data.points.front().in_current, data.current_trials, data);
  note_unpaired_trials(result, data);
}

/// Says by which goal the points are judged where the manifests do not have the same.
void note_goal(StudyComparison& result, const ComparedData& data) {
  if (data.goals.empty()) return;
  const auto differs = [](const manifest_text::ManifestDifference& difference) {
    return keys::is_within(difference.key, "goal") || keys::is_within(difference.key, "goals");
  };
  if (std::ranges::none_of(result.manifest_differences, differs)) return;
  result.notes.push_back(fmt::format("the goals differ; both files are judged by {} of {}",
                                     data.goals.size() > 1 ? "those" : "that",
                                     data.goals_of_baseline ? result.baseline.path : result.current.path));
}

/// The judgements, and what follows from them.
void judge(StudyComparison& result, const GateRules& rules, const ComparedData& data) {
  result.goals = data.goals;
  note_goal(result, data);
  note_trials(result, data);
  judge_points(result, rules, data);
  note_undecided_moves(result);
  if (data.other_worlds) {
    result.notes.push_back(
        "the trials of a world are not independent, and the worlds differ: tests and bounds are over worlds, "
        "and what decides is more worlds");
  } else if (data.baseline_rigs > 0 || data.current_rigs > 0) {
    result.notes.push_back(
        "the trials of a rig are not independent: tests and bounds are over rigs, and what decides is more "
        "trials on more rigs, in the same proportion");
  }
  if (data.in_worlds) {
    result.notes.emplace_back(!result.goals.empty()
                                  ? "means and rates, goal_rate and goal_machines too, are averages over the "
                                    "worlds; the goal itself is judged in the worst"
                                  : "means and rates are averages over the worlds");
  }
  if (result.equal_to_the_bit) pass_equal_data(result);
  result.verdict = verdict_of(result);
  forecast(result, rules, data);
}

StudyComparison begin(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                      const GateRules& rules) {
  StudyComparison result;
  result.baseline = {baseline.path().string(), baseline.header()};
  result.current = {current.path().string(), current.header()};
  result.confidence = rules.confidence;
  result.false_discovery_rate = rules.false_discovery_rate;
  return result;
}

/// Finds whether the trials are paired.
void pair_trials(StudyComparison& result, const DrawComparison& draws) {
  result.layer = draws.same ? ComparisonLayer::paired : ComparisonLayer::two_samples;
  result.layer_reason += (result.layer_reason.empty() ? "" : "; ") + draws.reason;
  result.changed_inputs = draws.changed_inputs;
}

/// The draws of two points of one file.
DrawComparison compare_draws_within(const ComparedData& data, const manifest_text::ManifestValues& values) {
  if (manifest_text::value_or(values, "independent_points", "false") == "true")
    return {false, "the points have random numbers of their own", {}};
  return compare_draws_of(data, values, values);
}

/// The swept keys in which the two points differ.
std::vector<manifest_text::ManifestDifference> axis_differences(const reading::AllTrialsFile& file,
                                                                const MatchedPoint& point) {
  std::vector<manifest_text::ManifestDifference> differences;
  const std::vector<study::SweepAxis> axes = file.axes();
  for (const study::SweepAxis& axis : axes) {
    manifest_text::ManifestDifference difference{axis.name, axis_value(axes, axis.name, point.baseline),
                                                 axis_value(axes, axis.name, point.current)};
    if (difference.baseline != difference.current) differences.push_back(std::move(difference));
  }
  return differences;
}

}  // namespace

StudyComparison compare_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                                const GateRules& rules) {
  const std::vector<MatchedPoint> design_points = match_points(baseline, current);
  manifest_text::ManifestValues old_values =
      layout::manifest_values(baseline.header(), baseline.path().string());
  manifest_text::ManifestValues new_values =
      layout::manifest_values(current.header(), current.path().string());
  layout::write_changed_defaults(old_values, baseline.header().version, new_values, current.header().version);
  require_same_kind(baseline, current, old_values, new_values);
  const MatchedConditions conditions(baseline, current);
  const ComparedData data =
      compared_data(baseline, old_values, current, new_values, conditions.points(design_points), rules);

  StudyComparison result = begin(baseline, current, rules);
  result.manifest_differences = manifest_text::manifest_differences(old_values, new_values);
  find_layer(result, baseline, current);
  if (result.layer != ComparisonLayer::bits) {
    require_independent_trials(baseline, old_values);
    require_independent_trials(current, new_values);
    pair_trials(result, compare_draws_of(data, old_values, new_values));
  }
  judge(result, rules_for(data, rules), data);
  return result;
}

StudyComparison compare_points(const reading::AllTrialsFile& file, std::int64_t baseline,
                               std::int64_t current, const GateRules& rules) {
  const std::vector<std::string> labels = file.point_labels();
  const std::string& label = labels[static_cast<std::size_t>(current)];
  const MatchedPoint point{.label = label,
                           .baseline = baseline,
                           .current = current,
                           .design_point = label,
                           .in_baseline = &file,
                           .in_current = &file};
  const manifest_text::ManifestValues values = layout::manifest_values(file.header(), file.path().string());
  require_independent_trials(file, values);
  StudyComparison result = begin(file, file, rules);
  result.baseline_label = labels[static_cast<std::size_t>(baseline)];
  result.manifest_differences = axis_differences(file, point);
  const MatchedConditions conditions(file, file);
  const ComparedData data = compared_data(file, values, file, values, conditions.points({point}), rules);
  pair_trials(result, compare_draws_within(data, values));
  judge(result, rules_for(data, rules), data);
  return result;
}

GateRules rules_of(const CompareOptions& options, std::span<const std::string> labels) {
  GateRules rules = options.margins ? read_gate_rules(*options.margins, labels) : GateRules{};
  rules.changed_fails = rules.changed_fails || options.changed_fails;
  rules.max_trials = options.max_trials;
  return rules;
}

StudyComparison compare_files(const std::filesystem::path& baseline, const std::filesystem::path& current,
                              const CompareOptions& options) {
  const reading::AllTrialsFile before(baseline);
  const reading::AllTrialsFile after(current);
  StudyComparison result = compare_studies(before, after, rules_of(options, after.point_labels()));
  std::error_code error;
  if (std::filesystem::equivalent(baseline, current, error)) {
    result.notes.push_back("both names are of one file: this shows nothing of the program");
  }
  return result;
}

}  // namespace zerocount::comparison
