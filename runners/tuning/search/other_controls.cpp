#include "runners/tuning/search/other_controls.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/loop/controller/controller.hpp"

namespace zerocount::tuning {
namespace {

constexpr const char* observer_bandwidth = "controller.observer.bandwidth";

OtherControl with_zeros(const study::Study& study, const std::vector<std::size_t>& zeros) {
  OtherControl control;
  for (std::size_t i = 0; i < study.tuning->free.size(); ++i) {
    const study::FreeParameter& one = study.tuning->free[i];
    if (std::ranges::find(zeros, i) == zeros.end()) {
      control.free.push_back(one);
      continue;
    }
    control.name += fmt::format("{}{} = 0", control.name.empty() ? "" : ", ", one.name);
    control.zero.push_back(one.name);
    control.overrides.push_back(one.name + "=0");
  }
  return control;
}

/// The bandwidth is sought up to 1/4 of the sample rate, from one at which the observer has nearly no effect:
/// at 1/1000 of a cycle in a trial it has removed 0.6 % of a constant disturbance by the end. The
/// model of the observer has the inertia of the plant. Nothing for a study with an observer, a cascade, two
/// phases or a plugin.
std::optional<OtherControl> with_observer(const study::Study& study) {
  const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
  const bool is_plain = p.controller.blocks.structure == loop::ControlStructure::pid &&
                        p.controller.blocks.observer.bandwidth == 0.0 && !p.controller.user.plugin &&
                        !loop::has_coarse_phase(p.controller);
  const auto is_of_observer = [](const study::FreeParameter& one) {
    return one.name.starts_with("controller.observer.");
  };
  if (!is_plain || std::ranges::any_of(study.tuning->free, is_of_observer)) return std::nullopt;
  const double rate = p.controller.sample_rate;
  const double lowest = 0.001 / (p.command.hold * static_cast<double>(study.moves));
  OtherControl control{"observer added", {}, {}, study.tuning->free};
  control.free.push_back(
      {.name = observer_bandwidth, .unit = "Hz", .low = lowest, .high = 0.25 * rate, .logarithmic = true});
  control.overrides.push_back(fmt::format("{}={}", observer_bandwidth, lowest));
  control.overrides.push_back(fmt::format("controller.observer.inertia={}", p.plant.inertia));
  return control;
}

}  // namespace

std::vector<std::vector<std::size_t>> zero_sets(std::span<const study::FreeParameter> free) {
  std::vector<std::size_t> all;
  std::vector<std::vector<std::size_t>> sets;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i].low != 0.0 || !(free[i].name.ends_with(".kp") || free[i].name.ends_with(".kd"))) continue;
    all.push_back(i);
    sets.push_back({i});
  }
  if (all.size() > 1) sets.push_back(all);
  std::erase_if(sets, [&](const std::vector<std::size_t>& one) { return one.size() == free.size(); });
  return sets;
}

std::vector<OtherControl> other_controls(const study::Study& study) {
  std::vector<OtherControl> controls;
  for (const std::vector<std::size_t>& zeros : zero_sets(study.tuning->free))
    controls.push_back(with_zeros(study, zeros));
  if (std::optional<OtherControl> observer = with_observer(study)) controls.push_back(std::move(*observer));
  std::ranges::stable_sort(controls, {}, [](const OtherControl& one) { return one.free.size(); });
  return controls;
}

std::vector<Values> starts_from(std::span<const TunedValues> tuned,
                                std::span<const study::FreeParameter> free) {
  std::vector<Values> starts;
  for (const TunedValues& one : tuned) {
    Values values;
    for (const study::FreeParameter& parameter : free) {
      const auto found = one.find(parameter.name);
      values.push_back(found == one.end() ? parameter.low : found->second);
    }
    starts.push_back(std::move(values));
  }
  return starts;
}

}  // namespace zerocount::tuning
