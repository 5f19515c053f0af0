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
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "results/layout/header.hpp"
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

namespace {

/// Whether a swept parameter differs between any two points, or has a distribution at a point (shown by NaN).
bool varies(const study::SweepAxis& axis) {
  const auto differs = [](const auto& values) {
    return std::any_of(values.begin(), values.end(), [&](const auto& v) { return !(v == values.front()); });
  };
  return axis.kind == study::SweepAxis::Kind::text ? differs(axis.texts) : differs(axis.numbers);
}

std::string last_parts(const std::string& path, std::size_t parts) {
  std::size_t start = path.size();
  for (; parts > 0 && start != std::string::npos && start > 0; --parts) start = path.rfind('.', start - 1);
  return start == std::string::npos ? path : path.substr(start + 1);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

std::vector<const study::SweepAxis*> varying_parameters(std::span<const study::SweepAxis> axes) {
  std::vector<const study::SweepAxis*> found;
  for (const study::SweepAxis& axis : axes) {
    if (axis.name != "case" && varies(axis)) found.push_back(&axis);
  }
  return found;
}

std::string short_name(std::span<const study::SweepAxis> axes, const study::SweepAxis& axis) {
  const std::vector<const study::SweepAxis*> swept = varying_parameters(axes);
  const auto sections = std::count(axis.name.begin(), axis.name.end(), '.');
  for (std::size_t parts = 1; parts <= static_cast<std::size_t>(sections); ++parts) {
    std::string name = last_parts(axis.name, parts);
    const bool is_index = name.find_first_not_of("0123456789.") == std::string::npos;
    const bool unique = std::none_of(swept.begin(), swept.end(), [&](const study::SweepAxis* other) {
      return other->name != axis.name && last_parts(other->name, parts) == name;
    });
    if (unique && !is_index) return name;
  }
  return axis.name;
}

std::vector<std::string> short_labels(std::vector<std::string> labels,
                                      std::span<const study::SweepAxis> axes) {
  for (const study::SweepAxis& axis : axes) {
    const std::string name = short_name(axes, axis);
    for (std::string& label : labels) {
      replace_all(label, ", " + axis.name + "=", " " + name + "=");
      if (label.starts_with(axis.name + "=")) label.replace(0, axis.name.size(), name);
    }
  }
  return labels;
}

std::vector<std::string> point_names(const StudySummary& summary) {
  std::vector<std::string> names = short_labels(summary.labels, summary.axes);
  for (std::size_t i = 0; i < names.size(); ++i)
    names[i] = names[i] == summary.labels[i] ? text::printable(names[i])
                                             : fmt::format("{} ({})", i, text::printable(names[i]));
  return names;
}

namespace {

const measures::PointSummary& statistics_of(const StudySummary& summary, std::int64_t point) {
  return summary.points[static_cast<std::size_t>(point)];
}

/// The goal that belongs to the worst claim of the verdict.
const study::Goal& worst_goal(const StudySummary& summary, const goal::Verdict& verdict) {
  return *summary.question.parts[verdict.goal].goal;
}

/// Names of the goals that are missed: "'large' and 'small'". Empty if fewer than two are missed.
std::string missed_goals(const goal::Question& question, const goal::Verdict& verdict) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < question.parts.size(); ++i) {
    if (worst_of_goal(verdict, i).status == goal::Status::missed)
      names.push_back(fmt::format("'{}'", question.parts[i].goal->name));
  }
  if (names.size() < 2) return "";
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::size_t points_of(const ChosenPoint& chosen) {
  return static_cast<std::size_t>(chosen.chosen_from);
}

}  // namespace

JudgedPoint judge_point(const StudySummary& summary, const ChosenPoint& chosen) {
  JudgedPoint judged{chosen, {}, {}};
  const std::size_t points = points_of(chosen);
  const measures::PointSummary& statistics = statistics_of(summary, chosen.point);
  judged.verdict = verdict_on(summary.question, statistics, points);
  if (judged.verdict.status == goal::Status::undecided)
    judged.needs = needs_of(summary.question, statistics, points);
  return judged;
}

std::string judgement_headline(const StudySummary& summary, const JudgedPoint& judged) {
  const goal::Question& question = summary.question;
  const std::string name = name_of_chosen(summary, judged.chosen);
  const std::string under = under_text(question, judged.verdict.setting);
  const study::Goal& goal = worst_goal(summary, judged.verdict);
  const std::string worst =
      (has_several(question) ? fmt::format(" '{}'", goal.name) : "") + goal::of_mass(goal);
  switch (judged.verdict.status) {
    case goal::Status::met:
      if (has_several(question))
        return fmt::format("{}: all {} goals are met,{} by the least{}", name, question.parts.size(), worst,
                           under);
      return fmt::format("{}: the goal{} is met{}", name, worst,
                         under.empty() ? "" : ", by the least" + under);
    case goal::Status::missed:
      if (const std::string all = missed_goals(question, judged.verdict); !all.empty())
        return fmt::format("{}: the goals {} are missed,{} by the most{}", name, all, worst, under);
      return fmt::format("{}: the goal{} is missed{}", name, worst, under);
    case goal::Status::undecided:
      break;
  }
  return fmt::format("{}: it is undecided whether the goal{} is met{}", name, worst, under);
}

std::string judgement_details(const StudySummary& summary, const JudgedPoint& judged) {
  const ChosenPoint& chosen = judged.chosen;
  std::string text = goal::goals_text(summary.question, statistics_of(summary, chosen.point), judged.verdict);
  if (chosen.chosen_from > 1) text += "  the bounds allow for the choice of the point by these trials\n";
  if (const auto worlds = worlds_of_point(summary, chosen.point, points_of(chosen)))
    text += fmt::format(
        "  {}\n", bad_worlds_sentence(*worlds, world_inputs_of(summary, chosen.point), summary.question));
  if (judged.needs)
    text += fmt::format("  {}\n", goal::needs_sentence(worst_goal(summary, judged.verdict), *judged.needs,
                                                       summary.features.machines));
  return text + competition_text(summary, chosen);
}

std::string judgement_text(const StudySummary& summary, const JudgedPoint& judged) {
  return fmt::format("goal: {}\n{}\n{}", goal::claim_sentence(summary.question),
                     judgement_headline(summary, judged), judgement_details(summary, judged));
}

std::optional<SaturatedMoves> saturated_moves(const std::filesystem::path& path, const study::Study& study,
                                              const JudgedClaim& claim) {
  if (layout::has_sums(study.retention)) return {};
  const reading::AllTrialsFile all(path);
  const reading::AllTrialsFile file = all.in_setting(static_cast<std::int64_t>(claim.setting));
  const measures::MoveCriterion goal = measures::move_criteria_of(study)[claim.goal];
  const std::int64_t trials = file.header().trials;
  SaturatedMoves counts;
  measures::visit_trials(file, {claim.point * trials, trials}, [&](std::int64_t, const auto& moves) {
    for (const trial::MoveOutcome& move : moves) {
      if (!measures::asks(goal, move)) continue;
      const bool met = measures::meets(goal, move);
      ++(met ? counts.met : counts.missed);
      if (move.saturated) ++(met ? counts.met_saturated : counts.missed_saturated);
    }
  });
  return counts;
}

std::string saturation_sentence(const SaturatedMoves& moves) {
  constexpr double most = 0.5;
  constexpr double more = 0.1;  // of the moves: both kinds saturate alike where long moves accelerate
  if (moves.missed == 0 || moves.of_missed() < most) return "";
  if (moves.met > 0 && moves.of_missed() - moves.of_met() < more) return "";
  const std::string others =
      moves.met > 0 ? fmt::format(" (of the {} others {})", moves.met, moves.met_saturated) : "";
  return fmt::format(
      "  of the {} moves that miss the goal {} saturate{}: the converter clips the torque that the "
      "controller "
      "wants, and its range may be the cause\n",
      moves.missed, moves.missed_saturated, others);
}

}  // namespace zerocount::summary
