#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include <fmt/format.h>

#include "core/motion/disturbance.hpp"
#include "core/trial/disturbance.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "runners/tuning/effects/idealisations.hpp"

// Disturbances. One that acts from the start on goes together with what holds it there: the integral, a
// contact that carries it, and a preload of its size.

namespace zerocount::tuning {
namespace {

using study::ParameterRange;
using trial::TrialParameters;

/// Reduces the torque that the controller's integral has at the start by what it needs to hold a disturbance.
/// @param torque range of the disturbance torque, N m; the end of the range that the integral opposes is
/// taken
void release_integral(const ParameterRange& torque, TrialParameters& p) {
  double& integral = p.initial.integral;
  integral = integral > 0.0 ? std::max(0.0, integral - std::max(0.0, -torque.low))
                            : std::min(0.0, integral + std::max(0.0, torque.high));
}

/// Change that removes a constant load torque from a trial. The initial integral of the controller gives up
/// as much as the largest load of the study, so that one integral for all loads is removed too.
Change without_constant_disturbance(const ParameterRange& load) {
  return [load](TrialParameters& p) {
    release_integral(load, p);
    constexpr double rounding = 1e-9;
    const double torque = std::abs(p.disturbance.torque);
    if (torque > 0.0 && std::abs(std::abs(p.initial.preload) - torque) <= rounding * torque)
      p.initial.preload = 0.0;
    // Torques on a second mass stay, and must be held at the start as before.
    if (!motion::has_load(p.plant)) p.initial.holding = false;
    p.disturbance.torque = 0.0;
  };
}

Change without_constant_load_disturbance(const ParameterRange& load) {
  return [load](TrialParameters& p) {
    release_integral(load, p);
    p.load_side.disturbance.torque = 0.0;
  };
}

auto& ripples_on(bool load, auto& p) {
  return load ? p.load_side.disturbance.ripple : p.disturbance.ripple;
}

/// Removes one torque ripple from a trial, and from the controller's initial integral the torque that holds
/// the ripple at the start. Gravity, for example, may be a ripple of one period.
/// @param on_load whether the ripple acts on the second mass
/// @param number index of the ripple in the list of this mass
void without_ripple(bool on_load, std::size_t number, TrialParameters& p) {
  trial::RippleParameters& ripple = ripples_on(on_load, p)[number];
  const double torque = motion::value(trial::ripples_of({ripple}, p.initial.position), 0.0);
  release_integral({.low = torque, .high = torque}, p);
  ripple.amplitude = 0.0;
}

void add_ripples(const IdealisedPoint& point, std::vector<Effect>& all) {
  for (const bool on_load : {false, true}) {
    const std::string list = on_load ? "disturbance.load.ripple" : "disturbance.ripple";
    const std::size_t count = ripples_on(on_load, point.at.plan().common).size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::string path = fmt::format("{}.{}", list, i);
      const std::string amplitude = path + ".amplitude";
      if (!acts(point, amplitude) || !can_differ_from(0.0, point.at.limits(amplitude))) continue;
      all.push_back({.name = fmt::format("{} {}", parameters::no_ripple, path),
                     .change = [on_load, i](TrialParameters& p) { without_ripple(on_load, i, p); }});
    }
  }
}

/// Effect without one spectrum of the torque disturbance. A spectrum is not a parameter, so it stays in the
/// list without torque, and the other spectra keep their random numbers.
Effect without_spectrum(const std::shared_ptr<const trial::SpectrumParameters>& spectrum,
                        std::size_t number) {
  auto quiet = std::make_shared<trial::SpectrumParameters>(*spectrum);
  for (trial::SpectrumPoint& point : quiet->density) point.density = 0.0;
  return {.name = fmt::format("no vibration of spectrum {}", number),
          .change = [spectrum, silent = std::shared_ptr<const trial::SpectrumParameters>(std::move(quiet))](
                        trial::TrialParameters& p) {
            std::ranges::replace(p.disturbance.spectra, spectrum, silent);
            std::ranges::replace(p.load_side.disturbance.spectra, spectrum, silent);
          }};
}

void add_spectra(const IdealisedPoint& point, std::vector<Effect>& all) {
  auto spectra = point.at.plan().common.disturbance.spectra;
  const auto& of_load = point.at.plan().common.load_side.disturbance.spectra;
  spectra.insert(spectra.end(), of_load.begin(), of_load.end());
  for (std::size_t i = 0; i < spectra.size(); ++i) all.push_back(without_spectrum(spectra[i], i));
}

/// Change that removes all disturbances, and the torques that hold them at the start.
/// @param one_by_one changes that each remove one disturbance
Change without_disturbances(std::vector<Change> one_by_one) {
  return [changes = std::move(one_by_one)](TrialParameters& p) {
    for (const Change& change : changes) change(p);
    p.initial.holding = false;
    p.disturbance = {};
    p.load_side.disturbance = {};
  };
}

}  // namespace

void add_disturbances(const IdealisedPoint& point, std::vector<Effect>& all) {
  const auto is_of_disturbance = [](const Effect& effect) {
    return effect.name.find(" disturbance.") != std::string::npos;
  };
  const auto parameters_before = std::ranges::count_if(all, is_of_disturbance);
  const std::size_t first = all.size();
  const ParameterRange torque = point.at.limits(parameter::disturbance::torque);
  const ParameterRange load_torque = point.at.limits(parameter::disturbance::load::torque);
  if (can_differ_from(0.0, torque))
    all.push_back({.name = std::string(parameters::no_constant_disturbance),
                   .change = without_constant_disturbance(torque)});
  if (acts(point, parameter::disturbance::load::torque) && can_differ_from(0.0, load_torque))
    all.push_back({.name = std::string(parameters::no_constant_load_disturbance),
                   .change = without_constant_load_disturbance(load_torque)});
  add_ripples(point, all);
  std::vector<Change> changes;
  for (std::size_t i = first; i < all.size(); ++i) changes.push_back(all[i].change);
  add_spectra(point, all);
  if (parameters_before + std::ssize(all) - static_cast<std::ptrdiff_t>(first) > 1)
    all.push_back({.name = "no disturbance", .change = without_disturbances(std::move(changes))});
}

}  // namespace zerocount::tuning
