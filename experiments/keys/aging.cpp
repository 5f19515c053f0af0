#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/keys/values.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::keys {
namespace {

constexpr std::string_view expected_aging =
    "{exponential: -0.1, scale: 1.0e+6}: a law, linear, exponential or logarithmic, with its rate, and the scale of ages";

/// Phrase that says why a value of the parameter must not have a law of aging; empty if it may.
std::string_view obstacle(const parameters::Parameter& parameter, const study::Value& value,
                          const StudyDraft& draft) {
  if (!draft.groups.ages) return "the study has no ages";
  if (parameter.name.ends_with(study::suffix_of_rate)) return "the rate itself does not change with age";
  if (parameter.kind != parameters::ParameterKind::real) return "whole numbers do not change with age";
  if (value.kind == study::Value::Kind::number && value.number == parameter.none)
    return "a limit that is off does not change with age";
  return {};
}

std::string_view expected_instead(const StudyDraft& draft) {
  return !draft.groups.ages ? "the key ages: {at: [0, 1.0e+5, 1.0e+6], unit: cycles}" : "the value alone";
}

/// Reads the rate at which a value changes with age. By default the rate is drawn for each machine. A rate
/// drawn per trial or per contact is reported as an error.
study::Value read_rate(const yaml::Field& field, std::size_t slot, StudyDraft& draft) {
  study::Value rate = read_value(field, slot, draft);
  if (rate.kind != study::Value::Kind::distribution) return rate;
  if (!draft.groups.machines) return rate;  // which is reported
  if (rate.level == study::DrawLevel::trial || rate.level == study::DrawLevel::contact)
    draft.problems.add(field, "a rate of aging belongs to a machine", "per: machine, world or study");
  return rate;
}

}  // namespace

void read_aging(const yaml::Field& field, std::size_t slot, study::Value& value, StudyDraft& draft) {
  const std::string_view why = obstacle(draft.plan.table.rows[slot], value, draft);
  if (!why.empty()) {
    draft.problems.add(field, why, expected_instead(draft));
    return;
  }
  if (!yaml::check_map(field, fmt::format("{}; {{linear: 0, scale: 1}} switches it off", expected_aging),
                       draft.problems))
    return;
  std::vector<std::string> known(study::aging_law_labels.begin(), study::aging_law_labels.end());
  known.emplace_back("scale");
  parameters::check_keys(field, known, draft.problems);
  study::Aging aging;
  std::optional<yaml::Field> rate;
  std::size_t laws = 0;
  for (std::size_t law = 0; law < study::aging_law_labels.size(); ++law) {
    const auto given = yaml::find_field(field, study::aging_law_labels[law]);
    if (!given) continue;
    ++laws;
    rate = given;
    aging.law = static_cast<study::AgingLaw>(law);
  }
  const auto scale = yaml::find_field(field, "scale");
  if (laws != 1 || !scale) {
    draft.problems.add(field, laws != 1 ? fmt::format("found {} laws", laws) : "the scale is missing",
                       expected_aging);
    return;
  }
  aging.scale = yaml::read_real(*scale, numerics::above(0), draft.problems).value_or(1.0);
  const std::size_t slot_of_rate = study::rate_row(draft.plan.table, slot);
  draft.plan.base.resize(draft.plan.table.rows.size(), {.kind = study::Value::Kind::number});
  aging.rate = static_cast<std::uint32_t>(slot_of_rate);
  value.aging = static_cast<std::uint32_t>(draft.plan.agings.size());
  draft.plan.agings.push_back(aging);
  draft.rate = {aging.rate, read_rate(*rate, slot_of_rate, draft)};
}

}  // namespace zerocount::keys
