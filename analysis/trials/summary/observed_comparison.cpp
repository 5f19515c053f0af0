#include "analysis/trials/summary/observed_comparison.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"

namespace zerocount::summary {
namespace {

/// The simulated trials of a design point. Each is counted as one move, which is met if the trial meets the
/// question (the goals or, without a goal, zero error).
struct AskedTrials {
  measures::MoveCounts all;
  /// [world] Trials in each world (a draw of what all machines share); empty without worlds.
  std::vector<measures::MoveCounts> worlds;
};

AskedTrials asked_trials(const goal::Question& question, const measures::PointSummary& point) {
  if (!question.goal() && !point.trials_of_groups) return {goal::counts_of(question, point), {}};
  const measures::GroupTrials& trials = point.trials_of_groups.value();
  const measures::CellCounts& asked = question.goal() ? trials.meeting : trials.succeeded;
  return {asked.sum(), asked.by_world()};
}

statistics::ObservedTest test_of(const statistics::Successes& observed, const measures::MoveCounts& trials) {
  if (trials.machines.empty()) return statistics::fisher_test(observed, {trials.met, trials.moves});
  std::vector<std::int64_t> successes;
  for (const statistics::MachineMoves& machine : trials.machines) successes.push_back(machine.met);
  return statistics::machine_rank_test(observed, successes, trials.machines.front().trials);
}

/// Comparison with the world (draw of what all machines share) that is most like the real machine. The world
/// of the real machine is unknown, so the machine differs from the simulation only if it differs from every
/// world.
ObservedComparison compare_with_worlds(ObservedComparison comparison, const statistics::Successes& observed,
                                       const std::vector<measures::MoveCounts>& worlds) {
  comparison.in_worlds = true;
  for (const measures::MoveCounts& world : worlds) {
    if (world.moves == 0) continue;
    const statistics::ObservedTest test = test_of(observed, world);
    if (!comparison.test || test.p > comparison.test->p) comparison.test = test;
  }
  if (!comparison.test) comparison.reason = "no trial was simulated";
  return comparison;
}

/// Whether the real machine succeeded in a larger proportion of trials than the simulated machines.
bool is_better(const ObservedComparison& comparison) {
  return statistics::rate(comparison.counts.successes, comparison.counts.of) >
         statistics::rate(comparison.simulated.successes, comparison.simulated.trials);
}

}  // namespace

ObservedComparison compare_observed(const goal::Question& question, const measures::PointSummary& point,
                                    const study::ObservedCounts& counts) {
  ObservedComparison comparison{.counts = counts, .test = {}, .reason = ""};
  if (point.judged == 0) {
    comparison.reason = "no trial was simulated";
    return comparison;
  }
  const AskedTrials trials = asked_trials(question, point);
  comparison.simulated = {trials.all.met, trials.all.moves};
  if (point.machines.n > 0 && counts.of > point.machines.trials_of_machine) {
    comparison.reason = fmt::format("it takes {} trials or more on each simulated machine, here are {}",
                                    counts.of, point.machines.trials_of_machine);
    return comparison;
  }
  const statistics::Successes observed{counts.successes, counts.of};
  if (!trials.worlds.empty()) return compare_with_worlds(std::move(comparison), observed, trials.worlds);
  comparison.test = test_of(observed, trials.all);
  return comparison;
}

std::string_view verdict_on(const ObservedComparison& comparison, double confidence) {
  if (!comparison.test) return "untested";
  if (comparison.test->p <= 1.0 - confidence) return "differs";
  return comparison.test->lowest_p <= 1.0 - confidence ? "consistent" : "too_few";
}

std::string statement_on(const measures::PointSummary& point, const ObservedComparison& comparison,
                         double confidence) {
  if (!comparison.test) return "not tested: " + comparison.reason;
  const std::string p = text::short_number(comparison.test->p);
  if (comparison.in_worlds) {
    return comparison.test->p <= 1.0 - confidence
               ? fmt::format("differs from every world (p = {} in the nearest)", p)
               : fmt::format("consistent with some world (p = {})", p);
  }
  if (comparison.test->p <= 1.0 - confidence) {
    return fmt::format("differs (p = {}): the real machine succeeded {} often than the simulation says", p,
                       is_better(comparison) ? "more" : "less");
  }
  if (comparison.test->lowest_p > 1.0 - confidence) {
    return fmt::format("consistent (p = {}), as any result would be: the trials{} are too few", p,
                       point.machines.n > 0 ? " or the machines" : "");
  }
  return fmt::format("consistent (p = {})", p);
}

const std::vector<ObservedField>& observed_fields() {
  using O = const std::optional<ObservedComparison>&;
  static const std::vector<ObservedField> fields{
      {"", "observed_successes", "1", "trials that succeeded on the real machine", true,
       [](O o) { return o ? text::to_double(o->counts.successes) : statistics::unknown; }},
      {"", "observed_trials", "1", "trials on the real machine", true,
       [](O o) { return o ? text::to_double(o->counts.of) : statistics::unknown; }},
      {"", "observed_p_value", "1",
       "two-sided p-value of the trials on the real machine against those simulated", false,
       [](O o) { return o && o->test ? o->test->p : statistics::unknown; }}};
  return fields;
}

std::vector<layout::PointColumn> observed_columns(std::span<const measures::PointSummary> points,
                                                  const study::Study& study, std::int64_t first) {
  std::vector<layout::PointColumn> columns;
  if (study.observed_counts.empty() || study.features.dependent_trials) return columns;
  const goal::Question question = goal::question_of(study);
  for (const ObservedField& field : observed_fields()) {
    layout::PointColumn& column =
        columns.emplace_back(layout::PointColumn{field.name, field.unit, field.long_name, {}});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto counts =
          study.observed_counts.find(study.points.labels[static_cast<std::size_t>(first) + i]);
      column.values.push_back(field.value(counts == study.observed_counts.end()
                                              ? std::optional<ObservedComparison>()
                                              : compare_observed(question, points[i], counts->second)));
    }
  }
  return columns;
}

}  // namespace zerocount::summary
