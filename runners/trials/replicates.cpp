#include <fmt/format.h>

#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_edit.hpp"
#include "runners/trials/variant.hpp"

namespace zerocount::trials {
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
