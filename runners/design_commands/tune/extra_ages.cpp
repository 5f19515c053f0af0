#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/report/figures/figure.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/tuning/ages/lost_ages.hpp"
#include "runners/tuning/search/proof_runner.hpp"

namespace zerocount::design_commands {
namespace {

using document::Visibility;
using tuning::LostAges;
using tuning::LostClaim;

/// Machines on which each age is simulated. They are as many as take the trials of the planned machines, and
/// enough to show that the goals are met if no move misses them.
trials::Replicates machines_of_ages(const tuning::TunedAxis& axis) {
  const std::int64_t each = tuning::trials_of_machine(axis.study);
  const std::int64_t least = tuning::min_proof_trials(axis.study, 1) / each;
  return {trials::in_equal_worlds(axis.study, std::max(axis.trials_of_point() / each, least)),
          tuning::trials_at_one_age(axis.study, each)};
}

tuning::ExtraCost cost_of_ages(const tuning::TunedAxis& axis) {
  const std::int64_t ages = std::ssize(axis.study.settings.ages.at);
  const std::int64_t runs = tuning::points_of_lost_ages(axis.study);
  // A point has all ages.
  return {.points = (runs + ages - 1) / ages, .trials = runs * machines_of_ages(axis).trials()};
}

std::any find_lost_ages(tuning::TunedAxis& axis) {
  const study::Study tuned = trials::variant_of(axis.study, tuning::overrides_of(axis.free(), axis.values));
  return tuning::lost_ages(tuned, machines_of_ages(axis), axis.effort);
}

struct LostRow {
  const LostClaim& claim;
  const study::Study& study;
};

std::vector<LostRow> lost_rows(const Tuning& tuning) {
  std::vector<LostRow> rows;
  if (const auto* const life = tuning.answer.extra<LostAges>()) {
    for (const LostClaim& one : life->claims) rows.push_back({one, tuning.study});
  }
  return rows;
}

document::Description<LostRow> lost_columns() {
  return document::Description<LostRow>()
      .include(named_claim_columns("goal", "condition"),
               [](const LostRow& row) {
                 const std::vector<study::Goal>& goals = row.study.goals;
                 const study::Settings settings = study::without_ages(row.study.settings);
                 tuning::ClaimNames names;
                 if (goals.size() > 1) names.goal = goals[row.claim.claim.goal].name;
                 if (!settings.empty())
                   names.setting =
                       study::label_of(settings, static_cast<std::int64_t>(row.claim.claim.setting));
                 return names;
               })
      .value(
          document::everywhere(
              "lost", "seems lost from",
              "youngest age that was tried at which less than asked for meets the goal, to 10 %; null: none; in the unit of ages"),
          [](const LostRow& row) { return row.claim.lost; })
      .value(
          document::everywhere(
              "met_until", "shown to be met up to",
              "age up to and including which the goal is shown to be met, at its confidence; null: not at the first"),
          [](const LostRow& row) { return row.claim.met_until; })
      .value(document::everywhere(
                 "missed_from", "shown to be missed from",
                 "age from which on the goal is shown to be missed, at its confidence; null: none"),
             [](const LostRow& row) { return row.claim.missed_from; })
      .value(document::to_people("unit"), [](const LostRow& row) { return row.study.settings.ages.unit; });
}

std::string tried_ages_sentence(const Tuning& tuning) {
  const auto* const life = tuning.answer.extra<LostAges>();
  if (life == nullptr) return "";
  const study::Ages& ages = tuning.study.settings.ages;
  return fmt::format(
      "simulated: {} machines, which the search did not use, at each of {} ages up to {}; the laws of aging "
      "are extrapolated beyond {}{}",
      life->machines, life->tried.size(), study::age_text(ages, life->tried.back().age),
      study::age_text(ages, ages.at.back()),
      life->refusal.empty() ? "" : "\nno older machines are simulated: " + life->refusal);
}

std::vector<document::Figure> lost_ages_figures(const Tuning& tuning) {
  const auto* const life = tuning.answer.extra<LostAges>();
  if (!is_drawn(tuning) || life == nullptr) return {};
  const study::Study& study = tuning.study;
  document::FigureData data{"ages",
                            {{"series", "of", ""},
                             {"age", "age", study.settings.ages.unit},
                             {"rate", "proportion", "1"},
                             {"low", "lower bound", "1"},
                             {"high", "upper bound", "1"},
                             {"asked", "asked", "1"}}};
  using report::datum;
  for (std::size_t i = 0; i < life->claims.size(); ++i) {
    const tuning::ClaimPlace& claim = life->claims[i].claim;
    const study::Goal& goal = study.goals[claim.goal];
    const std::string name =
        (goal.machines ? "machines in the goal" : "moves in the goal") + tuning::text_of(study, claim);
    for (const tuning::AgeVerdict& at : life->tried) {
      const goal::BoundedProportion& rate = goal::judged_rate(goal, at.claims[i]);
      data.rows.push_back({name, datum(at.age), datum(rate.value), datum(rate.low), datum(rate.high),
                           datum(study::demanded_proportion(goal))});
    }
  }
  document::Figure figure = report::figure_of(
      "ages", "tuning-ages", "How long do the tuned values hold?",
      fmt::format("Proportions at each age that was tried, by {} machines that the search did not use, with "
                  "one-sided bounds at the goal's confidence. Dashed: what is asked. Beyond {}, the last age "
                  "of the study, the laws of aging are extrapolated.",
                  life->machines, study::age_text(study.settings.ages, study.settings.ages.at.back())),
      {std::move(data)});
  std::vector<double> ages;
  for (const tuning::AgeVerdict& at : life->tried) ages.push_back(at.age);
  report::scale_ages(figure, ages);
  return {std::move(figure)};
}

void describe_lost_ages(Items& items) {
  items
      .table({.key = "lost_ages",
              .heading = "how long the tuned values hold",
              .meaning = "age at which each goal is lost under each condition, of a study with ages"},
             lost_columns(), lost_rows)
      .value(optional(document::in_data(
                 "ages_tried_to", "oldest age that was tried, of a study with ages, in the unit of ages")),
             [](const Tuning& t) -> std::optional<double> {
               const auto* const life = t.answer.extra<LostAges>();
               return life == nullptr ? std::nullopt : std::optional(life->tried.back().age);
             })
      .sentence(tried_ages_sentence)
      .figures(lost_ages_figures);
}

}  // namespace

tuning::Extra ages_extra() {
  return {.name = "ages",
          .question = "How long does it hold?",
          .refusal = [](const study::Study& study, bool) -> std::string {
            return study.settings.ages.at.empty() ? "the study has no ages; expected other extras" : "";
          },
          .cost = cost_of_ages,
          .run = find_lost_ages,
          .describe = describe_lost_ages};
}

}  // namespace zerocount::design_commands
