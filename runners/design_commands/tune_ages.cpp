#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "runners/design_commands/tune_figures.hpp"
#include "runners/design_commands/tune_parts.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::in_data;
using document::Shown;
using tuning::LostAges;
using tuning::LostClaim;

struct LostRow {
  const LostClaim& claim;
  const study::Study& study;
};

std::vector<LostRow> lost_rows(Of tuning) {
  std::vector<LostRow> rows;
  if (!tuning.answer.lost_ages) return rows;
  for (const LostClaim& one : tuning.answer.lost_ages->claims) rows.push_back({one, tuning.study});
  return rows;
}

std::optional<std::string> goal_of(const LostRow& row) {
  if (row.study.goals.size() < 2) return std::nullopt;
  return row.study.goals[row.claim.claim.goal].name;
}

std::optional<std::string> condition_of(const LostRow& row) {
  if (row.study.condition_names.empty()) return std::nullopt;
  return row.study.condition_names[row.claim.claim.condition];
}

/// The key, meaning and heading of an age.
document::Item age_item(const char* key, const char* heading, const char* meaning) {
  return {.key = key, .heading = heading, .meaning = meaning};
}

Description<LostRow> lost_columns() {
  using Row = const LostRow&;
  return Description<LostRow>()
      .value({.key = "goal", .heading = "goal", .meaning = "name of the goal, of several", .optional = true},
             goal_of)
      .value({.key = "condition",
              .heading = "condition",
              .meaning = "name of the condition, with conditions",
              .optional = true},
             condition_of)
      .value(
          age_item("lost", "seems lost from",
                   "youngest age that was tried at which less than asked for meets the goal, to 10 %; null: "
                   "none; in the unit of ages"),
          [](Row row) { return row.claim.lost; })
      .value(age_item("met_until", "shown to be met up to",
                      "age up to and including which the goal is shown to be met, at its confidence; null: "
                      "not at the first"),
             [](Row row) { return row.claim.met_until; })
      .value(age_item("missed_from", "shown to be missed from",
                      "age from which on the goal is shown to be missed, at its confidence; null: none"),
             [](Row row) { return row.claim.missed_from; })
      .value({.heading = "unit", .shown = Shown::to_people}, [](Row row) { return row.study.ages.unit; });
}

/// The claim that is lost first.
const LostClaim* first_lost(const LostAges& life) {
  const LostClaim* first = nullptr;
  for (const LostClaim& one : life.claims) {
    if (one.lost && (first == nullptr || *one.lost < *first->lost)) first = &one;
  }
  return first;
}

std::string lost_sentence(Of tuning) {
  if (!tuning.answer.lost_ages) return "";
  const LostAges& life = *tuning.answer.lost_ages;
  const study::Ages& ages = tuning.study.ages;
  const LostClaim* const first = first_lost(life);
  if (first == nullptr)
    return fmt::format("the tuned values seem to hold at every age that was tried, up to {}",
                       study::age_text(ages, life.tried.back().age));
  const std::string goal = "the goal" + tuning::text_of(tuning.study, first->claim);
  if (*first->lost == ages.at.front()) return goal + " seems missed from the first age on";
  return fmt::format("{}{} seems lost from an age of {} on", life.claims.size() > 1 ? "first " : "", goal,
                     study::age_text(ages, *first->lost));
}

std::string tried_sentence(Of tuning) {
  if (!tuning.answer.lost_ages) return "";
  const LostAges& life = *tuning.answer.lost_ages;
  const study::Ages& ages = tuning.study.ages;
  std::string text = fmt::format(
      "simulated: {} machines at each of {} ages up to {}, the same at all, which the search "
      "did not use",
      life.units, life.tried.size(), study::age_text(ages, life.tried.back().age));
  if (life.tried.back().age > ages.at.back())
    text +=
        fmt::format("; beyond {} the laws of aging are extrapolated", study::age_text(ages, ages.at.back()));
  if (!life.refusal.empty()) text += "\nno older machines are simulated: " + life.refusal;
  return text;
}

}  // namespace

void add_lost_ages(Description<Tuning>& items) {
  items.sentence(lost_sentence)
      .table({.key = "lost_ages",
              .heading = "how long the tuned values hold",
              .meaning = "age at which each goal is lost under each condition, of a study with ages"},
             lost_columns(), lost_rows)
      .value({.key = "ages_tried_to",
              .meaning = "oldest age that was tried, of a study with ages, in the unit of ages",
              .shown = Shown::in_data,
              .optional = true},
             [](Of t) -> std::optional<double> {
               if (!t.answer.lost_ages) return {};
               return t.answer.lost_ages->tried.back().age;
             })
      .sentence(tried_sentence)
      .figures(lost_ages_figures);
}

}  // namespace zerocount::design_commands
