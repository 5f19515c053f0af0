#include "analysis/trials/summary/cells_of_point.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/goal/question_text.hpp"

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

namespace {

using document::Description;
using document::Notation;
using document::Visibility;

struct NamedRule {
  const worlds::WorldRule& rule;
  const std::vector<worlds::WorldInput>& inputs;
};

struct NamedCondition {
  const worlds::Condition& condition;
  const worlds::WorldInput& input;
};

std::vector<NamedCondition> readings(const std::vector<worlds::Condition>& conditions,
                                     const std::vector<worlds::WorldInput>& inputs) {
  std::vector<NamedCondition> readings;
  readings.reserve(conditions.size());
  for (const worlds::Condition& one : conditions) readings.push_back({one, inputs[one.input]});
  return readings;
}

Description<NamedCondition> condition_description() {
  return Description<NamedCondition>()
      .value(document::in_data("parameter", "dotted path, or name of a derived quantity"),
             [](const NamedCondition& r) { return r.input.name; })
      .value({.key = "relation", .meaning = "sign between parameter and value", .words = {">", "<"}},
             [](const NamedCondition& r) { return r.condition.above ? ">" : "<"; })
      .value(document::in_data("value", "threshold, in the unit of the parameter"),
             [](const NamedCondition& r) { return r.condition.threshold; });
}

Description<NamedRule> rule_description() {
  return Description<NamedRule>()
      .value(document::in_data("text", "the rule in words"),
             [](const NamedRule& r) { return worlds::text_of(r.rule, r.inputs); })
      .table({.key = "conditions", .meaning = "conditions of the rule"}, condition_description(),
             [](const NamedRule& r) { return readings(r.rule.conditions, r.inputs); })
      .table({.key = "same", .meaning = "conditions each of which alone names the same worlds"},
             condition_description(), [](const NamedRule& r) { return readings(r.rule.same, r.inputs); })
      .value({.key = "joined_by", .meaning = "how the conditions are joined", .words = {"and", "or"}},
             [](const NamedRule& r) { return r.rule.all ? "and" : "or"; })
      .value(document::in_data("bad_named", "bad worlds that the rule names"),
             [](const NamedRule& r) { return r.rule.bad_named; })
      .value(document::in_data("others_named", "other worlds that it names"),
             [](const NamedRule& r) { return r.rule.good_named; })
      .value(document::in_data("error_rate", "proportion of worlds named wrongly", "1"),
             [](const NamedRule& r) { return r.rule.error_rate(); })
      .value(document::in_data("p_value", "probability of such a rule by chance", "1"),
             [](const NamedRule& r) { return r.rule.p_value; });
}

Description<worlds::RatesOfWorlds> rates_description() {
  using Rates = const worlds::RatesOfWorlds&;
  return Description<worlds::RatesOfWorlds>()
      .value(document::in_data("worst", "rate of the worst world, with one-sided bounds", "1"),
             [](Rates r) { return goal::bounded(r.lowest); })
      .value(document::in_data("median", "median of the rates", "1"), &worlds::RatesOfWorlds::median)
      .value(document::in_data("best", "rate of the best world", "1"),
             [](Rates r) { return r.worlds[r.best].value; })
      .value({.key = "worst_world", .meaning = "index of the worst world", .shown = Visibility::in_json},
             &worlds::RatesOfWorlds::worst)
      .value({.key = "best_world", .meaning = "index of the best world", .shown = Visibility::in_json},
             &worlds::RatesOfWorlds::best);
}

std::vector<double> rates_of(const worlds::PointWorlds& point) {
  std::vector<double> rates;
  for (const goal::BoundedProportion& world : point.success.worlds) rates.push_back(world.value);
  return rates;
}

/// [world] The result of the function `value` for the verdict on each world (a draw of what all machines
/// share); nothing without a goal.
template <class Value>
auto of_verdicts(const worlds::PointWorlds& point, Value value) {
  using Values = std::vector<std::invoke_result_t<Value, const goal::WorldVerdict&>>;
  if (!point.goal) return std::optional<Values>();
  Values values;
  for (const goal::WorldVerdict& world : point.goal->worlds) values.push_back(value(world));
  return std::optional(std::move(values));
}

std::vector<std::size_t> bad_worlds_of(const worlds::PointWorlds& point) {
  std::vector<std::size_t> bad;
  for (std::size_t world = 0; world < point.bad.size(); ++world) {
    if (point.bad[world]) bad.push_back(world);
  }
  return bad;
}

/// Adds table columns for people: the rate by which the study is judged in the worst, the median and the best
/// world (draw of what all machines share).
void add_judged_rates(Description<WorldsAtPoint>& description, const goal::Question& question) {
  const auto column = [](std::string heading) {
    return document::Item{.heading = std::move(heading), .unit = "1", .notation = Notation::percent};
  };
  description
      .value(column(fmt::format("{} worst [bounds]", goal::head_of_judged_rate(question))),
             [](const WorldsAtPoint& r) { return goal::bounded(r.point.asked.lowest); })
      .value(column("median"), [](const WorldsAtPoint& r) { return r.point.asked.median; })
      .value(column("best"),
             [](const WorldsAtPoint& r) { return r.point.asked.worlds[r.point.asked.best].value; });
}

/// Adds an item with the number of worlds (draws of what all machines share) in which the goal has this
/// status.
/// @param in_csv whether the CSV has a column for the number
void add_number_of_worlds(Description<WorldsAtPoint>& description, goal::Status status, bool in_csv) {
  const std::string word(goal::text_of(status));
  description.value({.key = word,
                     .heading = "goal " + word,
                     .meaning = "worlds in which the goal is " + word,
                     .shown = in_csv ? Visibility::everywhere : Visibility::not_in_csv,
                     .column = "worlds_goal_" + word,
                     .optional = true},
                    [status](const WorldsAtPoint& r) -> std::optional<std::size_t> {
                      if (!r.point.goal) return {};
                      return goal::worlds_that(status, *r.point.goal).size();
                    });
}

/// Text on other conditions that separate the same worlds as the rule: ", or where creep_rate > 2e-05 rad/s,
/// which are the same worlds". Empty if there are none.
std::string same_text(const worlds::WorldRule& rule, const std::vector<worlds::WorldInput>& inputs) {
  std::vector<std::string> conditions;
  for (const worlds::Condition& one : rule.same) conditions.push_back(worlds::text_of(one, inputs));
  if (conditions.empty()) return "";
  return fmt::format(", or where {}, which are the same worlds", fmt::join(conditions, ", or "));
}

/// Explanations of the derived quantities in the rule: "; creep_rate: speed at which …" for each; empty
/// without any.
std::string meanings_text(const worlds::WorldRule& rule, const std::vector<worlds::WorldInput>& inputs) {
  std::string text;
  for (const std::vector<worlds::Condition>* conditions : {&rule.conditions, &rule.same}) {
    for (const worlds::Condition& one : *conditions) {
      const worlds::WorldInput& input = inputs[one.input];
      if (input.is_derived()) text += fmt::format("; {}: {}", input.name, input.meaning);
    }
  }
  return text;
}

}  // namespace

std::optional<worlds::PointWorlds> worlds_of_point(const StudySummary& summary, std::int64_t point,
                                                   std::size_t chosen_from) {
  const measures::PointSummary& one = summary.points[static_cast<std::size_t>(point)];
  if (!one.trials_of_groups || summary.question.worlds == 0) return std::nullopt;
  for (const measures::MoveCounts& world : one.trials_of_groups->succeeded.by_world()) {
    if (world.moves == 0) return std::nullopt;  // of an unfinished run
  }
  return worlds::point_worlds(one, summary.question, summary.world_inputs[static_cast<std::size_t>(point)],
                              summary.seed, summary.confidence, chosen_from);
}

std::string bad_worlds_sentence(const worlds::PointWorlds& point,
                                const std::vector<worlds::WorldInput>& inputs,
                                const goal::Question& question) {
  const auto bad = std::count(point.bad.begin(), point.bad.end(), true);
  const std::int64_t all = std::ssize(point.bad);
  const std::string_view what = question.goal() ? "fall short of the goal by their observed rates"
                                                : "are shown to succeed less often than the median world";
  if (bad == 0 || bad == all) return fmt::format("{} of {} worlds {}", bad == 0 ? "none" : "all", all, what);
  if (!point.rule) {
    return fmt::format(
        "{} of {} worlds {}, and no rule on one or two parameters distinguishes them from the others (at a "
        "significance of {})",
        bad, all, what, text::percent(worlds::significance_of_rules));
  }
  const worlds::WorldRule& rule = *point.rule;
  return fmt::format(
      "{} of {} worlds {}: where {} ({} of these {}, and {} of the other {}: {} of worlds named wrongly; by "
      "chance with probability {:.2g}){}; what separates them need not be the cause{}",
      bad, all, what, worlds::text_of(rule, inputs), rule.bad_named, rule.bad, rule.good_named, rule.good,
      text::percent_near(rule.error_rate()), rule.p_value, same_text(rule, inputs),
      meanings_text(rule, inputs));
}

Description<WorldsAtPoint> worlds_description(const goal::Question& question) {
  Description<WorldsAtPoint> description;
  add_judged_rates(description, question);
  description
      .value({.key = "n", .meaning = "number of worlds", .shown = Visibility::in_json},
             [](const WorldsAtPoint& r) { return r.point.bad.size(); })
      .object({.key = "success", .meaning = "rates of success by world"}, rates_description(),
              [](const WorldsAtPoint& r) { return r.point.success; })
      .value({.key = "success_rates",
              .meaning = "rate of success of each world",
              .unit = "1",
              .shown = Visibility::in_json},
             [](const WorldsAtPoint& r) { return rates_of(r.point); })
      .value({.key = "goal_rates",
              .meaning = "proportion of moves of each world that meet the goal",
              .unit = "1",
              .shown = Visibility::in_json,
              .optional = true},
             [](const WorldsAtPoint& r) {
               return of_verdicts(r.point, [](const goal::WorldVerdict& w) { return w.moves.value; });
             })
      .value({.key = "goal_status",
              .meaning = "verdict of each world",
              .shown = Visibility::in_json,
              .words = goal::status_words(),
              .optional = true},
             [](const WorldsAtPoint& r) {
               return of_verdicts(r.point,
                                  [](const goal::WorldVerdict& w) { return goal::text_of(w.status); });
             });
  if (question.goal()) {
    for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided})
      add_number_of_worlds(description, status, status != goal::Status::undecided);
  }
  return description
      .value({.key = "bad_worlds",
              .meaning = "indices of the worlds that fall short",
              .shown = Visibility::in_json},
             [](const WorldsAtPoint& r) { return bad_worlds_of(r.point); })
      .object({.key = "rule", .meaning = "what the bad worlds have in common", .shown = Visibility::in_json},
              rule_description(),
              [](const WorldsAtPoint& r) -> std::optional<NamedRule> {
                if (!r.point.rule) return {};
                return NamedRule{*r.point.rule, r.inputs};
              })
      .sentence([](const WorldsAtPoint& r) { return bad_worlds_sentence(r.point, r.inputs, r.question); });
}

}  // namespace zerocount::summary
