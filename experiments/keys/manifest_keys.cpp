#include "experiments/keys/manifest_keys.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "core/trial/move_measures.hpp"
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
  for (const shapes::Shape& key : general_keys()) {
    if (key.name.find('.') == std::string_view::npos) paths.push_back(key.name);
  }
  for (const parameters::Parameter& parameter : parameters::parameter_table())
    paths.push_back(parameter.name);
  for (const shapes::Shape& key : general_keys()) {
    if (key.name.find('.') != std::string_view::npos) paths.push_back(key.name);
  }
  return paths;
}

// Rows, with the member of the study in which the value is stored.

using shapes::of;
using shapes::Shape;
using Form = Shape::Form;

constexpr numerics::Interval open_unit{.low = 0.0, .high = 1.0};

// Numbers of worlds: a goal is judged in each, with a part of the error probability.
constexpr std::int64_t max_worlds = 10'000;
// The machine is a 32-bit counter word of a rotor's random numbers.
constexpr std::int64_t max_machines = std::int64_t{1} << 32;
constexpr std::int64_t max_observed_trials = 1'000'000;
constexpr std::array<std::string_view, 2> masses{"motor", "load"};
// Range of a relative spread.
constexpr numerics::Interval spread{.low = 0.0, .high = 1.0, .low_included = true};
constexpr numerics::Interval margin{.low = 0.0, .high = 1e6, .low_included = true, .high_included = true};

// The part of the study that has the members of rows.
template <class Part>
Part& part_of(StudyDraft& draft) {
  if constexpr (std::is_same_v<Part, study::Study>) return draft.study;
  if constexpr (std::is_same_v<Part, study::Ages>) return draft.study.settings.ages;
  if constexpr (std::is_same_v<Part, study::Goal>) return draft.study.goals.back();
  if constexpr (std::is_same_v<Part, study::StoppingRule>) return draft.study.stop.value();
  if constexpr (std::is_same_v<Part, study::Tuning>) return draft.study.tuning.value();
  if constexpr (std::is_same_v<Part, study::LoopMargins>) return draft.study.tuning.value().margins;
  if constexpr (std::is_same_v<Part, study::LoopSpread>) return draft.study.tuning.value().margins.spread;
  if constexpr (std::is_same_v<Part, study::SequenceCycle>) return draft.plan.sequence.value();
  if constexpr (std::is_same_v<Part, parameters::StudyUnits>) return draft.plan.units;
  if constexpr (std::is_same_v<Part, trial::VerdictParameters>) return draft.plan.common.verdict;
}

// Stores the value of a field that has the shape; null: the word `none`.
template <class Value>
void store(Value& value, const Shape& shape, const yaml::Field* field) {
  if constexpr (std::is_same_v<Value, std::optional<double>>) {
    value = field == nullptr ? std::nullopt : std::optional(shapes::number_of(*field));
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = field->node->text;
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = field->node->text == "true";
  } else if constexpr (std::is_enum_v<Value>) {
    value = static_cast<Value>(std::ranges::find(shape.labels, field->node->text) - shape.labels.begin());
  } else if constexpr (std::is_same_v<Value, std::optional<motion::EncoderPlace>>) {
    value = static_cast<motion::EncoderPlace>(std::ranges::find(shape.labels, field->node->text) -
                                              shape.labels.begin());
  } else if constexpr (std::is_same_v<Value, study::TimeLimit>) {
    value = {shapes::number_of(*field), shape.name == "after_profile"};
  } else if constexpr (std::is_same_v<Value, double>) {
    value = shapes::number_of(*field);
  } else if constexpr (std::is_integral_v<Value>) {
    value = shapes::whole_of<Value>(*field);
  } else if constexpr (std::is_same_v<Value, trial::ErrorBands>) {
    value.count = field->node->items.size();
    for (std::size_t i = 0; i < value.count; ++i)
      store(value.limits[i], shape.parts.front(), &shapes::items_of(*field)[i]);
  } else {
    value.clear();
    for (const yaml::Field& item : shapes::items_of(*field))
      store(value.emplace_back(), shape.parts.front(), &item);
  }
}

// What the member has where nothing is stored: none if it is no value that a manifest can state, as for
// `machines`.
template <class Value>
Shape::Standard standard_of(const Value& value, const Shape& shape) {
  if constexpr (std::is_same_v<Value, std::optional<double>>) {
    return value ? standard_of(*value, shape) : Shape::Standard{};
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return value.empty() ? Shape::Standard{} : value;
  } else if constexpr (std::is_same_v<Value, trial::ErrorBands>) {
    return std::vector<double>(value.values().begin(), value.values().end());
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
    const auto number = static_cast<double>(value);
    const bool ranged = shape.form == Shape::Form::whole_number || shape.form == Shape::Form::real;
    return ranged && !numerics::contains(shape.range, number) ? Shape::Standard{} : number;
  } else {
    return {};
  }
}

template <class Part, class Value>
Shape stored(Shape shape, Value Part::*member) {
  if (!shape.required()) shape.standard = standard_of(Part{}.*member, shape);
  shape.set = [member](StudyDraft& draft, const Shape& read, const yaml::Field* field) {
    store(part_of<Part>(draft).*member, read, field);
  };
  return shape;
}

template <class Part>
Shape whole(Shape key, std::int64_t low, std::int64_t high, std::int64_t Part::*member) {
  return stored(shapes::whole(low, high, std::move(key)), member);
}

template <class Part, class Value>
Shape real(Shape key, const numerics::Interval& range, Value Part::*member) {
  return stored(shapes::real(range, std::move(key)), member);
}

template <class Part, class Value>
Shape label(Shape key, std::span<const std::string_view> labels, Value Part::*member) {
  key.labels = labels;
  return stored(of(Form::label, std::move(key)), member);
}

// Lists of moves or trials, each once. The last one depends on the study.
template <class Part>
Shape indices(Shape key, std::string expected, std::vector<std::int64_t> Part::*member) {
  key.order = Shape::Order::distinct;
  return stored(of(Form::list, std::move(key), std::move(expected), {shapes::whole(0, max_study_trials - 1)}),
                member);
}

// The measures of a move that a limit can be of.
std::vector<std::string> patterns_of_measures() {
  std::vector<std::string> patterns{
      fmt::format(R"(^{}\[[0-9]*\.?[0-9]+([eE][-+]?[0-9]+)?\]$)", trial::tolerance_measure)};
  for (const trial::NamedMeasure& measure : trial::named_measures())
    patterns.push_back(fmt::format("^{}$", measure.name));
  for (const std::string_view measure : trial::named_band_measures())
    patterns.push_back(fmt::format("^{}\\[[0-9]+\\]$", measure));
  return patterns;
}

Shape limits_shape() {
  Shape limits = of(Form::entries, {.name = "limits", .min_count = 1, .entry = "measure"},
                    "a map of measures of a move and largest values, such as {overshoot: 200}",
                    {shapes::real(numerics::at_least(0))});
  limits.named = false;
  limits.patterns = patterns_of_measures();
  return limits;
}

std::vector<Shape> keys_of_goal() {
  return {whole({"band"}, 0, max_band, &study::Goal::band),
          real({"tolerance"}, numerics::above(0), &study::Goal::tolerance),
          real({.name = "within",
                .if_missing = "the time, s, after which the error stays within the band, or `after_profile`",
                .in_its_place = "after_profile"},
               numerics::above(0), &study::Goal::within),
          real({"after_profile"}, numerics::above(0), &study::Goal::within),
          real({"moves", "", "the proportion of the moves that meet it, between 0 and 1"}, open_unit,
               &study::Goal::moves),
          real({"machines"}, open_unit, &study::Goal::machines),
          indices({.name = "on", .min_count = 1},
                  "a list of moves of a trial, from 0, each once, such as [0, 1]", &study::Goal::on),
          limits_shape(),
          real({"confidence"}, open_unit, &study::Goal::confidence),
          label({"of"}, masses, &study::Goal::of)};
}

Shape goals_shape(Shape key) {
  key.min_count = 1;
  key.entry = "goal";
  Shape goals = of(Form::entries, std::move(key),
                   "a map of goals by their names, such as {large: {within: 0.03, moves: 0.99}}",
                   {of(Form::map, {}, "{band: 1, within: 0.05, moves: 0.99}", keys_of_goal())});
  goals.add = [](StudyDraft& draft, const std::string& name) {
    draft.study.goals.push_back({.name = name, .axis = draft.plan.units.axis});
  };
  return goals;
}

// Ranges of the parameters that tuning may change.
Shape free_shape() {
  constexpr const char* range = "a range such as [0, 1000] or {log: [5.0e+3, 3.0e+5]}";
  const auto ends = [&](Shape key) {
    return of(Form::tuple, std::move(key), range,
              {shapes::real(numerics::all_numbers()), shapes::real(numerics::all_numbers())});
  };
  constexpr const char* expected = "a map of parameters and ranges: {controller.ki: {log: [5.0e+3, 3.0e+5]}}";
  Shape free =
      of(Form::entries, {.name = "free", .if_missing = expected, .min_count = 1, .entry = "free parameter"},
         expected,
         {of(Form::one_of, {}, range, {ends({}), of(Form::map, {}, range, {ends({"log", "", range})})})});
  free.named = false;  // dotted paths of parameters
  return free;
}

Shape margins_shape() {
  Shape spread_of_machines = of(
      Form::map,
      {.name = "spread",
       .none = "off",
       .presets = {{"typical",
                    [](StudyDraft& draft) { part_of<study::LoopSpread>(draft) = study::typical_spread; }}}},
      "off, typical, or {inertia: 0.1, damping: 0.3, torque_constant: 0.05} (parts of their values)",
      {real({.name = "inertia", .none = "off"}, spread, &study::LoopSpread::inertia),
       real({.name = "damping", .none = "off"}, spread, &study::LoopSpread::damping),
       real({.name = "torque_constant", .none = "off"}, spread, &study::LoopSpread::torque_constant)});
  return of(
      Form::map,
      {.name = "margins",
       .none = "off",
       .presets = {{"commissioning",
                    [](StudyDraft& draft) {
                      part_of<study::LoopMargins>(draft) = study::commissioning_margins;
                    }}}},
      "off, commissioning, or {gain: 6, phase: 30, delay: 0.5} (dB, degrees, samples)",
      {real({.name = "gain", .none = "off"}, margin, &study::LoopMargins::gain),
       real({.name = "phase", .none = "off"}, margin, &study::LoopMargins::phase),
       real({.name = "delay", .none = "off"}, margin, &study::LoopMargins::delay),
       real({.name = "sensitivity", .none = "off"}, numerics::above(1), &study::LoopMargins::sensitivity),
       std::move(spread_of_machines)});
}

Shape observed_shape(Shape key) {
  constexpr const char* observation = "a text, or counts: {successes: 9, of: 10}";
  Shape counts =
      of(Form::map, {}, observation,
         {shapes::whole(0, max_observed_trials, {"successes", "", observation}),
          shapes::whole(1, max_observed_trials, {"of", "", observation}), of(Form::text, {"text"})});
  key.named = false;  // cases, and labels of points
  return of(Form::entries, std::move(key), "a map from cases or point labels to observations",
            {of(Form::one_of, {}, observation, {of(Form::text), std::move(counts)})});
}

}  // namespace

std::span<const Shape> general_keys() {
  constexpr const char* ages = "ages: {at: [0, 1.0e+5, 1.0e+6], unit: cycles}";
  constexpr const char* samples = "the name of a file, or {file: posterior.csv, per: machine}";
  const auto record = [](Shape key, const char* expected, const char* pair) {
    return of(Form::one_of, std::move(key), expected,
              {of(Form::line),
               of(Form::list, {.min_count = 2, .max_count = max_record_rows, .order = Shape::Order::rising},
                  expected,
                  {of(Form::tuple, {}, pair,
                      {shapes::real(numerics::at_least(0)), shapes::real(numerics::all_numbers())})})});
  };
  constexpr const char* pair_of_parameters = "[first parameter, second parameter, coefficient]";
  static const std::vector<Shape> keys{
      shapes::whole(manifest_version, manifest_version,
                    {"zerocount", "version of the manifest's format: 1", "zerocount: 1"}),
      stored(of(Form::line, {"name", "name of the study", "a name for the study"}, "a name for the study"),
             &study::Study::name),
      stored(of(Form::text, {"description", "what the study is for"}), &study::Study::description),
      label(
          {"axis",
           "rotary (default), or linear: m, N, kg, N/m ... in place of rad, N m, kg m^2, N m/rad (zerocount parameters --axis linear)"},
          parameters::axis_labels, &parameters::StudyUnits::axis),
      shapes::real(numerics::above(0), {"travel", "period of the friction profiles of a linear axis, m"}),
      stored(Shape{.name = "seed",
                   .meaning = "seed of all random numbers, 0 to 2^64 - 1",
                   .if_missing = "a whole number",
                   .form = Shape::Form::seed},
             &study::Study::seed),
      whole({"trials", "trials at each design point", "the number of trials at each design point"}, 1,
            max_study_trials, &study::Study::trials),
      whole(
          {"machines",
           "number of machines; "
           "trial i runs on machine i mod machines, and `trials` must be a multiple of it (default: no trials share a machine)"},
          2, max_machines, &study::Study::machines),
      whole(
          {"worlds",
           "number of worlds, which differ in what all machines share and nobody knows (`per: world`); "
           "machine r lives in world r mod worlds, without `machines` trial i in world i mod worlds (default: none)"},
          2, max_worlds, &study::Study::worlds),
      of(Form::entries,
         {.name = "conditions",
          .meaning =
              "conditions under which every machine must run, as names and overrides of parameters: {empty: {}, loaded: {plant.inertia: 4.6}}; "
              "trial i runs under condition floor(i/R) mod C (R machines, or 1), and `trials` must be a multiple of R*C",
          .min_count = 1,
          .max_count = 1000,
          .entry = "condition"},
         "1 to 1000 conditions: a map from names to overrides: {empty: {}, loaded: {plant.inertia: 4.6}}",
         {{.name = "assignments"}}),
      of(Form::map,
         {"ages",
          "ages of every machine at which it is simulated, of values that have `aging` beside them: {at: [0, 1.0e+5, 1.0e+6], unit: cycles}; "
          "trial i is at age floor(i/(R*C)) mod A, and `trials` must be a multiple of R*C*A"},
         ages,
         {stored(of(Form::list,
                    {.name = "at",
                     .if_missing = "a rising list of ages: at: [0, 1.0e+5]",
                     .min_count = 1,
                     .max_count = 1000,
                     .order = Shape::Order::rising},
                    "a rising list of 1 to 1000 ages from 0 on", {shapes::real(numerics::at_least(0))}),
                 &study::Ages::at),
          stored(of(Form::word, {"unit"}, "a word such as cycles, h or km"), &study::Ages::unit)}),
      label({"design", "sampling design: monte_carlo (default), latin_hypercube, sobol or saltelli"},
            design_labels, &study::Study::design),
      stored(
          Shape{
              .name = "independent_points",
              .meaning =
                  "true: every design point has its own random numbers; false (default): trial i has the same ones at all points",
              .form = Shape::Form::boolean},
          &study::Study::independent_points),
      of(Form::map, {"retain", "trials whose sample-by-sample records are kept: {trials: [0, 1]}"},
         "retain: {trials: [..]}",
         {indices({"trials"}, "a list of trial indices, each once", &study::Study::retained_trials)}),
      label(
          {"keep",
           "what the results file keeps besides the statistics: trials (default), failures (the trials that did not succeed) or statistics (no trials)"},
          retention_labels, &study::Study::retention),
      of(Form::map,
         {"goal",
          "what the axis must achieve: {band: 1, within: 0.05, moves: 0.99, machines: 0.99, confidence: 0.95}: "
          "the error is within 1 count for good after 0.05 s in at least 99 % of the moves of at least 99 % of the machines, claimed with 95 % confidence; "
          "without `machines` (which needs `machines`) in at least 99 % of all moves; "
          "default band 0, confidence 0.95; "
          "`tolerance` (rad) in place of band: the position error itself stays within it; "
          "`after_profile` (s) in place of within: from the end of each move's profile; "
          "on: [0, 1]: the moves that it is about (default all); "
          "limits: {overshoot: 200, peak_torque: 45}: largest values of measures of a move; "
          "of: motor or load: the mass whose position error it is, of two"},
         "goal: {band: 1, within: 0.05, moves: 0.99}", keys_of_goal()),
      goals_shape(
          {"goals",
           "several goals, all of which must be met, by their names: "
           "{large: {on: [0, 1], tolerance: 1.0e-8, within: 0.03, moves: 0.99}, small: {on: [2, 3], band: 1, within: 0.02, moves: 0.99}}; "
           "`goal` is for one"}),
      of(Form::map,
         {"tune",
          "what zerocount tune may change and must keep: "
          "{free: {controller.ki: {log: [5.0e+3, 3.0e+5]}, controller.kp: [0, 1000]}, minimise: band_settling_time.p95, margins: {gain: 6, phase: 30, delay: 0.5}}: "
          "ranges of parameters, the criterion, and margins of the loop (dB, degrees, samples; sensitivity: the largest |S|), each off by the word, or `commissioning`: "
          "{gain: 6, phase: 45, delay: 1, sensitivity: 1.6, spread: typical}; "
          "spread: {inertia: 0.1, damping: 0.3, torque_constant: 0.05}, or `typical` for these: parts by which machines differ in what the study does not draw"},
         "tune: {free: {controller.ki: {log: [5.0e+3, 3.0e+5]}}}",
         {free_shape(), stored(of(Form::text, {"minimise"}), &study::Tuning::minimise), margins_shape()}),
      of(Form::map,
         {"stop",
          "sequential stopping: "
          "blocks of `trials` trials are added until the bounds of every success rate are narrow enough: "
          "{success_rate_halfwidth: 0.005, confidence: 0.95, min_trials: 1000, max_trials: 100000}"},
         "stop: {success_rate_halfwidth: 0.005, max_trials: 100000}",
         {real({"success_rate_halfwidth", "",
                "the half-width of the bounds of the success rate at which the study ends, 0 to 0.5"},
               {.low = 0.0, .high = 0.5}, &study::StoppingRule::success_rate_halfwidth),
          real({"confidence"}, open_unit, &study::StoppingRule::confidence),
          whole({"min_trials"}, 1, max_study_trials, &study::StoppingRule::min_trials),
          whole({"max_trials", "", "the maximum number of trials at a point"}, 1, max_study_trials,
                &study::StoppingRule::max_trials)}),
      of(Form::list,
         {.name = "correlation",
          .meaning =
              "correlations of drawn parameters: [[friction.k1, friction.k2, 0.6]], coefficients of the normal scores (Gaussian copula); "
              "each parameter keeps its distribution"},
         fmt::format("a list of entries {}", pair_of_parameters),
         {of(Form::tuple, {}, pair_of_parameters,
             {of(Form::line), of(Form::line), shapes::real({.low = -1.0, .high = 1.0})})}),
      of(Form::one_of,
         {"samples",
          "joint draws of several parameters, such as those of zerocount identify --posterior: "
          "path of a CSV table from the folder of the manifest, or {file: FILE, per: machine}; "
          "its header has the dotted paths of the parameters, and each world, machine or trial takes one row"},
         samples,
         {of(Form::line),
          of(Form::map, {}, samples,
             {of(Form::line, {"file", "", samples}),
              of(Form::label, {.name = per_key, .labels = std::span(draw_level_labels).first(4)})})}),
      observed_shape(
          {"observed", "observations on the real machine, by case or point label: texts or counts"}),
      of(Form::map, {"sweep", "design points: grid (product of lists), cases (named), or both (product)"},
         "a map with grid, cases or both",
         {{"grid"},
          of(Form::entries, {.name = "cases", .entry = "case"}, "a map from names to cases",
             {{.name = "assignments"}})}),
      label({"controller.units",
             "unit of kp, ki and kd, also of the coarse phase: count (default), per count and sample; "
             "or si: N m/rad, N m/(rad s) and N m s/rad, which give the same control at any sample rate"},
            parameters::gain_unit_labels, &parameters::StudyUnits::gains),
      of(Form::line,
         {"controller.plugin",
          "shared library with a controller of your own (docs/your-own-controller.md); path from the folder of the manifest"}),
      {"controller.parameters", "parameters of the plugin, by name"},
      {"controller.filters",
       "list of filters on the controller's torque, in the order in which they act: "
       "{lowpass: {frequency, damping}}, {notch: {frequency, damping, depth}}, {lead: {frequency, ratio}}, {biquad: {b: [b0, b1, b2], a: [a1, a2]}}; "
       "their values are the parameters controller.filters.0.frequency ..."},
      {"controller.coarse.filters", "list of filters of the coarse phase, as controller.filters"},
      {"disturbance.ripple",
       "list of torques that vary along the rotor: "
       "{amplitude, periods, phase}, amplitude*sin(periods*(theta + initial.position) + phase), periods per revolution; "
       "on a linear axis {amplitude, pitch, phase}"},
      {"disturbance.load.ripple", "list of torques on the second mass, by its angle, as disturbance.ripple"},
      {"disturbance.load.vibration",
       "list of torques on the second mass that vary in time, as disturbance.vibration"},
      {"plant.load.error",
       "kinematic error of the coupling, by the rotor: list of {amplitude, periods, phase} as disturbance.ripple, in rad; "
       "the twist is theta + the error - theta of the load"},
      {"disturbance.vibration",
       "list of torques that vary in time: {amplitude, frequency, phase}, amplitude*sin(2*pi*frequency*t + phase); "
       "or {spectrum: [[frequency, density], ...], lines: 100}, a random vibration with this one-sided power spectral density, (N m)^2/Hz, drawn anew in each trial"},
      record(
          {"command.torque.file",
           "open loop: a recorded torque in place of levels, as one move: "
           "a table with the columns t [s] and torque [N m] (force [N] on a linear axis), each value held until the next; "
           "or a list of such pairs"},
          "the name of a table, or a list of at least two pairs [time in s, torque], by ascending time from 0 on",
          "a pair [time in s, torque]"),
      record(
          {"command.reference.file",
           "a recorded reference in place of targets, as one move from the trial's start: "
           "a table with the columns t [s] and reference [rad] ([m] on a linear axis), straight between its rows; "
           "or a list of such pairs",
           "the name of a table"},
          "the name of a table, or a list of at least two pairs [time in s, position], by ascending time from 0 on",
          "a pair [time in s, position]"),
      of(Form::line, {"command.reference.column", "name of the column of the table (default reference)"},
         "the name of a column"),
      label({"command.units",
             "unit of targets and overrun: counts (default) of the fine encoder; "
             "or si: rad (m on a linear axis), of which each trial takes the nearest count of its encoder"},
            parameters::target_unit_labels, &parameters::StudyUnits::targets),
      whole({"command.sequence.cycles", "number of cycles of a sequence (default 5)"}, 1,
            study::max_sequence_moves, &study::SequenceCycle::cycles),
      label(
          {"command.sequence.approach",
           "direction from which a sequence approaches its targets: bidirectional (default: from both sides), positive (from below) or negative (from above)"},
          approach_labels, &study::SequenceCycle::approach),
      stored(
          of(Form::list,
             {.name = "verdict.bands",
              .meaning =
                  "bands of the error, counts, whose first entry and settling are measured: 1 to 8 increasing numbers (default [0, 1])",
              .min_count = 1,
              .max_count = trial::max_error_bands,
              .order = Shape::Order::rising},
             "a list of 1 to 8 increasing numbers of counts, such as [0, 1]", {shapes::whole(0, max_band)}),
          &trial::VerdictParameters::bands)};
  return keys;
}

const Shape& spectrum_shape() {
  constexpr const char* pairs =
      "a list of at least two pairs [frequency in Hz, density], by ascending frequency, or a file of them";
  constexpr std::size_t max_points = 10000;
  constexpr std::int64_t max_lines = 1000;
  constexpr numerics::Interval frequencies{.low = 0.0, .high = 1e9, .high_included = true};
  static const Shape shape =
      of(Form::map, {}, "{spectrum: [[frequency, density], ...], lines: 100}",
         {of(Form::one_of, {"spectrum", "", pairs}, pairs,
             {of(Form::line),
              of(Form::list, {.min_count = 2, .max_count = max_points, .order = Shape::Order::rising}, pairs,
                 {of(Form::tuple, {}, "a pair [frequency in Hz, density]",
                     {shapes::real(frequencies), shapes::real(numerics::closed(0, 1e12))})})}),
          shapes::whole(1, max_lines, {"lines"})});
  return shape;
}

const Shape* find_general_key(std::string_view path) {
  const auto keys = general_keys();
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const Shape& key) { return key.name == path; });
  return found == keys.end() ? nullptr : &*found;
}

const Shape& shape_of(std::string_view path) {
  if (const Shape* key = find_general_key(path)) return *key;
  const std::size_t dot = path.rfind('.');
  return *std::ranges::find(shape_of(path.substr(0, dot)).parts, path.substr(dot + 1), &Shape::name);
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
