#include "experiments/manifest/manifest_keys.hpp"

#include <algorithm>
#include <array>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::manifest {
namespace {

bool is_below(std::string_view name, std::string_view path) {
  return path.empty() ||
         (name.size() > path.size() && name.substr(0, path.size()) == path && name[path.size()] == '.');
}

void add_once(std::vector<std::string>& names, std::string_view name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
}

// Dotted paths of all keys with a value.
std::vector<std::string_view> value_paths() {
  std::vector<std::string_view> paths;
  for (const GeneralKey& key : general_keys()) {
    if (key.name.find('.') == std::string_view::npos) paths.push_back(key.name);
  }
  for (const parameters::Parameter& parameter : parameters::parameter_table())
    paths.push_back(parameter.name);
  for (const GeneralKey& key : general_keys()) {
    if (key.name.find('.') != std::string_view::npos) paths.push_back(key.name);
  }
  return paths;
}

}  // namespace

std::span<const GeneralKey> general_keys() {
  static constexpr std::array<GeneralKey, 31> keys{{
      {"zerocount", "version of the manifest's format: 1", true},
      {"name", "name of the study", true},
      {"description", "what the study is for", false},
      {"axis",
       "rotary (default), or linear: m, N, kg, N/m ... in place of rad, N m, kg m^2, N m/rad (zerocount "
       "parameters --axis linear)",
       false},
      {"travel", "period of the friction profiles of a linear axis, m", false},
      {"seed", "seed of all random numbers, 0 to 2^64 - 1", true},
      {"trials", "trials at each design point", true},
      {"rigs",
       "number of rigs; trial i runs on rig i mod rigs, and `trials` must be a multiple of it (default: no "
       "trials share a rig)",
       false},
      {"worlds",
       "number of worlds, which differ in what all machines share and nobody knows (`per: world`); rig r "
       "lives in world r mod worlds, without rigs trial i in world i mod worlds (default: none)",
       false},
      {"design", "sampling design: monte_carlo (default), latin_hypercube, sobol or saltelli", false},
      {"independent_points",
       "true: every design point has its own random numbers; false (default): trial i has the same ones at "
       "all points",
       false},
      {"retain", "trials whose sample-by-sample records are kept: {trials: [0, 1]}", false},
      {"keep",
       "what the results file keeps besides the statistics: trials (default), failures (the trials that did "
       "not succeed) or statistics (no trials)",
       false},
      {"goal",
       "what the axis must achieve: {band: 1, within: 0.05, moves: 0.99, machines: 0.99, confidence: 0.95}: "
       "the error is within 1 count for good after 0.05 s in at least 99 % of the moves of at least 99 % of "
       "the machines, claimed with 95 % confidence; without `machines` (which needs rigs) in at least 99 % "
       "of all moves; default band 0, confidence 0.95",
       false},
      {"tune",
       "what zerocount tune may change and must keep: {free: {controller.ki: {log: [5.0e+3, 3.0e+5]}, "
       "controller.kp: [0, 1000]}, minimise: band_settling_time.p95, margins: {gain: 6, phase: 30, delay: "
       "0.5}}: ranges of parameters, the criterion, and margins of the loop (dB, degrees, samples), each off "
       "by the word",
       false},
      {"stop",
       "sequential stopping: blocks of `trials` trials are added until the bounds of every success rate are "
       "narrow enough: {success_rate_halfwidth: 0.005, confidence: 0.95, min_trials: 1000, max_trials: "
       "100000}",
       false},
      {"correlation",
       "correlations of drawn parameters: [[friction.k1, friction.k2, 0.6]], coefficients of the normal "
       "scores (Gaussian copula); each parameter keeps its distribution",
       false},
      {"samples",
       "joint draws of several parameters, such as those of zerocount identify --posterior: path of a CSV "
       "table from the folder of the manifest, or {file: FILE, per: rig}; its header has the dotted paths of "
       "the parameters, and each world, rig or trial takes one row",
       false},
      {"observed", "observations on the real rig, by case or point label: texts or counts", false},
      {"sweep", "design points: grid (product of lists), cases (named), or both (product)", false},
      {"controller.units",
       "unit of kp, ki and kd, also of the coarse phase: count (default), per count and sample; or si: N "
       "m/rad, N m/(rad s) and N m s/rad, which give the same control at any sample rate",
       false},
      {"controller.plugin",
       "shared library with a controller of your own (docs/your-own-controller.md); path from the folder of "
       "the manifest",
       false},
      {"controller.parameters", "parameters of the plugin, by name", false},
      {"controller.filters",
       "list of filters on the controller's torque, in the order in which they act: {lowpass: {frequency, "
       "damping}}, {notch: {frequency, damping, depth}}, {lead: {frequency, ratio}}, {biquad: {b: [b0, b1, "
       "b2], a: [a1, a2]}}; their values are the parameters controller.filters.0.frequency ...",
       false},
      {"controller.coarse.filters", "list of filters of the coarse phase, as controller.filters", false},
      {"disturbance.ripple",
       "list of torques that vary along the rotor: {amplitude, periods, phase}, amplitude*sin(periods*(theta "
       "+ initial.position) + phase), periods per revolution; on a linear axis {amplitude, pitch, phase}",
       false},
      {"disturbance.vibration",
       "list of torques that vary in time: {amplitude, frequency, phase}, amplitude*sin(2*pi*frequency*t + "
       "phase); or {spectrum: [[frequency, density], ...], lines: 100}, a random vibration with this "
       "one-sided power spectral density, (N m)^2/Hz, drawn anew in each trial",
       false},
      {"command.units",
       "unit of targets and overrun: counts (default) of the fine encoder; or si: rad (m on a linear axis), "
       "of "
       "which each trial takes the nearest count of its encoder",
       false},
      {"command.sequence.cycles", "number of cycles of a sequence (default 5)", false},
      {"command.sequence.approach",
       "direction from which a sequence approaches its targets: bidirectional (default: from both sides), "
       "positive (from below) or negative (from above)",
       false},
      {"verdict.bands",
       "bands of the error, counts, whose first entry and settling are measured: 1 to 8 increasing numbers "
       "(default [0, 1])",
       false},
  }};
  return keys;
}

const GeneralKey* find_general_key(std::string_view path) {
  const auto keys = general_keys();
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const GeneralKey& key) { return key.name == path; });
  return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> keys_below(std::string_view path) {
  const std::size_t start = path.empty() ? 0 : path.size() + 1;
  std::vector<std::string> keys;
  for (const std::string_view name : value_paths()) {
    if (is_below(name, path)) add_once(keys, name.substr(start, name.find('.', start) - start));
  }
  return keys;
}

bool is_within(std::string_view path, std::string_view section) {
  return path == section || (!section.empty() && is_below(path, section));
}

bool is_section(std::string_view path) {
  const auto paths = value_paths();
  return !path.empty() &&
         std::any_of(paths.begin(), paths.end(), [&](std::string_view name) { return is_below(name, path); });
}

}  // namespace zerocount::manifest
