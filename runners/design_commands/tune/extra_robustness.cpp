#include <fmt/format.h>

#include "runners/design_commands/tune/extras.hpp"
#include "runners/design_commands/tune/tune_parts.hpp"
#include "runners/tuning/effects/robustness.hpp"

namespace zerocount::design_commands {
namespace {

using tuning::Variation;

constexpr std::int64_t points_of_robustness = 14;

tuning::ExtraCost cost_of_robustness(const tuning::TunedAxis& axis) {
  return {.applies = axis.answer.is_met(),
          .points = points_of_robustness,
          .trials = points_of_robustness * axis.units().trials()};
}

std::any find_robustness(tuning::TunedAxis& axis) {
  const study::Study tuned = axis.on_units();
  return tuning::variations_of(
      tuning::EffectRuns(tuned, axis.units(), axis.effort), axis.units(),
      [&](std::uint64_t seed) { return axis.on_units({fmt::format("seed={}", seed)}); }, axis.effort);
}

void describe_robustness(Items& items) {
  using document::everywhere;
  using Row = const Variation&;
  items.table(
      everywhere("robustness", "at the tuned values, with other premises",
                 "rates at the tuned values with other seeds, spreads and delays"),
      document::Description<Variation>()
          .value(everywhere("premise", "premise", "what differs from the study"),
                 [](Row one) { return one.limit.effect; })
          .value(everywhere("holds", "holds", "whether every goal is met under every condition"),
                 [](Row one) { return one.limit.rate ? std::optional(one.holds) : std::nullopt; })
          .value({.key = "rate",
                  .heading = "rate",
                  .meaning =
                      "proportion of moves, or of machines, that meet the worst goal; of seeds the lowest",
                  .unit = "1",
                  .notation = document::Notation::percent},
                 [](Row one) { return one.limit.rate; })
          .value(
              {.key = "note",
               .heading = "note",
               .meaning = "what stayed, or why there is no rate",
               .optional = true},
              [](Row one) { return one.limit.note.empty() ? std::nullopt : std::optional(one.limit.note); }),
      found_by_extra<std::vector<Variation>>);
}

}  // namespace

tuning::Extra robustness_extra() {
  return {.name = "robustness",
          .question = "Does it hold under other premises?",
          .cost = cost_of_robustness,
          .run = find_robustness,
          .describe = describe_robustness};
}

}  // namespace zerocount::design_commands
