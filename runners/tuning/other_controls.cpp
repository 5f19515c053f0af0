#include "runners/tuning/other_controls.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/loop/controller.hpp"

namespace zerocount::tuning {
namespace {

constexpr const char* observer_bandwidth = "controller.observer.bandwidth";

OtherControl with_zeros(const study::Study& study, const std::vector<std::string>& names) {
  OtherControl control{names, {}, {}};
  for (const std::string& name : names) control.overrides.push_back(name + "=0");
  std::ranges::copy_if(
      study.tuning->free, std::back_inserter(control.free),
      [&](const study::FreeParameter& one) { return std::ranges::find(names, one.name) == names.end(); });
  return control;
}

/// The bandwidth is sought from 1/400 to 1/4 of the sample rate; the model of the observer has the inertia of
/// the plant. Nothing for a study with an observer, a cascade, two phases or a plugin.
std::optional<OtherControl> with_observer(const study::Study& study) {
  const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
  const bool is_plain = p.controller.blocks.structure == loop::ControlStructure::pid &&
                        p.controller.blocks.observer.bandwidth == 0.0 && !p.controller.user.plugin &&
                        !loop::has_coarse_phase(p.controller);
  const auto is_of_observer = [](const study::FreeParameter& one) {
    return one.name.starts_with("controller.observer.");
  };
  if (!is_plain || std::ranges::any_of(study.tuning->free, is_of_observer)) return std::nullopt;
  constexpr double lowest = 1.0 / 400.0;
  constexpr double highest = 1.0 / 4.0;
  const double rate = p.controller.sample_rate;
  OtherControl control{{}, {}, study.tuning->free};
  control.free.push_back({.name = observer_bandwidth,
                          .unit = "Hz",
                          .low = lowest * rate,
                          .high = highest * rate,
                          .logarithmic = true});
  control.overrides.push_back(fmt::format("{}={}", observer_bandwidth, 0.1 * lowest * rate));
  control.overrides.push_back(fmt::format("controller.observer.inertia={}", p.plant.inertia));
  return control;
}

}  // namespace

std::vector<OtherControl> other_controls(const study::Study& study) {
  std::vector<OtherControl> controls;
  std::vector<std::string> zeros;
  for (const study::FreeParameter& one : study.tuning->free) {
    if (one.low == 0.0 && (one.name.ends_with(".kp") || one.name.ends_with(".kd"))) zeros.push_back(one.name);
  }
  const auto add = [&](const std::vector<std::string>& names) {
    if (names.size() < study.tuning->free.size()) controls.push_back(with_zeros(study, names));
  };
  for (const std::string& one : zeros) add({one});
  if (zeros.size() > 1) add(zeros);
  if (std::optional<OtherControl> observer = with_observer(study)) controls.push_back(std::move(*observer));
  return controls;
}

}  // namespace zerocount::tuning
