#include "analysis/trials/summary/cells_of_point.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"

namespace zerocount::summary {
namespace {

/// A design point with its statistics and, if the study has a goal, the verdict and the settling times.
struct Point {
  const StudySummary& summary;
  const measures::PointSummary& statistics;
  std::optional<goal::Verdict> verdict{};
  std::vector<goal::GoalTimes> times{};

  Point(const StudySummary& of, std::int64_t number, std::size_t points)
      : summary(of), statistics(of.points[static_cast<std::size_t>(number)]) {
    if (!of.question.goal() || statistics.judged == 0) return;
    verdict = verdict_on(of.question, statistics, points);
    times = goal_times(of.question, statistics);
  }
};

/// The proportion of trials that succeed. If the study has worlds (draws of what all machines share), the
/// lowest value and the lowest bounds over the worlds.
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

/// Whether one proportion of successful trials is worse than another. A proportion without trials is never
/// the worse one.
bool is_worse(const goal::BoundedProportion& one, const goal::BoundedProportion& other) {
  if (std::isnan(one.value) || std::isnan(other.value))
    return std::isnan(other.value) > std::isnan(one.value);
  return goal::standing_of(one) < goal::standing_of(other);
}

std::optional<double> known(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// Copies the name of the goal, the proportions and the status of a verdict into the cell.
void judge(CellOfPoint& cell, const goal::Question& question, const goal::ClaimVerdict& verdict) {
  const study::Goal& goal = *question.parts[verdict.goal].goal;
  if (!goal.name.empty()) cell.goal = goal.name;
  cell.rate = verdict.moves;
  cell.judged = judged_rate(goal, verdict);
  if (goal.machines) cell.machines = verdict.machines;
  cell.status = verdict.status;
}

/// The cell (table entry) of all trials in these settings (conditions at ages). Proportions, verdict and
/// settling time are those of the worst claim: the goal and setting with the worst verdict.
CellOfPoint cell_in(const Point& point, const std::vector<std::int64_t>& settings) {
  CellOfPoint cell;
  std::int64_t worst_setting = settings.front();
  const auto& [succeeded, meeting] = *point.statistics.trials_of_groups;
  for (const std::int64_t setting : settings) {
    const auto s = static_cast<std::size_t>(setting);
    const measures::MoveCounts successes = succeeded.sum({.setting = s});
    cell.trials += successes.moves;
    cell.success += successes.met;
    if (point.verdict) {
      cell.goal_met += meeting.sum({.setting = s}).met;
      continue;
    }
    const goal::BoundedProportion rate = success_of(succeeded.worlds_in(s), point.summary.confidence);
    if (setting != settings.front() && !is_worse(rate, cell.judged)) continue;
    cell.rate = cell.judged = rate;
    worst_setting = setting;
  }
  const auto label = [&](std::int64_t one) { return study::label_of(point.summary.question.settings, one); };
  if (settings.size() > 1) cell.worst_setting = label(worst_setting);
  if (!point.verdict) return cell;
  const goal::ClaimVerdict& worst = goal::worst_where(*point.verdict, [&](const goal::ClaimVerdict& one) {
    return std::ranges::find(settings, static_cast<std::int64_t>(one.setting)) != settings.end();
  });
  judge(cell, point.summary.question, worst);
  if (settings.size() > 1) cell.worst_setting = label(static_cast<std::int64_t>(worst.setting));
  cell.settling_time_p95 = known(goal::times_of_claim(point.times, worst).statistics->p95.value);
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
            return one.goal == times.part && one.setting == times.setting;
          }));
    if (!question.settings.empty()) claim.setting = study::label_of(question.settings, times.setting);
    const measures::MoveCounts counts =
        point.statistics.goals[question.parts[times.part].number].sum({.setting = times.setting});
    claim.moves = counts.moves;
    claim.met = counts.met;
    claim.settling_time_p95 = known(times.statistics->p95.value);
    claim.within = times.allowed;
  }
  return claims;
}

std::vector<CellOfPoint> settings_of_point(const StudySummary& summary, std::int64_t number,
                                           std::size_t points) {
  const Point point(summary, number, points);
  std::vector<CellOfPoint> cells;
  const study::Settings& settings = summary.question.settings;
  if (settings.empty() || !point.statistics.trials_of_groups) return cells;
  for (std::int64_t setting = 0; setting < settings.total(); ++setting) {
    cells.push_back(cell_in(point, {setting}));
    cells.back().setting = study::label_of(settings, setting);
  }
  return cells;
}

std::vector<CellOfPoint> ages_of_point(const StudySummary& summary, std::int64_t number, std::size_t points) {
  const goal::Question& question = summary.question;
  const std::vector<double>& at = question.settings.ages.at;
  const Point point(summary, number, points);
  std::vector<CellOfPoint> cells;
  if (at.empty() || !point.statistics.trials_of_groups) return cells;
  const study::SettingCounts counts_of_settings = question.settings.counts();
  for (std::size_t age = 0; age < at.size(); ++age) {
    cells.push_back(
        cell_in(point, study::settings_at_age(counts_of_settings, static_cast<std::int64_t>(age))));
    cells.back().age = at[age];
  }
  if (!point.verdict) return cells;
  const auto& counts = point.statistics.goals;
  const std::vector<goal::BoundedProportion> machines = goal::machines_at_ages(question, counts);
  const std::vector<goal::Survival> survival =
      goal::survival_of(goal::lives_of_machines(question, counts), at, question.goal()->confidence);
  for (std::size_t age = 0; age < at.size(); ++age) {
    cells[age].machines = machines[age];
    cells[age].living = survival[age].living;
  }
  return cells;
}

document::Description<CellOfPoint> cell_description(const goal::Question& question, CellsBy by) {
  const bool claims = by == CellsBy::claim;
  const bool with_goal = claims || question.goal();
  const auto bounded = [](std::optional<goal::BoundedProportion> CellOfPoint::*proportion) {
    return [proportion](const CellOfPoint& c) -> std::optional<document::Bounded> {
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
  document::Item setting{"condition", "condition", "condition under which every machine runs"};
  setting.optional = claims;
  if (claims)
    cell.value({.key = "goal", .heading = "goal", .meaning = "name of the goal", .optional = true},
               &CellOfPoint::goal)
        .value(setting, &CellOfPoint::setting);
  if (by == CellsBy::setting) cell.value(setting, [](const CellOfPoint& c) { return c.setting.value(); });
  if (by == CellsBy::age)
    cell.value({.key = "age",
                .heading = "age",
                .meaning = "age of the machines, in the unit of the manifest",
                .unit = question.settings.ages.at.empty() ? "" : question.settings.ages.unit,
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
  if (by == CellsBy::age)
    cell.value({.key = "worst_condition",
                .heading = "worst condition",
                .meaning = "the worst of several conditions, which rate and settling time are under",
                .optional = true},
               &CellOfPoint::worst_setting);
  if (by == CellsBy::age || (by == CellsBy::setting && has_several(question)))
    cell.value({.key = "goal",
                .heading = "worst goal",
                .meaning = "name of the goal that rate and settling time are of, the worst of several",
                .optional = true},
               &CellOfPoint::goal);
  const bool of_moves = with_goal && by != CellsBy::setting;
  cell.value(
      {.key = "rate",
       .heading = of_moves ? "moves in goal [bounds]" : "rate [bounds]",
       .meaning =
           "proportion of moves (under a condition of what the question is about, without a goal of trials), with one-sided bounds; "
           "of the worst goal, condition and world",
       .unit = "1",
       .notation = document::Notation::percent},
      [of_moves](const CellOfPoint& c) { return goal::bounded(of_moves ? c.rate : c.judged); });
  if (of_moves)
    cell.value(
        proportion(
            "machines", "machines in goal [bounds]",
            "proportion of machines that meet the goal, at an age under every condition, with one-sided bounds that allow for the few moves in which each was seen"),
        bounded(&CellOfPoint::machines));
  if (with_goal && by == CellsBy::age)
    cell.value(
        proportion(
            "living", "up to here [bounds]",
            "proportion of the machines that meet it at every age up to this one, with one-sided bounds of Clopper and Pearson, which take the verdict on each machine as it was seen"),
        bounded(&CellOfPoint::living));
  if (of_moves)
    cell.value(
        {.key = "settling_time_p95",
         .heading = "95 % within",
         .meaning =
             "95 % quantile of the settling time, of the goal and condition that the rate is of; none where it is not within the hold",
         .unit = "s",
         .optional = true},
        &CellOfPoint::settling_time_p95);
  if (claims)
    cell.value({"within", "allowed",
                "time from the start of a move that the goal allows, the longest of its moves", "s"},
               &CellOfPoint::within);
  if (with_goal)
    cell.value({.key = "status",
                .heading = "verdict",
                .meaning = "verdict on the goal",
                .words = goal::status_words(),
                .optional = !claims},
               [](const CellOfPoint& c) { return goal::text_of(c.status); });
  return cell;
}

std::size_t worst_cell(const std::vector<CellOfPoint>& cells) {
  return static_cast<std::size_t>(std::ranges::min_element(cells, is_worse, &CellOfPoint::judged) -
                                  cells.begin());
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
  if (ages.empty() || !question.goal()) return {};
  const auto text = [&](double age) { return study::age_text(question.settings.ages, age); };
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
  const study::Settings& settings = summary.question.settings;
  if (!worlds && settings.empty()) return "";
  std::vector<std::string_view> over;
  if (worlds) over.emplace_back("worlds");
  if (!settings.ages.at.empty()) over.emplace_back("ages");
  if (study::counts_conditions(settings)) over.emplace_back("conditions");
  return fmt::format("on average over the {}: ", fmt::join(over, " and "));
}

}  // namespace zerocount::summary
