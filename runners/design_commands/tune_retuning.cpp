#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/text/text.hpp"
#include "runners/design_commands/tune_figures.hpp"
#include "runners/design_commands/tune_parts.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Notation;
using document::Shown;
using tuning::AgeVerdict;
using tuning::RetunedInterval;
using tuning::Retuning;

/// A claim at an age of an interval.
struct RetunedRow {
  const study::Study& study;
  const RetunedInterval& of;
  std::size_t age;    ///< of the interval
  std::size_t claim;  ///< of claims_of_life()

  tuning::ClaimOfLife place() const { return tuning::claims_of_life(study)[claim]; }
  document::Bounded one_set() const { return goal::bounded(of.one_set[age].rates[claim]); }
  std::optional<document::Bounded> retuned() const {
    if (of.retuned.empty()) return std::nullopt;
    return goal::bounded(of.retuned[age].rates[claim]);
  }
};

/// @param chosen the claims of a verdict to show
template <class Chosen>
std::vector<RetunedRow> rows_of(Of tuning, const Chosen& chosen) {
  std::vector<RetunedRow> rows;
  if (!tuning.answer.retuning) return rows;
  for (const RetunedInterval& one : tuning.answer.retuning->intervals) {
    for (std::size_t age = 0; age < one.one_set.size(); ++age) {
      for (const std::size_t claim : chosen(one.one_set[age]))
        rows.push_back({tuning.study, one, age, claim});
    }
  }
  return rows;
}

std::vector<RetunedRow> all_rows(Of tuning) {
  return rows_of(tuning, [](const AgeVerdict& at) {
    std::vector<std::size_t> claims(at.rates.size());
    for (std::size_t i = 0; i < claims.size(); ++i) claims[i] = i;
    return claims;
  });
}

/// The claim that does worst with the one set of values.
std::vector<RetunedRow> worst_rows(Of tuning) {
  return rows_of(tuning,
                 [&](const AgeVerdict& at) { return std::vector{tuning::worst_claim_at(tuning.study, at)}; });
}

std::optional<std::string> goal_name_of(const RetunedRow& row) {
  if (row.study.goals.size() < 2) return std::nullopt;
  return row.study.goals[row.place().goal].name;
}

std::optional<std::string> condition_name_of(const RetunedRow& row) {
  if (row.study.condition_names.empty()) return std::nullopt;
  return row.study.condition_names[row.place().condition];
}

Description<RetunedRow> age_columns() {
  using Row = const RetunedRow&;
  return Description<RetunedRow>()
      .value(
          {.key = "from", .heading = "tuned at", .meaning = "beginning of the interval, in the unit of ages"},
          [](Row row) { return row.of.interval.from(); })
      .value({.key = "age", .heading = "at age", .meaning = "age of the interval, up to its end"},
             [](Row row) { return row.of.interval.ages[row.age]; })
      .value({.heading = "unit", .shown = Shown::to_people}, [](Row row) { return row.study.ages.unit; })
      .value({.key = "goal", .heading = "goal", .meaning = "name of the goal, of several", .optional = true},
             goal_name_of)
      .value({.key = "condition",
              .heading = "condition",
              .meaning = "name of the condition, with conditions",
              .optional = true},
             condition_name_of)
      .value({.key = "one_set",
              .heading = "one set of values",
              .meaning = "proportion of moves, or of machines, that meet the goal with the values for the "
                         "whole life, with one-sided bounds",
              .unit = "1",
              .notation = Notation::percent},
             &RetunedRow::one_set)
      .value({.key = "retuned",
              .heading = "tuned again",
              .meaning = "the same with the values of the interval; null: none keep the margins",
              .unit = "1",
              .notation = Notation::percent},
             &RetunedRow::retuned);
}

struct IntervalRow {
  const RetunedInterval& of;
  const std::vector<study::FreeParameter>& free;
  const study::Study& study;
};

std::vector<IntervalRow> interval_rows(Of tuning) {
  std::vector<IntervalRow> rows;
  if (!tuning.answer.retuning) return rows;
  for (const RetunedInterval& one : tuning.answer.retuning->intervals)
    rows.push_back({one, tuning.answer.free, tuning.study});
  return rows;
}

double latest_of(const std::vector<AgeVerdict>& ages) {
  return std::ranges::max(ages, {}, &AgeVerdict::criterion).criterion;
}

Description<IntervalRow> interval_columns() {
  using Row = const IntervalRow&;
  return Description<IntervalRow>()
      .value({.key = "from", .heading = "from", .meaning = "beginning of the interval, in the unit of ages"},
             [](Row row) { return row.of.interval.from(); })
      .value({.key = "to", .heading = "to", .meaning = "its end"},
             [](Row row) { return row.of.interval.to(); })
      .value({.heading = "unit", .shown = Shown::to_people}, [](Row row) { return row.study.ages.unit; })
      .value(in_data("gains", "values for the interval by parameter; none if none keep the margins"),
             [](Row row) { return named(row.free, row.of.gains); })
      .value({.heading = "values", .shown = Shown::to_people},
             [](Row row) {
               return row.of.gains.empty() ? std::string("none keeps the margins")
                                           : values_text(named(row.free, row.of.gains));
             })
      .value({.key = "criterion_name",
              .heading = "criterion",
              .meaning = "quantity that is minimised, with its unit"},
             [](Row row) { return criterion_title(row.study); })
      .value({.key = "criterion_one_set",
              .heading = "with one set (–: never)",
              .meaning = "the criterion, the largest of the interval, with the values for the whole life; "
                         "unknown for never"},
             [](Row row) { return latest_of(row.of.one_set); })
      .value({.key = "criterion",
              .heading = "tuned again",
              .meaning = "the same with the values of the interval"},
             [](Row row) -> std::optional<double> {
               if (row.of.retuned.empty()) return std::nullopt;
               return latest_of(row.of.retuned);
             })
      .value(in_data("machines", "fresh machines, or draws, that it was simulated on"),
             [](Row row) { return row.of.units; });
}

/// Over all intervals: ages, and those at which every goal is shown to be met.
struct MetAges {
  std::size_t ages{0}, one_set{0}, retuned{0};
};

MetAges met_ages(const Retuning& retuning) {
  MetAges met;
  for (const RetunedInterval& one : retuning.intervals) {
    met.ages += one.one_set.size();
    met.one_set += static_cast<std::size_t>(std::ranges::count_if(one.one_set, tuning::is_met_at));
    met.retuned += static_cast<std::size_t>(std::ranges::count_if(one.retuned, tuning::is_met_at));
  }
  return met;
}

/// Intervals in which the values of the whole life do better on the fresh machines than those of the search.
std::size_t intervals_for_one_set(const Retuning& retuning) {
  return static_cast<std::size_t>(std::ranges::count_if(retuning.intervals, [](const RetunedInterval& one) {
    return !one.retuned.empty() && latest_of(one.one_set) < latest_of(one.retuned);
  }));
}

std::string retuning_sentence(Of tuning) {
  if (!tuning.answer.retuning || tuning.answer.retuning->intervals.empty()) return "";
  const Retuning& retuning = *tuning.answer.retuning;
  const MetAges met = met_ages(retuning);
  std::string text = fmt::format(
      "tuned again every {}, in {} of {} intervals: {} shown to be met at {} of {} ages, at the beginning "
      "and "
      "the end of each interval and between them; with the one set of values for the whole life at {}",
      study::age_text(tuning.study.ages, retuning.every), retuning.intervals.size(), retuning.wanted,
      tuning.study.goals.size() > 1 ? "all goals are" : "the goal is", met.retuned, met.ages, met.one_set);
  if (const std::size_t better = intervals_for_one_set(retuning); better > 0)
    text +=
        fmt::format("; in {} of the intervals the one set has the better criterion: keep it there", better);
  return text;
}

}  // namespace

void add_retuning(Description<Tuning>& items) {
  items.sentence(retuning_sentence)
      .value({.key = "retune_every",
              .meaning = "interval of life at which it was tuned again, in the unit of ages",
              .shown = Shown::in_data,
              .optional = true},
             [](Of t) -> std::optional<double> {
               if (!t.answer.retuning) return std::nullopt;
               return t.answer.retuning->every;
             })
      .table({.key = "retuning",
              .heading = "values for each interval of life",
              .meaning = "values for each interval of life, with --retune-every"},
             interval_columns(), interval_rows)
      .table(
          in_data("retuned_ages",
                  "rates of each goal under each condition at the ages of each interval, on fresh machines "
                  "that are the same for both sets of values"),
          age_columns(), all_rows)
      .table({.heading = "what tuning again buys, of the goal and condition that the one set serves worst",
              .shown = Shown::to_people},
             age_columns(), worst_rows)
      .figures(retuning_figures);
}

}  // namespace zerocount::design_commands
