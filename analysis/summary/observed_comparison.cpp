#include "analysis/summary/observed_comparison.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "analysis/statistics/proportion.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary {
namespace {

/// The real rig lives in one world, which nobody knows: it differs from the simulation if it differs from
/// each world.
ObservedComparison compare_with_worlds(const std::vector<measures::MoveCounts>& worlds,
                                       const study::ObservedCounts& counts) {
  const statistics::Successes observed{counts.successes, counts.of};
  ObservedComparison nearest{counts, std::nullopt, "no trial was simulated", true};
  for (const measures::MoveCounts& world : worlds) {
    if (world.moves == 0) continue;
    statistics::ObservedTest test;
    if (world.rigs.empty()) {
      test = statistics::fisher_test(observed, {world.met, world.moves});
    } else {
      std::vector<std::int64_t> successes;
      for (const statistics::RigMoves& rig : world.rigs) successes.push_back(rig.met);
      test = statistics::rig_rank_test(observed, successes, world.rigs.front().trials);
    }
    if (!nearest.test || test.p > nearest.test->p) nearest.test = test;
  }
  return nearest;
}

/// Whether the real rig succeeded more often than the simulated trials.
bool is_better(const measures::PointSummary& point, const study::ObservedCounts& counts) {
  return statistics::rate(counts.successes, counts.of) >
         statistics::rate(point.outcomes.zero_count, point.judged);
}

}  // namespace

ObservedComparison compare_observed(const measures::PointSummary& point,
                                    const study::ObservedCounts& counts) {
  if (point.judged == 0) return {counts, std::nullopt, "no trial was simulated"};
  std::vector<measures::MoveCounts> worlds;
  if (point.trials_of_groups) worlds = point.trials_of_groups->succeeded.by_world();
  if (!worlds.empty() && (point.rigs.n == 0 || counts.of <= point.rigs.trials_of_rig))
    return compare_with_worlds(worlds, counts);
  const statistics::Successes observed{counts.successes, counts.of};
  if (point.rigs.n == 0) {
    return {counts, statistics::fisher_test(observed, {point.outcomes.zero_count, point.judged}), {}};
  }
  if (counts.of > point.rigs.trials_of_rig) {
    return {counts, std::nullopt,
            fmt::format("it takes {} trials or more on each simulated machine, here are {}", counts.of,
                        point.rigs.trials_of_rig)};
  }
  return {counts,
          statistics::rig_rank_test(observed, point.rigs.successes_of_rigs, point.rigs.trials_of_rig),
          {}};
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
                       is_better(point, comparison.counts) ? "more" : "less");
  }
  if (comparison.test->lowest_p > 1.0 - confidence) {
    return fmt::format("consistent (p = {}), as any result would be: the trials{} are too few", p,
                       point.rigs.n > 0 ? " or the machines" : "");
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
  for (const ObservedField& field : observed_fields()) {
    layout::PointColumn& column =
        columns.emplace_back(layout::PointColumn{field.name, field.unit, field.long_name, {}});
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto counts =
          study.observed_counts.find(study.points.labels[static_cast<std::size_t>(first) + i]);
      column.values.push_back(field.value(counts == study.observed_counts.end()
                                              ? std::optional<ObservedComparison>()
                                              : compare_observed(points[i], counts->second)));
    }
  }
  return columns;
}

}  // namespace zerocount::summary
