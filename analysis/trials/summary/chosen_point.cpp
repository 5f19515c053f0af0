#include "analysis/trials/summary/chosen_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/sums/moments.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::summary {
namespace {

/// Number of swept parameters that differ from 0 or "none" at the design point. A point with fewer of them is
/// simpler.
std::int64_t parts_in_use(const StudySummary& summary, std::size_t point) {
  return std::ranges::count_if(summary.axes, [&](const study::SweepAxis& axis) {
    if (axis.kind != study::SweepAxis::Kind::number) return false;
    const auto row = parameters::find_parameter(axis.name);
    const double value = axis.numbers[point];
    return value != 0.0 && !(row && parameters::parameter_table()[*row].none == value);
  });
}

/// Values by which design points are ranked, the most important first. Larger values are better.
std::vector<double> merits_of(const StudySummary& summary, std::size_t index) {
  if (summary.features.open_loop) return {};
  std::vector<double> merits = goal::merits_of(summary.question, summary.points[index]);
  merits.push_back(-static_cast<double>(parts_in_use(summary, index)));
  return merits;
}

const measures::PointSummary& point_of(const StudySummary& summary, std::int64_t point) {
  return summary.points[static_cast<std::size_t>(point)];
}

/// [machine] The machine's contribution to the proportion by which design points are compared: the proportion
/// of its moves that meet the goal or, if the goal is about machines, 1 or 0. Empty without machines.
std::vector<double> rates_of_machines(const goal::Question& question, const measures::MoveCounts& counts) {
  std::vector<double> rates;
  for (const statistics::MachineMoves& machine : counts.machines) {
    const double met = statistics::rate(machine.met, machine.moves);
    rates.push_back(!is_of_machines(question) ? met : met >= question.goal()->moves ? 1.0 : 0.0);
  }
  return rates;
}

/// Whether the mean of `better` − `worse` is shown to be positive. Both are [machine] contributions of two
/// design points.
bool differ(std::span<const double> better, std::span<const double> worse) {
  statistics::Moments differences;
  for (std::size_t i = 0; i < better.size(); ++i) differences.add(better[i] - worse[i]);
  const auto machines = static_cast<double>(better.size());
  if (better.size() < 2) return false;
  return differences.mean > statistics::student_t_quantile(machines - 1.0, statistics::summary_confidence) *
                                differences.sd() / std::sqrt(machines);
}

/// Estimate of a proportion from independent events, to which one success and one failure were added (Agresti
/// and Caffo).
struct AdjustedRate {
  double value{0.5};
  double variance{0.0};  ///< Estimated variance of `value`.

  explicit AdjustedRate(const statistics::ClusterSums& sums) {
    const double events = statistics::effective_events(sums) + 2.0;
    value = (statistics::rate(sums.hits, sums.events) * (events - 2.0) + 1.0) / events;
    variance = value * (1.0 - value) / events;
  }
};

/// Whether the bounds show that the worst world (draw of what all machines share) of the design point `other`
/// is worse than that of `best`.
bool has_worse_world(const goal::Question& question, const measures::PointSummary& best,
                     const measures::PointSummary& other) {
  const auto alone = [&](const measures::PointSummary& point) {
    const measures::CellCounts& counts = point.goals[question.parts.front().number];
    return goal::judge_goal(*question.goal(), counts.in_setting(verdict_on(question, point).setting), 1);
  };
  const goal::Verdict of_best = alone(best);
  const goal::Verdict of_other = alone(other);
  return is_of_machines(question) ? of_other.machines.high < of_best.machines.low
                                  : of_other.moves.high < of_best.moves.low;
}

/// Whether the trials show, with 95 % confidence, that the design point `other_point` is worse than
/// `best_point`.
bool is_shown_worse(const goal::Question& question, const measures::PointSummary& best_point,
                    const measures::PointSummary& other_point) {
  if (is_of_worst_world(question)) return has_worse_world(question, best_point, other_point);
  const measures::MoveCounts best = goal::counts_of(question, best_point);
  const measures::MoveCounts other = goal::counts_of(question, other_point);
  const std::vector<double> of_best = rates_of_machines(question, best);
  const std::vector<double> of_other = rates_of_machines(question, other);
  if (!of_best.empty() && of_best.size() == of_other.size()) return differ(of_best, of_other);
  const AdjustedRate a(measures::clusters_of(best)), b(measures::clusters_of(other));
  return a.value - b.value >
         statistics::normal_quantile(statistics::summary_confidence) * std::sqrt(a.variance + b.variance);
}

std::vector<EndOfRange> ends_at(const StudySummary& summary, std::int64_t point) {
  std::vector<EndOfRange> ends;
  for (std::size_t i = 0; i < summary.axes.size(); ++i) {
    const study::SweepAxis& axis = summary.axes[i];
    if (axis.kind != study::SweepAxis::Kind::number) continue;
    std::vector<double> values = axis.numbers;
    std::erase_if(values, [](double value) { return std::isnan(value); });
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
    constexpr std::size_t fewest = 3;  // two values are alternatives, not a range
    if (values.size() < fewest) continue;
    const double here = axis.numbers[static_cast<std::size_t>(point)];
    if (here != 0.0 && (here == values.front() || here == values.back()))
      ends.push_back({i, here == values.front()});
  }
  return ends;
}

}  // namespace

std::vector<std::int64_t> points_by_merit(const StudySummary& summary) {
  std::vector<std::pair<std::vector<double>, std::int64_t>> points;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    if (summary.points[i].trials > 0)
      points.emplace_back(merits_of(summary, i), static_cast<std::int64_t>(i));
  }
  std::ranges::stable_sort(points, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::int64_t> order;
  order.reserve(points.size());
  for (const auto& [merits, point] : points) order.push_back(point);
  return order;
}

double value_at(const StudySummary& summary, const EndOfRange& end, std::int64_t point) {
  return summary.axes[end.axis].numbers[static_cast<std::size_t>(point)];
}

ChosenPoint choose_point(const StudySummary& summary, std::optional<std::int64_t> point) {
  const std::vector<std::int64_t> order = points_by_merit(summary);
  ChosenPoint chosen;
  chosen.point = point ? *point : order.empty() ? 0 : order.front();
  if (!point) chosen.chosen_from = std::max<std::int64_t>(1, std::ssize(order));
  if (summary.features.open_loop) return chosen;
  const measures::PointSummary& best = point_of(summary, chosen.point);
  const auto is_worse = [&](std::int64_t other) {
    return std::ranges::any_of(summary.question.parts, [&](const goal::JudgedCriterion& part) {
      const goal::Question question = only(summary.question, part.number);
      return is_shown_worse(question, best, point_of(summary, other));
    });
  };
  for (const std::int64_t other : order) {
    if (other == chosen.point) continue;
    if (!chosen.runner_up) chosen.runner_up = other;
    if (!is_worse(other)) chosen.as_good.push_back(other);
  }
  std::ranges::sort(chosen.as_good);
  if (!order.empty() && chosen.point == order.front()) chosen.ends = ends_at(summary, chosen.point);
  return chosen;
}

std::string name_of_chosen(const StudySummary& summary, const ChosenPoint& chosen) {
  const std::string name = point_names(summary)[static_cast<std::size_t>(chosen.point)];
  return chosen.chosen_from > 1 ? fmt::format("best of {} points: {}", chosen.chosen_from, name) : name;
}

std::string claim_of_chosen_point(const StudySummary& summary, const ChosenPoint& chosen) {
  const measures::PointSummary& point = point_of(summary, chosen.point);
  const std::string name = name_of_chosen(summary, chosen) + ": ";
  if (summary.features.dependent_trials) {
    const std::string_view of_mass = summary.question.of_mass;
    return name + fmt::format("{} of {} trials {}; dependent trials give no bounds",
                              point.outcomes.zero_count, point.trials,
                              of_mass.empty() ? "succeeded" : fmt::format("ended at zero counts{}", of_mass));
  }
  return name + averaged_over(summary) +
         statistics::claim_sentence(goal::claim_of_chosen(point, static_cast<std::size_t>(chosen.chosen_from),
                                                          summary.question.stopped),
                                    goal::success_predicate(summary.question));
}

std::string competition_text(const StudySummary& summary, const ChosenPoint& chosen) {
  const std::vector<std::string> names = point_names(summary);
  std::string text;
  if (!chosen.as_good.empty()) {
    constexpr std::size_t shown = 5;
    std::vector<std::string> others;
    for (std::size_t i = 0; i < std::min(chosen.as_good.size(), shown); ++i)
      others.push_back(names[static_cast<std::size_t>(chosen.as_good[i])]);
    text += fmt::format("  not shown to be worse (95 %): {}{}\n", fmt::join(others, ", "),
                        chosen.as_good.size() > shown
                            ? fmt::format(" and {} more points", chosen.as_good.size() - shown)
                            : "");
  }
  for (const EndOfRange& end : chosen.ends) {
    text += fmt::format("  {} = {:.6g} is the {} value of the sweep: {} ones may be better\n",
                        summary.axes[end.axis].name, value_at(summary, end, chosen.point),
                        end.lowest ? "lowest" : "highest", end.lowest ? "lower" : "higher");
  }
  return text;
}

}  // namespace zerocount::summary
