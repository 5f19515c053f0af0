#include "analysis/summary/ages_of_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/lives.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/summary/conditions_of_point.hpp"

namespace zerocount::summary {
namespace {

/// The worst claim at the age gives the rate and the verdict, the slowest goal the settling time.
void judge_at_age(const goal::Question& question, const goal::Verdict& of_point,
                  const std::vector<goal::GoalTimes>& times, std::size_t number, AgeOfPoint& age) {
  std::vector<goal::ClaimVerdict> claims = goal::claims_of(of_point);
  std::erase_if(claims,
                [&](const goal::ClaimVerdict& one) { return age_of(question, one.condition) != number; });
  const goal::ClaimVerdict worst =
      std::ranges::min(claims, [](const auto& a, const auto& b) { return is_worse(*a.verdict, *b.verdict); });
  age.rate = worst.verdict->moves;
  age.status = worst.verdict->status;
  const goal::GoalTimes* slowest = nullptr;
  for (const goal::GoalTimes& one : times) {
    if (age_of(question, one.condition) == number && (slowest == nullptr || !(one.share <= slowest->share)))
      slowest = &one;
  }
  if (slowest != nullptr && !std::isnan(slowest->statistics->p95.value))
    age.settling_time_p95 = slowest->statistics->p95.value;
}

/// The lowest rate of success among the conditions of each age.
void add_success_rates(const std::vector<ConditionOfPoint>& conditions, std::vector<AgeOfPoint>& ages) {
  const std::size_t of_age = conditions.size() / ages.size();
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    AgeOfPoint& age = ages[i / of_age];
    age.rate = i % of_age == 0 ? conditions[i].rate : goal::lowest(age.rate, conditions[i].rate);
  }
}

}  // namespace

std::vector<AgeOfPoint> ages_of_point(const StudySummary& summary, std::int64_t point, std::size_t points) {
  const goal::Question& question = summary.question;
  const measures::PointSummary& statistics = summary.points[static_cast<std::size_t>(point)];
  std::vector<AgeOfPoint> ages;
  if (question.ages.at.empty() || !statistics.conditions) return ages;
  for (const double age : question.ages.at) ages.push_back({.age = age});
  const std::vector<ConditionOfPoint> conditions = conditions_of_point(summary, point, points);
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    AgeOfPoint& age = ages[i / (conditions.size() / ages.size())];
    age.trials += conditions[i].trials;
    age.success += conditions[i].success;
    if (conditions[i].goal_met) age.goal_met = age.goal_met.value_or(0) + *conditions[i].goal_met;
  }
  if (!question.claim()) {
    add_success_rates(conditions, ages);
    return ages;
  }
  const goal::Verdict verdict = verdict_on(question, statistics, points);
  const std::vector<goal::GoalTimes> times = goal_times(question, statistics);
  const std::vector<goal::BoundedProportion> machines = goal::machines_at_ages(question, statistics.goals);
  const std::vector<goal::Survival> survival = goal::survival_of(
      goal::lives_of_rigs(question, statistics.goals), question.ages.at, question.claim()->confidence);
  for (std::size_t age = 0; age < ages.size(); ++age) {
    ages[age].machines = machines[age];
    ages[age].living = survival[age].living;
    judge_at_age(question, verdict, times, age, ages[age]);
  }
  return ages;
}

document::Description<AgeOfPoint> age_description(const goal::Question& question) {
  using Of = const AgeOfPoint&;
  const auto proportion = [](const std::optional<goal::BoundedProportion>& of) {
    return of ? std::optional<document::Bounded>(goal::bounded(*of)) : std::nullopt;
  };
  document::Description<AgeOfPoint> description;
  description
      .value({.key = "age",
              .heading = "age",
              .meaning = "age of the machines, in the unit of the manifest",
              .unit = question.ages.at.empty() ? "" : question.ages.unit,
              .notation = document::Notation::exact},
             &AgeOfPoint::age)
      .value({"trials", "trials", "trials at the age"}, &AgeOfPoint::trials)
      .value({"success", "succeeded", "trials all of whose moves ended at zero error"}, &AgeOfPoint::success);
  if (question.claim())
    description.value({.key = "goal_met",
                       .heading = "in goal",
                       .meaning = "trials all of whose moves meet the goal",
                       .optional = true},
                      &AgeOfPoint::goal_met);
  description.value({.key = "rate",
                     .heading = question.claim() ? "moves in goal [bounds]" : "rate [bounds]",
                     .meaning = "proportion of moves (trials without a goal), with one-sided bounds; of the "
                                "worst goal, condition and world",
                     .unit = "1",
                     .notation = document::Notation::percent},
                    [](Of a) { return goal::bounded(a.rate); });
  if (!question.claim()) return description;
  description
      .value({.key = "machines",
              .heading = "machines in goal [bounds]",
              .meaning = "proportion of machines that meet the goal at the age under every condition, with "
                         "one-sided bounds that allow for the few moves in which each was seen",
              .unit = "1",
              .notation = document::Notation::percent,
              .optional = true},
             [proportion](Of a) { return proportion(a.machines); })
      .value(
          {.key = "living",
           .heading = "up to here [bounds]",
           .meaning = "proportion of the machines that meet it at every age up to this one, with one-sided "
                      "bounds of Clopper and Pearson, which take the verdict on each machine as it was seen",
           .unit = "1",
           .notation = document::Notation::percent,
           .optional = true},
          [proportion](Of a) { return proportion(a.living); })
      .value(
          {.key = "settling_time_p95",
           .heading = "95 % within",
           .meaning = "95 % quantile of the settling time, of the slowest goal and condition; null where it "
                      "is not within the hold",
           .unit = "s",
           .optional = true},
          &AgeOfPoint::settling_time_p95)
      .value({.key = "status",
              .heading = "verdict",
              .meaning = "verdict on the goal at the age",
              .words = goal::status_words(),
              .optional = true},
             [](Of a) {
               return a.status ? std::optional(std::string(goal::text_of(*a.status))) : std::nullopt;
             });
  return description;
}

std::optional<double> met_until(const std::vector<AgeOfPoint>& ages) {
  std::optional<double> until;
  for (const AgeOfPoint& one : ages) {
    if (one.status != goal::Status::met) break;
    until = one.age;
  }
  return until;
}

std::optional<double> missed_from(const std::vector<AgeOfPoint>& ages) {
  const auto missed = std::ranges::find(ages, std::optional(goal::Status::missed), &AgeOfPoint::status);
  return missed == ages.end() ? std::nullopt : std::optional(missed->age);
}

std::string ages_sentence(const goal::Question& question, const std::vector<AgeOfPoint>& ages) {
  if (ages.empty() || !question.claim()) return {};
  const auto text = [&](double age) { return study::age_text(question.ages, age); };
  const std::optional<double> met = met_until(ages);
  const std::optional<double> missed = missed_from(ages);
  const bool all = met == ages.back().age;
  if (all) return fmt::format("the goal is met at every age, up to {}", text(*met));
  std::string sentence = met ? fmt::format("the goal is met up to {}", text(*met))
                             : "the goal is not shown to be met at any age";
  return missed ? sentence + fmt::format(", and missed from {} on", text(*missed))
                : sentence + "; no age at which it is missed is shown";
}

}  // namespace zerocount::summary
