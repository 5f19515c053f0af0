#include "analysis/summary/cells_of_point.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/lives.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/proportion.hpp"

namespace zerocount::summary {
namespace {

/// A point, judged where its study has a goal.
struct Point {
  const StudySummary& summary;
  const measures::PointSummary& statistics;
  std::optional<goal::Verdict> verdict{};
  std::vector<goal::GoalTimes> times{};

  Point(const StudySummary& of, std::int64_t number, std::size_t points)
      : summary(of), statistics(of.points[static_cast<std::size_t>(number)]) {
    if (!of.question.claim() || statistics.judged == 0) return;
    verdict = verdict_on(of.question, statistics, points);
    times = goal_times(of.question, statistics);
  }
};

/// Conditions that follow one another, such as those at one age.
struct Conditions {
  std::size_t first, count;

  bool contains(std::size_t condition) const { return condition >= first && condition < first + count; }
};

/// The proportion of trials that succeed; with worlds in the worst of them.
goal::BoundedProportion success_of(const std::vector<measures::MoveCounts>& worlds, double confidence) {
  const double each = statistics::confidence_of_each(confidence, worlds.size());
  goal::BoundedProportion lowest;
  for (std::size_t world = 0; world < worlds.size(); ++world) {
    const statistics::ClusterSums sums = measures::clusters_of(worlds[world]);
    const goal::BoundedProportion one{statistics::rate(worlds[world].met, worlds[world].moves),
                                      statistics::clustered_at_least(sums, each),
                                      statistics::clustered_at_most(sums, each)};
    lowest = world == 0 ? one : goal::lowest(lowest, one);
  }
  return lowest;
}

std::optional<double> known(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// What the verdict says of a claim.
void judge(CellOfPoint& cell, const goal::Question& question, const goal::ClaimVerdict& verdict) {
  const study::Goal& goal = *question.parts[verdict.goal].claim;
  if (!goal.name.empty()) cell.goal = goal.name;
  cell.rate = verdict.moves;
  cell.judged = goal.machines ? verdict.machines : verdict.moves;
  if (goal.machines) cell.machines = verdict.machines;
  cell.within = goal.within;
  cell.status = verdict.status;
}

/// All trials under these conditions: the worst claim gives the rates and the verdict, the slowest goal the
/// settling time.
CellOfPoint cell_under(const Point& point, const Conditions& conditions) {
  CellOfPoint cell;
  const auto& [succeeded, meeting] = *point.statistics.trials_of_groups;
  for (std::size_t c = conditions.first; c < conditions.first + conditions.count; ++c) {
    const measures::MoveCounts successes = succeeded.sum({.condition = c});
    cell.trials += successes.moves;
    cell.success += successes.met;
    if (point.verdict) {
      cell.goal_met += meeting.sum({.condition = c}).met;
      continue;
    }
    const goal::BoundedProportion rate = success_of(succeeded.worlds_under(c), point.summary.confidence);
    cell.rate = cell.judged = c == conditions.first ? rate : goal::lowest(cell.rate, rate);
  }
  if (!point.verdict) return cell;
  judge(cell, point.summary.question, goal::worst_where(*point.verdict, [&](const goal::ClaimVerdict& one) {
          return conditions.contains(one.condition);
        }));
  const goal::GoalTimes* slowest = nullptr;
  for (const goal::GoalTimes& one : point.times) {
    if (conditions.contains(one.condition) && (slowest == nullptr || !(one.share <= slowest->share)))
      slowest = &one;
  }
  if (slowest != nullptr) cell.settling_time_p95 = known(slowest->statistics->p95.value);
  return cell;
}

}  // namespace

std::vector<CellOfPoint> claims_of_point(const StudySummary& summary, std::int64_t number,
                                         std::size_t points) {
  const goal::Question& question = summary.question;
  const Point point(summary, number, points);
  std::vector<CellOfPoint> claims;
  for (const goal::GoalTimes& times : point.times) {
    CellOfPoint& claim = claims.emplace_back();
    judge(claim, question, *std::ranges::find_if(point.verdict->claims, [&](const goal::ClaimVerdict& one) {
            return one.goal == times.part && one.condition == times.condition;
          }));
    if (!question.conditions.empty()) claim.condition = question.conditions[times.condition];
    const measures::MoveCounts counts =
        point.statistics.goals[question.parts[times.part].number].sum({.condition = times.condition});
    claim.moves = counts.moves;
    claim.met = counts.met;
    claim.settling_time_p95 = known(times.statistics->p95.value);
  }
  return claims;
}

std::vector<CellOfPoint> conditions_of_point(const StudySummary& summary, std::int64_t number,
                                             std::size_t points) {
  const Point point(summary, number, points);
  std::vector<CellOfPoint> cells;
  for (std::size_t c = 0; point.statistics.trials_of_groups && c < summary.conditions.size(); ++c) {
    cells.push_back(cell_under(point, {c, 1}));
    cells.back().condition = summary.conditions[c];
  }
  return cells;
}

std::vector<CellOfPoint> ages_of_point(const StudySummary& summary, std::int64_t number, std::size_t points) {
  const goal::Question& question = summary.question;
  const std::vector<double>& at = question.ages.at;
  const Point point(summary, number, points);
  std::vector<CellOfPoint> cells;
  if (at.empty() || !point.statistics.trials_of_groups) return cells;
  const std::size_t of_age = summary.conditions.size() / at.size();
  for (std::size_t age = 0; age < at.size(); ++age) {
    cells.push_back(cell_under(point, {age * of_age, of_age}));
    cells.back().age = at[age];
  }
  if (!point.verdict) return cells;
  const auto& counts = point.statistics.goals;
  const std::vector<goal::BoundedProportion> machines = goal::machines_at_ages(question, counts);
  const std::vector<goal::Survival> survival =
      goal::survival_of(goal::lives_of_rigs(question, counts), at, question.claim()->confidence);
  for (std::size_t age = 0; age < at.size(); ++age) {
    cells[age].machines = machines[age];
    cells[age].living = survival[age].living;
  }
  return cells;
}

document::Description<CellOfPoint> cell_description(const goal::Question& question, CellsBy by) {
  using Of = const CellOfPoint&;
  const bool claims = by == CellsBy::claim;
  const bool with_goal = claims || question.claim();
  const auto bounded = [](std::optional<goal::BoundedProportion> CellOfPoint::*proportion) {
    return [proportion](Of c) -> std::optional<document::Bounded> {
      if (!(c.*proportion)) return std::nullopt;
      return goal::bounded(*(c.*proportion));
    };
  };
  const auto proportion = [](const char* key, const char* heading, const char* meaning) {
    return document::Item{.key = key,
                          .heading = heading,
                          .meaning = meaning,
                          .unit = "1",
                          .notation = document::Notation::percent,
                          .optional = true};
  };
  document::Description<CellOfPoint> cell;
  document::Item condition{.key = "condition", .heading = "condition", .meaning = "what every machine bears"};
  condition.optional = claims;
  if (claims)
    cell.value({.key = "goal", .heading = "goal", .meaning = "name of the goal", .optional = true},
               &CellOfPoint::goal)
        .value(condition, &CellOfPoint::condition);
  if (by == CellsBy::condition) cell.value(condition, [](Of c) { return c.condition.value(); });
  if (by == CellsBy::age)
    cell.value({.key = "age",
                .heading = "age",
                .meaning = "age of the machines, in the unit of the manifest",
                .unit = question.ages.at.empty() ? "" : question.ages.unit,
                .notation = document::Notation::exact},
               &CellOfPoint::age);
  if (claims) {
    cell.value({"moves", "moves", "moves that the goal asks, of all trials"}, &CellOfPoint::moves)
        .value({"met", "in goal", "of them, moves that meet the goal"}, &CellOfPoint::met);
  } else {
    cell.value({"trials", "trials", "trials under the condition, or at the age"}, &CellOfPoint::trials)
        .value({"success", "succeeded", "trials all of whose moves ended at zero error"},
               &CellOfPoint::success);
    if (with_goal)
      cell.value({.key = "goal_met",
                  .heading = "in goal",
                  .meaning = "trials all of whose moves meet the goal",
                  .optional = true},
                 &CellOfPoint::goal_met);
  }
  if (by == CellsBy::condition && has_several(question))
    cell.value({.key = "goal",
                .heading = "worst goal",
                .meaning = "name of the goal that the next numbers are of",
                .optional = true},
               &CellOfPoint::goal);
  const bool of_moves = with_goal && by != CellsBy::condition;
  cell.value({.key = "rate",
              .heading = of_moves ? "moves in goal [bounds]" : "rate [bounds]",
              .meaning = "proportion of moves (under a condition of what the question is about, without a "
                         "goal of trials), with one-sided bounds; of the worst goal, condition and world",
              .unit = "1",
              .notation = document::Notation::percent},
             [of_moves](Of c) { return goal::bounded(of_moves ? c.rate : c.judged); });
  if (of_moves)
    cell.value(proportion("machines", "machines in goal [bounds]",
                          "proportion of machines that meet the goal, at an age under every condition, with "
                          "one-sided bounds that allow for the few moves in which each was seen"),
               bounded(&CellOfPoint::machines));
  if (with_goal && by == CellsBy::age)
    cell.value(proportion("living", "up to here [bounds]",
                          "proportion of the machines that meet it at every age up to this one, with "
                          "one-sided bounds of Clopper and Pearson, which take the verdict on each machine "
                          "as it was seen"),
               bounded(&CellOfPoint::living));
  if (of_moves)
    cell.value({.key = "settling_time_p95",
                .heading = "95 % within",
                .meaning = "95 % quantile of the settling time, of the slowest goal and condition; none "
                           "where it is not within the hold",
                .unit = "s",
                .optional = true},
               &CellOfPoint::settling_time_p95);
  if (claims)
    cell.value({"within", "allowed", "settling time that the goal allows", "s"}, &CellOfPoint::within);
  if (with_goal)
    cell.value({.key = "status",
                .heading = "verdict",
                .meaning = "verdict on the goal",
                .words = goal::status_words(),
                .optional = !claims},
               [](Of c) { return goal::text_of(c.status); });
  return cell;
}

std::size_t worst_cell(const std::vector<CellOfPoint>& cells) {
  const auto key = [](const CellOfPoint& one) {
    return std::isnan(one.judged.value) ? 2.0 : one.judged.value;  // without trials: the last
  };
  return static_cast<std::size_t>(std::ranges::min_element(cells, {}, key) - cells.begin());
}

std::optional<double> met_until(const std::vector<CellOfPoint>& ages) {
  std::optional<double> until;
  for (const CellOfPoint& one : ages) {
    if (one.status != goal::Status::met) break;
    until = one.age;
  }
  return until;
}

std::optional<double> missed_from(const std::vector<CellOfPoint>& ages) {
  const auto missed = std::ranges::find(ages, goal::Status::missed, &CellOfPoint::status);
  return missed == ages.end() ? std::nullopt : std::optional(missed->age);
}

std::string ages_sentence(const goal::Question& question, const std::vector<CellOfPoint>& ages) {
  if (ages.empty() || !question.claim()) return {};
  const auto text = [&](double age) { return study::age_text(question.ages, age); };
  const std::optional<double> met = met_until(ages);
  const std::optional<double> missed = missed_from(ages);
  if (met == ages.back().age) return fmt::format("the goal is met at every age, up to {}", text(*met));
  const std::string sentence = met ? fmt::format("the goal is met up to {}", text(*met))
                                   : "the goal is not shown to be met at any age";
  return missed ? sentence + fmt::format(", and missed from {} on", text(*missed))
                : sentence + "; no age at which it is missed is shown";
}

std::string averaged_over(const StudySummary& summary) {
  const bool worlds = summary.question.worlds > 0;
  const bool conditions = !summary.conditions.empty();
  if (!worlds && !conditions) return "";
  std::vector<std::string_view> over;
  if (worlds) over.emplace_back("worlds");
  if (conditions && !summary.question.ages.at.empty()) over.emplace_back("ages");
  if (summary.conditions.size() > summary.question.ages.at.size()) over.emplace_back("conditions");
  return fmt::format("on average over the {}: ", fmt::join(over, " and "));
}

}  // namespace zerocount::summary
