#include <algorithm>
#include <array>
#include <cstddef>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/forecast.hpp"
#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "analysis/pairs/comparison/study_pair.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "results/layout/header.hpp"
#include "results/reading/first_difference.hpp"

namespace zerocount::comparison {
namespace {

/// Reason why the datasets of the two files need not be equal to the bit; empty if they must be equal.
std::string why_bits_may_differ(const layout::FileHeader& one, const layout::FileHeader& other) {
  if (one.study_sha256 != other.study_sha256) return "the manifests or overrides differ";
  if (one.engine != other.engine) return "the engines differ";
  if (!layout::same_build(one.provenance, other.provenance)) return "the builds differ";
  if (one.provenance.compiler != other.provenance.compiler) return "the compilers differ";
  if (layout::is_dirty(one.provenance) || layout::is_dirty(other.provenance)) {
    return "a build had uncommitted changes, so the builds may differ";
  }
  if (one.provenance.git_commit == "unknown") return "the commits they were built from are unknown";
  return {};
}

/// Decides whether the two files must be equal to the bit. If so, compares all datasets and stores the first
/// difference in `result`.
void compare_bits(StudyComparison& result, const reading::AllTrialsFile& baseline,
                  const reading::AllTrialsFile& current) {
  const std::string different = why_bits_may_differ(baseline.header(), current.header());
  if (baseline.header().study_sha256 == current.header().study_sha256) {
    result.first_difference = reading::first_difference(baseline.root(), current.root()).value_or("");
    result.equal_to_the_bit = result.first_difference.empty();
  }
  result.layer_reason = different;
  if (!different.empty() && !result.equal_to_the_bit) return;
  result.layer = ComparisonLayer::bits;
  result.layer_reason = different.empty() ? "one study by one build: every dataset must be equal to the bit"
                                          : different + ", and yet every dataset is equal to the bit";
}

/// Finds whether trial i of both files drew the same random numbers (the trials are then paired), and stores
/// the layer of the comparison and its reason in `result`.
void pair_trials(StudyComparison& result, const StudyPair& pair) {
  const DrawComparison draws = compare_draws(pair);
  result.layer = draws.same ? ComparisonLayer::paired : ComparisonLayer::two_samples;
  result.layer_reason += (result.layer_reason.empty() ? "" : "; ") + draws.reason;
  result.changed_inputs = draws.changed_inputs;
}

/// The trials of a design point in the baseline and in the current file.
struct PointPair {
  PointTrials baseline;
  PointTrials current;
};

/// Reads the trials of a design point that are compared, from both files.
/// @throws Failure (bad_data) if a file is damaged
PointPair read_trials(const StudyPair& pair, const MatchedPoint& point) {
  const auto read = [&](const ComparedStudy& study, std::int64_t at) {
    return read_point_trials(study.trials_of(point), at, study.trials, study.also);
  };
  return {read(pair.baseline, point.baseline), read(pair.current, point.current)};
}

/// Calls `use` with the trials that are compared, and returns its result. If trials are paired, only the
/// trials that both files have are passed; otherwise all.
template <class Use>
auto of_compared(const PointPair& trials, bool paired, const Use& use) {
  if (!paired) return use(BothTrials{trials.baseline, trials.current, false});
  const std::int64_t pairs = std::min(trials.baseline.trials, trials.current.trials);
  const PointTrials baseline = first_trials(trials.baseline, pairs);
  const PointTrials current = first_trials(trials.current, pairs);
  return use(BothTrials{baseline, current, true});
}

/// Compares one design point of both files. The verdicts on measures are still missing, because they depend
/// on the p-values at all points.
/// @param failing confidence with which a requirement must be contradicted to fail
PointComparison compare_point(const StudyComparison& comparison, const GateRules& rules,
                              const StudyPair& pair, const MatchedPoint& point, double failing) {
  const PointPair trials = read_trials(pair, point);
  PointComparison result{.label = point.label,
                         .design_point = point.design_point,
                         .setting = point.setting,
                         .baseline_point = point.baseline,
                         .current_point = point.current,
                         .baseline_trials = trials.baseline.trials,
                         .current_trials = trials.current.trials,
                         .baseline_undecided = trials.baseline.undecided,
                         .current_undecided = trials.current.undecided};
  const bool paired = comparison.layer != ComparisonLayer::two_samples;
  if (paired) result.pairs = std::min(trials.baseline.trials, trials.current.trials);
  result.judgements = of_compared(trials, paired, [&](const BothTrials& compared) {
    return compare_measures(rules, point.label, compared);
  });
  const std::size_t claims = pair.goals.size() * static_cast<std::size_t>(pair.settings);
  for (std::size_t goal = 0; goal < pair.goals.size(); ++goal) {
    const auto status = [&](const PointTrials& all) {
      return goal::judge_goal(all.judged[goal].goal, all.judged[goal].counts, 1, claims).status;
    };
    result.goals.push_back({pair.goals[goal].name, status(trials.baseline), status(trials.current)});
  }
  for (const Requirement& requirement : requirements_of(rules, point.label))
    result.judgements.push_back(judge_requirement(requirement, trials.current, rules.confidence, failing));
  return result;
}

/// Whether the study is open-loop: its moves have torque levels and no targets, so that no measure of the
/// gate applies. Only the first moves of the file are examined.
bool judges_nothing(const reading::AllTrialsFile& file) {
  const std::int64_t trials = std::min(file.rows().count, layout::chunk_rows(file.moves()));
  const std::vector<double> outcomes = file.measure("outcome", {file.rows().first, trials});
  return std::ranges::all_of(
      outcomes, [](double outcome) { return outcome == static_cast<double>(trial::Outcome::open_loop); });
}

std::int64_t count_requirements(const GateRules& rules, const StudyPair& pair) {
  std::int64_t count = 0;
  for (const MatchedPoint& point : pair.points) count += std::ssize(requirements_of(rules, point.label));
  return count;
}

double failing_confidence_of(const GateRules& rules, const StudyPair& pair) {
  return failing_confidence(rules.confidence, count_requirements(rules, pair));
}

void judge_points(StudyComparison& result, const GateRules& rules, const StudyPair& pair) {
  const bool nothing = judges_nothing(pair.current.file) || judges_nothing(pair.baseline.file);
  const double failing = failing_confidence_of(rules, pair);
  for (const MatchedPoint& point : pair.points) {
    PointComparison& compared =
        result.points.emplace_back(compare_point(result, rules, pair, point, failing));
    if (nothing) std::erase_if(compared.judgements, [](const Judgement& one) { return one.is_measure(); });
  }
  result.tests = decide(judgements_of(result.points), rules);
  if (nothing)
    result.notes.push_back("the moves have torque levels and no targets: no measure of the gate applies");
}

/// Whether a judgement takes part in the forecast of the number of trials, so that its sample is needed.
/// Measures of data that are equal to the bit never take part, because they cannot be inconclusive.
bool is_forecast(const StudyComparison& comparison, const Judgement& one) {
  return !one.is_measure() || (!comparison.equal_to_the_bit && has_finite_bounds(one));
}

/// Adds the samples of one design point to the samples from which the number of trials is forecast.
void add_point(ForecastSamples& samples, const StudyComparison& comparison, const GateRules& rules,
               const PointComparison& point, const PointPair& trials) {
  samples.add_point(point.baseline_trials, point.current_trials);
  const bool any_measure = std::ranges::any_of(point.judgements, [&](const Judgement& one) {
    return one.is_measure() && is_forecast(comparison, one);
  });
  const auto samples_of = [&](const BothTrials& compared) {
    return measure_samples(rules, point.judgements, compared);
  };
  std::vector<two_samples::Sample> of_measures;
  if (any_measure) of_measures = of_compared(trials, point.pairs > 0, samples_of);
  for (std::size_t i = 0; i < of_measures.size(); ++i) {
    if (is_forecast(comparison, point.judgements[i])) samples.add(point.judgements[i], of_measures[i]);
  }
  for (const Requirement& requirement : requirements_of(rules, point.label))
    samples.add(requirement_sample(requirement, trials.current));
}

/// [0: baseline, 1: current file] Number of independent units (trials, machines or worlds) in the samples of
/// a forecast. If trials are paired, both have the number of units of the smaller file. A requirement is
/// judged on all units of the current file.
std::array<std::int64_t, 2> units_of_samples(const StudyComparison& comparison, const GateRules& rules,
                                             const StudyPair& pair) {
  const auto units = [](const ComparedStudy& study) {
    return study.machines > 0 ? study.machines : study.trials;
  };
  const std::int64_t before = units(pair.baseline);
  const std::int64_t after = units(pair.current);
  if (comparison.layer == ComparisonLayer::two_samples) return {before, after};
  const std::int64_t pairs = std::min(before, after);
  return {pairs, count_requirements(rules, pair) > 0 ? after : pairs};
}

Forecast forecast_of(const StudyComparison& comparison, const GateRules& rules, const StudyPair& pair) {
  constexpr double min_tried_trials = 50'000.0;  // per point, at the most that are tried
  ForecastSamples samples(units_of_samples(comparison, rules, pair), false);
  for (std::size_t i = 0; i < pair.points.size(); ++i)
    add_point(samples, comparison, rules, comparison.points[i], read_trials(pair, pair.points[i]));
  ForecastOptions options;
  options.confidence = rules.confidence;
  options.false_discovery_rate = rules.false_discovery_rate;
  options.failing_confidence = failing_confidence_of(rules, pair);
  const auto trials = static_cast<double>(std::max(samples.trials_of(0), samples.trials_of(1)));
  options.max_factor = std::max(options.max_factor, min_tried_trials / trials);
  limit_work(options, samples.measures().size() + samples.requirements().size());
  return forecast_decision(samples, options);
}

/// Finds the number of trials, per design point and summed over its settings, that would decide the
/// inconclusive judgements. Does nothing if no judgement is inconclusive; only otherwise are the trials read
/// again.
void forecast(StudyComparison& result, const GateRules& rules, const StudyPair& pair) {
  const std::vector<Judgement*> judgements = judgements_of(result.points);
  if (std::ranges::none_of(judgements, [](const Judgement* one) { return one->is_open(); })) return;
  const Forecast found = forecast_of(result, rules, pair);
  const auto settings = static_cast<double>(pair.settings);
  const auto under_all = [&](const std::optional<double>& trials) {
    return trials ? std::optional(*trials * settings) : std::nullopt;
  };
  const bool all_forecast = std::ranges::all_of(judgements, [](const Judgement* one) {
    return !one->is_measure() || !one->is_open() || has_finite_bounds(*one);
  });
  if (all_forecast) result.max_trials_to_decide = settings * found.max_trials;
  if (all_forecast && result.verdict == GateVerdict::inconclusive) {
    const std::int64_t limit = trial_limit(rules, pair.current.file);
    if (found.trials > static_cast<double>(limit))
      result.notes.push_back(
          fmt::format("more than {} trials of each point{} are judged only with --max-trials (here {:.0f})",
                      limit, pair.settings > 1 ? " under each condition" : "", *found.trials));
    result.trials_to_decide = under_all(found.trials);
  }
  auto next = found.judgements.begin();
  for (const bool measures : {true, false}) {
    for (Judgement* const one : judgements) {
      if (one->is_measure() != measures || !is_forecast(result, *one)) continue;
      const JudgementForecast& forecast = *next++;
      if (!one->is_open()) continue;
      one->trials_to_decide = under_all(forecast.trials);
      if (!measures) continue;
      if (!forecast.trials) one->max_trials_margin = forecast.margin;
      one->decided_margin = largest_possible_change(*one);
    }
  }
}

/// Gives every measure the verdict `passed`, because the data of both files are equal to the bit. No
/// statistics are needed.
void pass_equal_data(StudyComparison& result) {
  for (Judgement* const measure : judgements_of(result.points)) {
    if (!measure->is_measure()) continue;
    measure->test = "equal to the bit";
    if (measure->is_open()) measure->note.clear();
    if (measure->verdict == GateVerdict::not_measured) continue;
    measure->change = ChangeVerdict::equivalent;
    measure->verdict = GateVerdict::passed;
  }
}

/// Sets the verdict on each design point and on the whole comparison. A point at which nothing was measured
/// makes the whole inconclusive.
void find_verdict(StudyComparison& result) {
  std::vector<GateVerdict> whole;
  for (PointComparison& point : result.points) {
    std::vector<GateVerdict> verdicts;
    for (const Judgement& one : point.judgements) verdicts.push_back(one.verdict);
    if (result.equal_to_the_bit) verdicts.push_back(GateVerdict::passed);
    point.verdict = worst_of(verdicts);
    whole.push_back(point.verdict == GateVerdict::not_measured ? GateVerdict::inconclusive : point.verdict);
  }
  if (is_unequal(result)) whole.push_back(GateVerdict::regression);
  result.verdict = worst_of(whole);
  if (result.verdict == GateVerdict::not_measured) result.verdict = GateVerdict::inconclusive;
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

/// Adds a note for the reader if trials of a file are left out of the comparison.
void note_trials(StudyComparison& result, const StudyPair& pair) {
  const auto note_left_out = [&](const ComparedStudy& study) {
    const std::int64_t trials = study.trials_of(pair.points.front()).header().trials;
    if (study.trials == trials) return;
    result.notes.push_back(fmt::format(
        "of the {} trials of each point{} in {}, the first {} are judged; more: --max-trials", trials,
        pair.settings > 1 ? " under each condition" : "", study.file.path().string(), study.trials));
  };
  note_left_out(pair.baseline);
  if (!compares_points(result)) note_left_out(pair.current);
  const std::int64_t before = pair.baseline.trials;
  const std::int64_t after = pair.current.trials;
  if (result.layer != ComparisonLayer::paired || before == after) return;
  result.notes.push_back(fmt::format(
      "compared are the first {} trials of each point: the trials after them in {} have no partner",
      std::min(before, after), before > after ? result.baseline.path : result.current.path));
}

/// Adds a note that says by which file's goals the points are judged, if the goals of the two manifests
/// differ.
void note_goal(StudyComparison& result, const StudyPair& pair) {
  const auto is_of_goal = [](const manifest_text::ManifestDifference& difference) {
    return keys::is_within(difference.key, "goal") || keys::is_within(difference.key, "goals");
  };
  if (pair.goals.empty() || std::ranges::none_of(result.manifest_differences, is_of_goal)) return;
  result.notes.push_back(fmt::format("the goals differ; both files are judged by {} of {}",
                                     pair.goals.size() > 1 ? "those" : "that",
                                     pair.goals_of_baseline ? result.baseline.path : result.current.path));
}

/// Adds notes that say which units are independent (trials, machines or worlds), and what the worlds of the
/// studies mean for the comparison.
void note_units(StudyComparison& result, const StudyPair& pair) {
  if (pair.other_worlds) {
    result.notes.push_back(
        "the trials of a world are not independent, and the worlds differ: tests and bounds are over worlds, "
        "and what decides is more worlds");
  } else if (pair.baseline.machines > 0 || pair.current.machines > 0) {
    result.notes.push_back(
        "the trials of a machine are not independent: tests and bounds are over machines, and what decides "
        "is more trials on more machines, in the same proportion");
  }
  if (!pair.in_worlds) return;
  result.notes.emplace_back(!pair.goals.empty()
                                ? "means and rates, goal_rate and goal_machines too, are averages over the "
                                  "worlds; the goal itself is judged in the worst"
                                : "means and rates are averages over the worlds");
}

/// Fills in the judgements, the verdicts and the forecast of the comparison.
/// @param given rules of the user, before they are adapted to the points and goals of the pair
void judge(StudyComparison& result, const GateRules& given, const StudyPair& pair) {
  const GateRules rules = rules_for(pair, given);
  result.goals = pair.goals;
  note_goal(result, pair);
  note_trials(result, pair);
  judge_points(result, rules, pair);
  note_undecided_moves(result);
  note_units(result, pair);
  if (result.equal_to_the_bit) pass_equal_data(result);
  find_verdict(result);
  forecast(result, rules, pair);
}

StudyComparison begin(const StudyPair& pair, const GateRules& rules) {
  StudyComparison result;
  result.baseline = {pair.baseline.file.path().string(), pair.baseline.file.header()};
  result.current = {pair.current.file.path().string(), pair.current.file.header()};
  result.confidence = rules.confidence;
  result.false_discovery_rate = rules.false_discovery_rate;
  return result;
}

}  // namespace

std::vector<Judgement*> judgements_of(std::span<PointComparison> points) {
  std::vector<Judgement*> all;
  for (PointComparison& point : points) {
    for (Judgement& one : point.judgements) all.push_back(&one);
  }
  return all;
}

StudyComparison compare_studies(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                                const GateRules& rules) {
  const StudyPair pair = pair_studies(baseline, current, rules);
  StudyComparison result = begin(pair, rules);
  result.manifest_differences =
      manifest_text::manifest_differences(pair.baseline.values, pair.current.values);
  compare_bits(result, baseline, current);
  if (result.layer != ComparisonLayer::bits) {
    require_independent_trials(pair.baseline);
    require_independent_trials(pair.current);
    pair_trials(result, pair);
  }
  judge(result, rules, pair);
  return result;
}

StudyComparison compare_points(const reading::AllTrialsFile& file, std::int64_t baseline,
                               std::int64_t current, const GateRules& rules) {
  const StudyPair pair = pair_points(file, baseline, current, rules);
  StudyComparison result = begin(pair, rules);
  result.baseline_label = file.point_labels()[static_cast<std::size_t>(baseline)];
  const std::vector<study::SweepAxis> axes = file.axes();
  for (const study::SweepAxis& axis : axes) {
    const std::string before = axis_value(axes, axis.name, baseline);
    const std::string after = axis_value(axes, axis.name, current);
    if (before != after) result.manifest_differences.push_back({axis.name, before, after});
  }
  pair_trials(result, pair);
  judge(result, rules, pair);
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
    result.notes.push_back("both names mean the same file: this comparison shows nothing about the program");
  }
  return result;
}

}  // namespace zerocount::comparison
