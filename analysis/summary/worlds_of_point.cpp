#include "analysis/summary/worlds_of_point.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/percent.hpp"

namespace zerocount::summary {
namespace {

/// ", or where creep_rate > 2e-05 rad/s, which are the same worlds".
std::string same_text(const worlds::WorldRule& rule, const std::vector<worlds::WorldInput>& inputs) {
  std::vector<std::string> conditions;
  for (const worlds::Condition& one : rule.same) conditions.push_back(worlds::text_of(one, inputs));
  if (conditions.empty()) return "";
  return fmt::format(", or where {}, which are the same worlds", fmt::join(conditions, ", or "));
}

/// "; creep_rate: speed at which …" of each derived quantity in the rule.
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
  if (!one.worlds) return std::nullopt;
  for (const measures::MoveCounts& world : measures::in_worlds(one.worlds->succeeded)) {
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
  const std::string_view what = goal::words_of(question).falls_short;
  if (bad == 0 || bad == all) return fmt::format("{} of {} worlds {}", bad == 0 ? "none" : "all", all, what);
  if (!point.rule) {
    return fmt::format(
        "{} of {} worlds {}, and no rule on one or two parameters tells them from the others (at a "
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

}  // namespace zerocount::summary
