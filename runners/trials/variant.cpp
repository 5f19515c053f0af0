#include "runners/trials/variant.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_edit.hpp"

namespace zerocount::trials {

namespace {

/// Checks the value of a command-line option against what the study has.
/// @param all the study's conditions or ages
/// @param noun what `all` is, for the message
/// @throws Failure (bad_input) unless `wanted` is one of `all`
void require_one_of(const study::Study& study, const auto& all, const auto& wanted, std::string_view noun,
                    std::string_view option) {
  if (std::ranges::find(all, wanted) != all.end()) return;
  throw Failure(ExitCode::bad_input,
                all.empty() ? fmt::format("{}: it has no {}s; expected no {}", study.name, noun, option)
                            : fmt::format("option '{}': {} is not one of the {}s of {}; expected one of {}",
                                          option, wanted, noun, study.name, fmt::join(all, ", ")));
}

}  // namespace

std::uint64_t fresh_seed(std::uint64_t seed, std::string_view purpose) {
  constexpr unsigned seed_bits = 52;
  return random::random_bits({designs::random_key(seed, purpose), 0}, 0, random::Draw::trial) >>
         (64U - seed_bits);
}

study::Study variant_of(const study::Study& study, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = study.manifest.overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return manifest::parse_study(study.manifest.text, study.name, all, sections::external_inputs_of(study));
}

study::Study restricted_to(const study::Study& study, const std::optional<std::string>& condition,
                           const std::optional<double>& age) {
  std::vector<std::string> overrides;
  study::SettingCounts kept = study.settings.counts();
  if (condition) {
    require_one_of(study, study.settings.conditions, *condition, "condition", "--condition");
    overrides.push_back(manifest_text::only_condition(study, *condition));
    kept.conditions = 1;
  }
  if (age) {
    require_one_of(study, study.settings.ages.at, *age, "age", "--age");
    overrides.push_back(fmt::format("ages.at=[{}]", *age));
    kept.ages = 1;
  }
  if (overrides.empty()) return study;
  overrides.push_back(fmt::format("trials={}", study::draw_count(study) * kept.total()));
  if (!study.retained_trials.empty()) overrides.emplace_back("retain={trials: []}");
  study::Study restricted = variant_of(study, overrides);
  restricted.engine = study.engine;
  return restricted;
}

namespace {

study::PointEdit edited(const study::Study& study, std::span<const std::string> parameters,
                        std::span<const double> values) {
  study::PointEdit edit(study, 0);
  for (std::size_t i = 0; i < parameters.size(); ++i) edit.set(parameters[i], values[i]);
  return edit;
}

std::string refusal_of_edit(const study::Study& study, const study::PointEdit& edit) {
  std::string refusal = rules::refusal_of(edit);
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting) {
    const study::ParameterRange hold = edit.limits(parameter::command::hold, setting);
    for (const study::Goal& goal : study.goals) {
      for (const auto& fault : rules::longer_than_the_move(goal.within.time, hold))
        if (refusal.empty()) refusal = fmt::format("goal: {}; expected {}", fault.what, fault.expected);
    }
  }
  return refusal;
}

}  // namespace

std::string refusal_of_values(const study::Study& study, std::span<const std::string> parameters,
                              std::span<const double> values) {
  return refusal_of_edit(study, edited(study, parameters, values));
}

std::optional<study::Study> with_values(const study::Study& study, std::span<const std::string> parameters,
                                        std::span<const double> values) {
  const study::PointEdit edit = edited(study, parameters, values);
  if (!refusal_of_edit(study, edit).empty()) return std::nullopt;
  return edit.study();
}

Replicates replicates_of(const study::Study& study, std::int64_t point) {
  if (study.machines == 0) return {study::draw_count(study), study.settings.total(), point};
  return {study.machines, study.trials / study.machines, point};
}

std::int64_t trial_of_replicate(const study::Study& study, const Replicates& replicates,
                                std::int64_t replicate, std::int64_t i) {
  const study::TrialIndices indices = study::trial_indices(study);
  const std::int64_t settings = indices.settings.total();
  return indices.trial_of(replicate + replicates.count * (i / settings), i % settings);
}

std::int64_t in_equal_worlds(const study::Study& study, std::int64_t count) {
  if (study.worlds == 0) return count;
  return (count + study.worlds - 1) / study.worlds * study.worlds;
}

std::vector<std::string> overrides_for(const study::Study& study, const Replicates& replicates) {
  std::vector<std::string> overrides{fmt::format("trials={}", replicates.trials()), "design=monte_carlo"};
  if (study.machines > 0) overrides.push_back(fmt::format("machines={}", replicates.count));
  if (!study.retained_trials.empty()) overrides.emplace_back("retain={trials: []}");
  return overrides;
}

}  // namespace zerocount::trials
