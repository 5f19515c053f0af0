#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "analysis/statistics/observed_test.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary {
namespace {

/// The comparison of a point.
struct Comparison {
  study::ObservedCounts counts;
  std::optional<statistics::ObservedTest> test;  ///< empty if the counts cannot be tested
  std::string reason;                            ///< why not
  bool in_worlds{false};                         ///< with the world that is most like the real rig
};

/// The real rig lives in one world, which nobody knows: it differs from the simulation if it differs from
/// each world.
Comparison compare_with_worlds(const measures::PointSummary& point, const study::ObservedCounts& counts) {
  const statistics::Successes observed{counts.successes, counts.of};
  Comparison nearest{counts, std::nullopt, "no trial was simulated", true};
  for (const measures::MoveCounts& world : measures::in_worlds(point.worlds->succeeded)) {
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

Comparison compare(const measures::PointSummary& point, const study::ObservedCounts& counts) {
  if (point.judged == 0) return {counts, std::nullopt, "no trial was simulated"};
  if (point.worlds && (point.rigs.n == 0 || counts.of <= point.rigs.trials_of_rig))
    return compare_with_worlds(point, counts);
  const statistics::Successes observed{counts.successes, counts.of};
  if (point.rigs.n == 0) {
    return {counts, statistics::fisher_test(observed, {point.outcomes.zero_count, point.judged}), {}};
  }
  if (counts.of > point.rigs.trials_of_rig) {
    return {counts, std::nullopt,
            fmt::format("it takes {} trials or more on each simulated rig, here are {}", counts.of,
                        point.rigs.trials_of_rig)};
  }
  return {counts,
          statistics::rig_rank_test(observed, point.rigs.successes_of_rigs, point.rigs.trials_of_rig),
          {}};
}

/// Whether the real rig succeeded more often than the simulated trials.
bool is_better(const measures::PointSummary& point, const study::ObservedCounts& counts) {
  return statistics::rate(counts.successes, counts.of) >
         statistics::rate(point.outcomes.zero_count, point.judged);
}

const char* verdict_of(const Comparison& comparison, double confidence) {
  if (!comparison.test) return "untested";
  if (comparison.test->p <= 1.0 - confidence) return "differs";
  return comparison.test->lowest_p <= 1.0 - confidence ? "consistent" : "too_few";
}

std::string statement_of(const measures::PointSummary& point, const Comparison& comparison,
                         double confidence) {
  if (!comparison.test) return "not tested: " + comparison.reason;
  const std::string p = text::short_number(comparison.test->p);
  if (comparison.in_worlds) {
    return comparison.test->p <= 1.0 - confidence
               ? fmt::format("differs from every world (p = {} in the nearest)", p)
               : fmt::format("consistent with some world (p = {})", p);
  }
  if (comparison.test->p <= 1.0 - confidence) {
    return fmt::format("differs (p = {}): the real rig succeeded {} often than the simulation says", p,
                       is_better(point, comparison.counts) ? "more" : "less");
  }
  if (comparison.test->lowest_p > 1.0 - confidence) {
    return fmt::format("consistent (p = {}), as any result would be: the trials{} are too few", p,
                       point.rigs.n > 0 ? " or the rigs" : "");
  }
  return fmt::format("consistent (p = {})", p);
}

std::vector<std::optional<Comparison>> comparisons(
    std::span<const measures::PointSummary> points, const std::vector<std::string>& labels,
    const std::map<std::string, study::ObservedCounts>& counts) {
  std::vector<std::optional<Comparison>> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found = counts.find(labels[i]);
    if (found != counts.end()) result[i] = compare(points[i], found->second);
  }
  return result;
}

std::vector<layout::PointColumn> columns_of(const std::vector<std::optional<Comparison>>& comparisons) {
  std::vector<layout::PointColumn> columns{
      {"observed_successes", "1", "trials that succeeded on the real rig", {}},
      {"observed_trials", "1", "trials on the real rig", {}},
      {"observed_p_value",
       "1",
       "two-sided p-value of the trials on the real rig against those simulated",
       {}}};
  for (const std::optional<Comparison>& each : comparisons) {
    const auto number = [&](std::int64_t value) {
      return each ? static_cast<double>(value) : statistics::unknown;
    };
    columns[0].values.push_back(number(each ? each->counts.successes : 0));
    columns[1].values.push_back(number(each ? each->counts.of : 0));
    columns[2].values.push_back(each && each->test ? each->test->p : statistics::unknown);
  }
  return columns;
}

nlohmann::ordered_json json_of(const measures::PointSummary& point, const std::optional<Comparison>& each,
                               double confidence) {
  if (!each) return nullptr;
  return {{"successes", each->counts.successes},
          {"of", each->counts.of},
          {"p_value", each->test ? each->test->p : statistics::unknown},
          {"lowest_p_value", each->test ? each->test->lowest_p : statistics::unknown},
          {"verdict", verdict_of(*each, confidence)},
          {"statement", statement_of(point, *each, confidence)}};
}

std::string simulated_text(const measures::PointSummary& point) {
  if (point.judged == 0) return "–";
  return fmt::format("{} of {}{}", text::percentage(point.outcomes.zero_count, point.judged), point.judged,
                     point.rigs.n > 0 ? fmt::format(" on {} rigs", point.rigs.n) : "") +
         (point.worlds ? ", on average over the worlds" : "");
}

void add_text(measures::SummarySection& section, std::span<const measures::PointSummary> points,
              const std::vector<std::string>& labels,
              const std::vector<std::optional<Comparison>>& comparisons, double confidence) {
  text::PointTable table{{{"point", false, {}},
                          {"real rig", false, {}},
                          {"simulated", false, {}},
                          {"the simulation and the rig", false, {}}},
                         {}};
  bool rigs = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!comparisons[i]) continue;
    rigs = rigs || points[i].rigs.n > 0;
    table.columns[0].cells.push_back(text::printable(labels[i]));
    table.columns[1].cells.push_back(
        fmt::format("{} of {}", comparisons[i]->counts.successes, comparisons[i]->counts.of));
    table.columns[2].cells.push_back(simulated_text(points[i]));
    table.columns[3].cells.push_back(statement_of(points[i], *comparisons[i], confidence));
    table.points.push_back(static_cast<std::int64_t>(i));
  }
  section.tables.push_back(std::move(table));
  section.note = fmt::format(
      "{}, each point by itself: it differs where p ≤ {}. Consistent counts do not prove the simulation "
      "right: they only do not contradict it\n",
      rigs ? "rank of the real rig among the simulated ones, by as many trials of each"
           : "Fisher's exact test",
      text::percent(1.0 - confidence));
}

}  // namespace

measures::SummarySection observed_section(std::span<const measures::PointSummary> points,
                                          const std::vector<std::string>& labels,
                                          const std::map<std::string, study::ObservedCounts>& counts,
                                          double confidence) {
  const std::vector<std::optional<Comparison>> compared = comparisons(points, labels, counts);
  measures::SummarySection section{.key = observed_key, .json = {}, .columns = columns_of(compared)};
  section.of_success = true;
  add_text(section, points, labels, compared, confidence);
  for (std::size_t i = 0; i < points.size(); ++i)
    section.json.push_back(json_of(points[i], compared[i], confidence));
  return section;
}

std::vector<layout::PointColumn> observed_columns(std::span<const measures::PointSummary> points,
                                                  const study::Study& study, std::int64_t first) {
  if (study.observed_counts.empty() || study.features.dependent_trials) return {};
  const auto begin = study.point_labels.begin() + first;
  return columns_of(comparisons(points, {begin, begin + std::ssize(points)}, study.observed_counts));
}

}  // namespace zerocount::summary
