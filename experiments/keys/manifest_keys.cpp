#include "experiments/keys/manifest_keys.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "experiments/keys/values.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::keys {
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

// Builders of rows, with the member of the study in which the value is stored.

using Form = GeneralKey::Form;

constexpr numerics::Interval open_unit{.low = 0.0, .high = 1.0};

// Numbers of worlds: a goal is judged in each, with a part of the error probability.
constexpr std::int64_t max_worlds = 10'000;
// The rig is a 32-bit counter word of a rotor's random numbers.
constexpr std::int64_t max_rigs = std::int64_t{1} << 32;
// Range of a relative spread.
constexpr numerics::Interval spread{.low = 0.0, .high = 1.0, .low_included = true};
constexpr numerics::Interval margin{.low = 0.0, .high = 1e6, .low_included = true, .high_included = true};

// The part of the study that has the members of rows.
template <class Part>
Part& part_of(Reading& reading) {
  if constexpr (std::is_same_v<Part, study::Study>) return reading.study;
  if constexpr (std::is_same_v<Part, study::Goal>) return reading.study.goals.back();
  if constexpr (std::is_same_v<Part, study::StoppingRule>) return reading.study.stop.value();
  if constexpr (std::is_same_v<Part, study::Tuning>) return reading.study.tuning.value();
  if constexpr (std::is_same_v<Part, study::LoopMargins>) return reading.study.tuning.value().margins;
  if constexpr (std::is_same_v<Part, study::LoopSpread>) return reading.study.tuning.value().margins.spread;
  if constexpr (std::is_same_v<Part, study::SequenceCycle>) return reading.plan.sequence.value();
  if constexpr (std::is_same_v<Part, parameters::StudyUnits>) return reading.plan.units;
}

template <class Part, class Value>
GeneralKey stored(GeneralKey key, Form form, Value Part::*member) {
  key.form = form;
  key.get = [member](Reading& reading) -> std::optional<double> {
    const Value& value = part_of<Part>(reading).*member;
    if constexpr (std::is_same_v<Value, std::optional<double>>) {
      return value;
    } else {
      return static_cast<double>(value);
    }
  };
  key.set = [member](Reading& reading, std::optional<double> number) {
    Value& value = part_of<Part>(reading).*member;
    if constexpr (std::is_same_v<Value, std::optional<double>>) {
      value = number;
    } else if constexpr (std::is_same_v<Value, double>) {
      value = number.value();
    } else {
      value = static_cast<Value>(static_cast<std::int64_t>(number.value()));
    }
  };
  return key;
}

template <class Part>
GeneralKey whole(GeneralKey key, std::int64_t low, std::int64_t high, std::int64_t Part::*member) {
  key.range = numerics::closed(static_cast<double>(low), static_cast<double>(high));
  return stored(std::move(key), Form::whole_number, member);
}

template <class Part, class Value>
GeneralKey real(GeneralKey key, const numerics::Interval& range, Value Part::*member) {
  key.range = range;
  return stored(std::move(key), Form::real, member);
}

template <class Part, class Value>
GeneralKey label(GeneralKey key, std::span<const std::string_view> labels, Value Part::*member) {
  key.labels = labels;
  return stored(std::move(key), Form::label, member);
}

template <class Part>
GeneralKey text(GeneralKey key, std::string Part::*member) {
  key.form = Form::text;
  key.text = [member](Reading& reading) -> std::string& { return part_of<Part>(reading).*member; };
  return key;
}

GeneralKey map(GeneralKey key, std::string_view example, std::vector<GeneralKey> keys) {
  key.form = Form::map;
  key.example = example;
  key.keys = std::move(keys);
  return key;
}

}  // namespace

std::span<const GeneralKey> general_keys() {
  static const std::vector<GeneralKey> keys{
      {"zerocount", "version of the manifest's format: 1", "zerocount: 1"},
      {"name", "name of the study", "a name for the study"},
      text({"description", "what the study is for"}, &study::Study::description),
      label(
          {"axis",
           "rotary (default), or linear: m, N, kg, N/m ... in place of rad, N m, kg m^2, N m/rad (zerocount "
           "parameters --axis linear)"},
          parameters::axis_labels, &parameters::StudyUnits::axis),
      {.name = "travel",
       .meaning = "period of the friction profiles of a linear axis, m",
       .form = Form::real,
       .range = numerics::above(0)},
      {"seed", "seed of all random numbers, 0 to 2^64 - 1", "a whole number"},
      whole({"trials", "trials at each design point", "the number of trials at each design point"}, 1,
            max_study_trials, &study::Study::trials),
      whole({"rigs",
             "number of machines; trial i runs on machine i mod rigs, and `trials` must be a multiple of it "
             "(default: no trials share a machine)"},
            2, max_rigs, &study::Study::rigs),
      whole({"worlds",
             "number of worlds, which differ in what all machines share and nobody knows (`per: world`); "
             "machine r lives in world r mod worlds, without `rigs` trial i in world i mod worlds (default: "
             "none)"},
            2, max_worlds, &study::Study::worlds),
      {"conditions",
       "conditions that every machine has to bear, names and overrides of parameters: {empty: {}, loaded: "
       "{plant.inertia: 4.6}}; trial i runs under condition floor(i/R) mod C (R machines, or 1), and "
       "`trials` must be a multiple of R*C"},
      {"ages",
       "ages of every machine at which it is simulated, of values that have `aging` beside them: {at: [0, "
       "1.0e+5, "
       "1.0e+6], unit: cycles}; trial i is at age floor(i/(R*C)) mod A, and `trials` must be a multiple of "
       "R*C*A"},
      label({"design", "sampling design: monte_carlo (default), latin_hypercube, sobol or saltelli"},
            design_labels, &study::Study::design),
      stored(
          {"independent_points",
           "true: every design point has its own random numbers; false (default): trial i has the same ones "
           "at all points"},
          Form::boolean, &study::Study::independent_points),
      {"retain", "trials whose sample-by-sample records are kept: {trials: [0, 1]}"},
      label(
          {"keep",
           "what the results file keeps besides the statistics: trials (default), failures (the trials that "
           "did not succeed) or statistics (no trials)"},
          retention_labels, &study::Study::retention),
      map({"goal",
           "what the axis must achieve: {band: 1, within: 0.05, moves: 0.99, machines: 0.99, confidence: "
           "0.95}: the error is within 1 count for good after 0.05 s in at least 99 % of the moves of at "
           "least 99 % of the machines, claimed with 95 % confidence; without `machines` (which needs "
           "`rigs`) in at least 99 % of all moves; default band 0, confidence 0.95; `tolerance` (rad) in "
           "place of band: the position error itself stays within it; on: [0, 1]: the moves that it is about "
           "(default all); limits: {overshoot: 200, peak_torque: 45}: largest values of measures of a move"},
          "goal: {band: 1, within: 0.05, moves: 0.99}",
          {whole({"band"}, 0, max_band, &study::Goal::band),
           real({"tolerance"}, numerics::above(0), &study::Goal::tolerance),
           real({"within", "", "the time, s, after which the error stays within the band"},
                numerics::above(0), &study::Goal::within),
           real({"moves", "", "the proportion of the moves that meet it, between 0 and 1"}, open_unit,
                &study::Goal::moves),
           real({"machines"}, open_unit, &study::Goal::machines),
           {"on"},
           {"limits"},
           real({"confidence"}, open_unit, &study::Goal::confidence)}),
      {"goals",
       "several goals, all of which must be met, by their names: {large: {on: [0, 1], tolerance: 1.0e-8, "
       "within: 0.03, moves: 0.99}, small: {on: [2, 3], band: 1, within: 0.02, moves: 0.99}}; `goal` is for "
       "one"},
      map({"tune",
           "what zerocount tune may change and must keep: {free: {controller.ki: {log: [5.0e+3, 3.0e+5]}, "
           "controller.kp: [0, 1000]}, minimise: band_settling_time.p95, margins: {gain: 6, phase: 30, "
           "delay: 0.5}}: ranges of parameters, the criterion, and margins of the loop (dB, degrees, "
           "samples; sensitivity: the largest |S|), each off by the word, or `commissioning`: {gain: 6, "
           "phase: 45, delay: 1, sensitivity: 1.6, spread: typical}; spread: {inertia: 0.1, damping: 0.3, "
           "torque_constant: 0.05}, or `typical` for these: parts by which machines differ in what the study "
           "does not draw"},
          "tune: {free: {controller.ki: {log: [5.0e+3, 3.0e+5]}}}",
          {{"free", "", "a map of parameters and ranges: {controller.ki: {log: [5.0e+3, 3.0e+5]}}"},
           text({"minimise"}, &study::Tuning::minimise),
           map({.name = "margins",
                .none = "off",
                .presets = {{"commissioning",
                             [](Reading& reading) {
                               part_of<study::LoopMargins>(reading) = study::commissioning_margins;
                             }}}},
               "off, commissioning, or {gain: 6, phase: 30, delay: 0.5} (dB, degrees, samples)",
               {real({.name = "gain", .none = "off"}, margin, &study::LoopMargins::gain),
                real({.name = "phase", .none = "off"}, margin, &study::LoopMargins::phase),
                real({.name = "delay", .none = "off"}, margin, &study::LoopMargins::delay),
                real({.name = "sensitivity", .none = "off"}, numerics::above(1),
                     &study::LoopMargins::sensitivity),
                map({.name = "spread",
                     .none = "off",
                     .presets = {{"typical",
                                  [](Reading& reading) {
                                    part_of<study::LoopSpread>(reading) = study::typical_spread;
                                  }}}},
                    "off, typical, or {inertia: 0.1, damping: 0.3, torque_constant: 0.05} (parts of their "
                    "values)",
                    {real({.name = "inertia", .none = "off"}, spread, &study::LoopSpread::inertia),
                     real({.name = "damping", .none = "off"}, spread, &study::LoopSpread::damping),
                     real({.name = "torque_constant", .none = "off"}, spread,
                          &study::LoopSpread::torque_constant)})})}),
      map({"stop",
           "sequential stopping: blocks of `trials` trials are added until the bounds of every success rate "
           "are narrow enough: {success_rate_halfwidth: 0.005, confidence: 0.95, min_trials: 1000, "
           "max_trials: 100000}"},
          "stop: {success_rate_halfwidth: 0.005, max_trials: 100000}",
          {real({"success_rate_halfwidth", "",
                 "the half-width of the bounds of the success rate at which the study ends, 0 to 0.5"},
                {.low = 0.0, .high = 0.5}, &study::StoppingRule::success_rate_halfwidth),
           real({"confidence"}, open_unit, &study::StoppingRule::confidence),
           whole({"min_trials"}, 1, max_study_trials, &study::StoppingRule::min_trials),
           whole({"max_trials", "", "the maximum number of trials at a point"}, 1, max_study_trials,
                 &study::StoppingRule::max_trials)}),
      {"correlation",
       "correlations of drawn parameters: [[friction.k1, friction.k2, 0.6]], coefficients of the normal "
       "scores (Gaussian copula); each parameter keeps its distribution"},
      {"samples",
       "joint draws of several parameters, such as those of zerocount identify --posterior: path of a CSV "
       "table from the folder of the manifest, or {file: FILE, per: rig}; its header has the dotted paths of "
       "the parameters, and each world, machine or trial takes one row"},
      {"observed", "observations on the real machine, by case or point label: texts or counts"},
      {"sweep", "design points: grid (product of lists), cases (named), or both (product)"},
      label(
          {"controller.units",
           "unit of kp, ki and kd, also of the coarse phase: count (default), per count and sample; or si: N "
           "m/rad, N m/(rad s) and N m s/rad, which give the same control at any sample rate"},
          parameters::gain_unit_labels, &parameters::StudyUnits::gains),
      {"controller.plugin",
       "shared library with a controller of your own (docs/your-own-controller.md); path from the folder of "
       "the manifest"},
      {"controller.parameters", "parameters of the plugin, by name"},
      {"controller.filters",
       "list of filters on the controller's torque, in the order in which they act: {lowpass: {frequency, "
       "damping}}, {notch: {frequency, damping, depth}}, {lead: {frequency, ratio}}, {biquad: {b: [b0, b1, "
       "b2], a: [a1, a2]}}; their values are the parameters controller.filters.0.frequency ..."},
      {"controller.coarse.filters", "list of filters of the coarse phase, as controller.filters"},
      {"disturbance.ripple",
       "list of torques that vary along the rotor: {amplitude, periods, phase}, amplitude*sin(periods*(theta "
       "+ initial.position) + phase), periods per revolution; on a linear axis {amplitude, pitch, phase}"},
      {"disturbance.load.ripple", "list of torques on the second mass, by its angle, as disturbance.ripple"},
      {"disturbance.load.vibration",
       "list of torques on the second mass that vary in time, as disturbance.vibration"},
      {"plant.load.error",
       "kinematic error of the coupling, by the rotor: list of {amplitude, periods, phase} as "
       "disturbance.ripple, in rad; the twist is theta + the error - theta of the load"},
      {"disturbance.vibration",
       "list of torques that vary in time: {amplitude, frequency, phase}, amplitude*sin(2*pi*frequency*t + "
       "phase); or {spectrum: [[frequency, density], ...], lines: 100}, a random vibration with this "
       "one-sided power spectral density, (N m)^2/Hz, drawn anew in each trial"},
      {"command.torque.file",
       "open loop: a recorded torque in place of levels, as one move: a table with the columns t [s] and "
       "torque [N m] (force [N] on a linear axis), each value held until the next; or a list of such pairs"},
      label({"command.units",
             "unit of targets and overrun: counts (default) of the fine encoder; or si: rad (m on a linear "
             "axis), of which each trial takes the nearest count of its encoder"},
            parameters::target_unit_labels, &parameters::StudyUnits::targets),
      whole({"command.sequence.cycles", "number of cycles of a sequence (default 5)"}, 1,
            study::max_sequence_moves, &study::SequenceCycle::cycles),
      label({"command.sequence.approach",
             "direction from which a sequence approaches its targets: bidirectional (default: from both "
             "sides), positive (from below) or negative (from above)"},
            approach_labels, &study::SequenceCycle::approach),
      {"verdict.bands",
       "bands of the error, counts, whose first entry and settling are measured: 1 to 8 increasing numbers "
       "(default [0, 1])"}};
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

}  // namespace zerocount::keys
