#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/sample_size.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/theory/hunting_prediction.hpp"
#include "analysis/trials/theory/point_theory.hpp"
#include "core/loop/encoder.hpp"
#include "core/text/text.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/commands/command.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* check_help =
    "Reports every error of the manifest with its place. Without errors, prints the plan (design\n"
    "points, trials, cost, size), the effects of a real axis that it assumes away (noise, delay, ...;\n"
    "a key that is given as 0 is a statement), and the theory of each design point:\n"
    "  - the bounds of ki by the paper's criteria (6) and (7), which ignore sampling, delay and\n"
    "    amplifier, and the bound of the sampled loop at the lowest stiffness k1, which includes\n"
    "    them; both also at the lowest k1 of the study (the low end of its distribution, or the\n"
    "    minimum of the profiles)\n"
    "  - the rules for the DAC and the sample rate\n"
    "  - the slowest time constant of the sampled loop at k1 and k1 + k2, oscillating or not, and the\n"
    "    time that the slowest move needs, to compare with the hold\n"
    "  - gain and phase margins of the sampled loop, with all blocks of the controller, at k1, at\n"
    "    k1 + k2, at the softest and the stiffest place of a profile, and while the rotor slides; with\n"
    "    a second mass also while the motor moves alone in a gap, and while the load stands or slides\n"
    "  - the hunting of trial 0, with the amplitude and period of its longest move: the whole loop is\n"
    "    simulated, without noise and vibration, until the axis rests or oscillates for good, for at\n"
    "    most 1048576 samples after the end of the reference. With two masses the numbers are those of\n"
    "    the mass that closes the loop, or of the other one if it oscillates alone\n"
    "  - the bandwidth while it slides: the highest frequency at which the open loop has gain 1\n"
    "\n"
    "Example: zerocount check experiments/manifests/paper-gains.yaml\n";

constexpr std::int64_t points_shown = 20;

/// Results of the linear theory for a design point in a setting (condition at an age).
struct SettingTheory {
  std::int64_t point{0};
  std::string label;
  std::optional<std::string> name;  ///< Short label of the design point; nothing in a study with one point.
  /// Name of the setting (condition at an age); nothing without settings.
  std::optional<std::string> setting;
  theory::PointTheory theory;
  /// Predicted hunting (limit cycle of friction and integral action) of trial 0; nothing without a
  /// prediction.
  std::optional<theory::HuntingPrediction> hunting;
  /// Targets of trial 0 as text, each in SI units and in counts, at most five. Nothing if the manifest gives
  /// the targets in counts.
  std::optional<std::string> targets;
};

/// A control loop of a design point in a setting, as a row of the table of loops.
struct PointLoop {
  std::optional<std::string> point;  ///< Short label of the design point; nothing in a study with one point.
  std::optional<std::string> setting;
  const theory::LoopRanges* loop;
};

struct Plan {
  const study::Study& study;
  forecast::StudyCost cost;
  forecast::StudySize size;
  std::vector<SettingTheory> points;  ///< Theory of the first design points in each setting, point by point.

  std::int64_t all_points() const { return study::point_count(study); }
  std::int64_t points_shown() const { return std::ssize(points) / study.settings.total(); }
  std::int64_t points_left_out() const { return all_points() - points_shown(); }
  double disk_bytes() const { return size.file_bytes + size.shard_bytes; }
  std::vector<PointLoop> loops() const {
    std::vector<PointLoop> all;
    for (const SettingTheory& point : points) {
      for (const theory::LoopRanges& loop : point.theory.loops)
        all.push_back({point.name, point.setting, &loop});
    }
    return all;
  }
};

std::optional<std::string> judged_by(const Plan& plan) {
  if (plan.study.open_loop) return {};
  return goal::question_sentence(goal::question_of(plan.study));
}

std::string plan_headline(const Plan& plan) {
  const study::Study& study = plan.study;
  return fmt::format("{}: {} × {} = {}, {} each, in about {}", study.name,
                     text::counted(plan.all_points(), "design point"), text::counted(study.trials, "trial"),
                     text::counted(study::trial_count(study), "trial"), text::counted(study.moves, "move"),
                     status::duration_text(plan.cost.seconds()));
}

/// Text such as "16 trials", the number of trials in each of equally large groups.
/// @param all number of trials of all groups
/// @param groups number of groups
/// @param noun word for the counted objects, such as "trial"
std::string of_each(std::int64_t all, std::int64_t groups, std::string_view noun) {
  return text::counted(all / std::max<std::int64_t>(groups, 1), noun);
}

/// Text such as "3, 16 trials under each: warm, cold, …" about groups of trials; nothing if there are no such
/// groups.
/// @param groups number of groups
/// @param each text about the trials of each group
/// @param names names of the groups; empty: not listed
std::optional<std::string> groups_text(std::int64_t groups, std::string_view each,
                                       const std::vector<std::string>& names = {}) {
  if (groups == 0) return {};
  return fmt::format("{}, {}{}{}", groups, each, names.empty() ? "" : ": ", fmt::join(names, ", "));
}

std::optional<std::string> machines_text(const Plan& plan) {
  const study::Study& study = plan.study;
  return groups_text(study.machines, of_each(study.trials, study.machines, "trial") + " of each");
}

std::optional<std::string> worlds_text(const Plan& plan) {
  const study::Study& study = plan.study;
  return groups_text(study.worlds,
                     (study.machines > 0 ? of_each(study.machines, study.worlds, "machine")
                                         : "about " + of_each(study.trials, study.worlds, "trial")) +
                         " in each");
}

std::optional<std::string> conditions_text(const Plan& plan) {
  const std::vector<std::string>& names = plan.study.settings.conditions;
  return groups_text(std::ssize(names),
                     of_each(plan.study.trials, std::ssize(names), "trial") + " under each", names);
}

std::optional<std::string> ages_text(const Plan& plan) {
  const study::Ages& ages = plan.study.settings.ages;
  std::vector<std::string> texts;
  for (const double age : ages.at) texts.push_back(study::age_text(ages, age));
  return groups_text(std::ssize(texts), of_each(plan.study.trials, std::ssize(texts), "trial") + " at each",
                     texts);
}

std::string stop_text(const Plan& plan) {
  const std::optional<study::StoppingRule>& stop = plan.study.stop;
  if (!stop) return {};
  return fmt::format(
      "or fewer: after every {} at each point it ends if all success rates are known to ± {:.4g}; its bounds "
      "hold at whatever number of trials it ends, which takes more than a fixed number",
      stop->block, stop->success_rate_halfwidth);
}

std::string cost_text(const Plan& plan) {
  const std::string engine = forecast::engine_text(forecast::points_on_reference(plan.study));
  return fmt::format(
      "{:.4g} samples at {:.0f} ns: about {} on {}\n{}{}results file about {}; while it runs up to {} on the "
      "disk and {} of memory",
      plan.cost.samples, 1e9 * plan.cost.seconds_per_sample, status::duration_text(plan.cost.seconds()),
      text::counted(plan.cost.cores, "core"), engine, engine.empty() ? "" : "\n",
      forecast::bytes_text(plan.size.file_bytes), forecast::bytes_text(plan.disk_bytes()),
      forecast::bytes_text(plan.size.memory_bytes));
}

/// Sentence that says which trials and design points the theory covers.
std::string theory_text(const Plan& plan) {
  const std::int64_t trials = study::draw_count(plan.study);
  const std::string points = plan.points_left_out() == 0
                                 ? "each point"
                                 : fmt::format("each of the first {} of {} points (--all-points shows all)",
                                               plan.points_shown(), plan.all_points());
  // Outside the paper's theory nothing but the loops is examined.
  const bool loops_alone = std::ranges::none_of(
      plan.points, [](const SettingTheory& point) { return point.theory.outside.empty(); });
  const std::string close =
      loops_alone || trials <= theory::max_trials_examined_closely
          ? ""
          : fmt::format(
                "; the sampled loop, time constants and margins over the first {}, and the trials with the "
                "lowest and the highest k1",
                theory::max_trials_examined_closely);
  return fmt::format(
      "The theory covers the first {} trials of {}{}, each with the friction it starts on{}",
      std::min(trials, loops_alone ? theory::max_trials_examined_closely : theory::max_trials_examined),
      points, plan.study.settings.empty() ? "" : " under each condition", close);
}

/// Expected number of trials that the stopping rule takes, compared with a number of trials fixed beforehand,
/// at three success rates. Empty without a stopping rule.
std::vector<statistics::SequentialCost> stopping_costs(const Plan& plan) {
  std::vector<statistics::SequentialCost> costs;
  if (!plan.study.stop) return costs;
  const study::StoppingRule& rule = *plan.study.stop;
  for (const double rate : {0.5, 0.9, 0.99})
    costs.push_back(
        statistics::sequential_cost(rule.success_rate_halfwidth, rule.confidence, rate, rule.block));
  return costs;
}

document::Description<statistics::SequentialCost> stopping_description() {
  using statistics::SequentialCost;
  return document::Description<SequentialCost>()
      .value({.key = "success_rate",
              .heading = "success rate",
              .meaning = "success rate of the trials",
              .unit = "1",
              .notation = document::Notation::given_percent},
             &SequentialCost::rate)
      .value({"trials", "trials at each point", "trials that the stopping rule takes, about"},
             &SequentialCost::sequential)
      .value({"fixed", "if fixed beforehand", "trials for the same bounds, if fixed beforehand"},
             &SequentialCost::fixed)
      .value({"ratio", "ratio", "ratio of both", "1", document::Notation::two_digits},
             &SequentialCost::ratio);
}

/// Adds to the description an item with the names of the inputs that are drawn at one of these levels, for
/// example once per machine.
void add_inputs(document::Description<Plan>& description, document::Item item,
                std::vector<study::DrawLevel> drawn) {
  description.value(std::move(item), [drawn = std::move(drawn)](const Plan& plan) {
    std::vector<std::string> names;
    for (const study::InputColumn& column : plan.study.columns.inputs) {
      if (std::ranges::find(drawn, column.level) != drawn.end()) names.push_back(column.name);
    }
    return names;
  });
}

/// Texts of the study's assumptions whose fulfilment is in this state.
std::vector<std::string_view> assumptions(const Plan& plan, study::PremiseState state) {
  std::vector<std::string_view> found;
  for (const study::Premise& premise : plan.study.premises) {
    if (premise.state == state) found.push_back(premise.assumption);
  }
  return found;
}

document::Description<SettingTheory> point_description() {
  using document::in_data;
  return document::Description<SettingTheory>()
      .value(in_data("point", "number of the design point"), &SettingTheory::point)
      .value(in_data("label", "label of the design point"), &SettingTheory::label)
      .value({.key = "name", .heading = "point", .shown = document::Visibility::to_people},
             &SettingTheory::name)
      .value({.key = "condition",
              .heading = "condition",
              .meaning = "condition under which every machine runs",
              .optional = true},
             &SettingTheory::setting)
      .include(theory::point_theory_description(), &SettingTheory::theory)
      .include(theory::hunting_description(), &SettingTheory::hunting)
      .value({"targets", "targets of trial 0", "targets of trial 0 in SI units, and their counts"},
             &SettingTheory::targets);
}

document::Description<Plan> plan_description() {
  using document::in_data;
  using forecast::StudyCost;
  document::Description<Plan> plan;
  plan.headline(plan_headline)
      .sentence([](const Plan& p) { return p.study.description; })
      .value(in_data("name", "name of the study"), [](const Plan& p) { return p.study.name; })
      .value(in_data("points", "design points"), &Plan::all_points)
      .value(in_data("trials", "trials of each point, or the most of them"),
             [](const Plan& p) { return p.study.trials; })
      .value(in_data("moves", "moves of a trial"), [](const Plan& p) { return p.study.moves; })
      .value({"machine_count", "machines at each point", "number of machines at each point; 0: none"},
             [](const Plan& p) { return p.study.machines; })
      .shown_as(machines_text)
      .value({"worlds", "worlds", "worlds; 0: none"}, [](const Plan& p) { return p.study.worlds; })
      .shown_as(worlds_text)
      .value({"conditions", "under the conditions",
              "names of the conditions under which every machine runs; empty: none"},
             [](const Plan& p) { return study::labels_of(p.study.settings); })
      .shown_as(conditions_text)
      .value({.heading = "at the ages", .shown = document::Visibility::to_people}, ages_text)
      .sentence(stop_text)
      .value({"judged_by", "judged by", "what the moves are judged by; null without targets"}, judged_by)
      .table({"stopping", "Trials that the stopping rule takes", "trials that the stopping rule takes"},
             stopping_description(), stopping_costs)
      .sentence(cost_text)
      .object(in_data("cost", "computing time"),
              document::Description<StudyCost>()
                  .value(in_data("samples", "samples of all trials"), &StudyCost::samples)
                  .value(in_data("seconds_per_sample", "on one core", "s"), &StudyCost::seconds_per_sample)
                  .value(in_data("cores", "cores of this machine"), &StudyCost::cores)
                  .value(in_data("seconds", "with all cores", "s"), &StudyCost::seconds),
              &Plan::cost)
      .value(in_data("file_bytes", "size of the results file", "byte"),
             [](const Plan& p) { return p.size.file_bytes; })
      .value(in_data("disk_bytes", "most space on the disk while it runs", "byte"), &Plan::disk_bytes)
      .value(in_data("memory_bytes", "most memory", "byte"),
             [](const Plan& p) { return p.size.memory_bytes; })
      .sentence([](const Plan& p) {
        return p.study.columns.inputs.empty() ? std::string("differing between trials: nothing") : "";
      });
  using study::DrawLevel;
  add_inputs(plan, {"differ_in_trials", "differing between trials", "inputs that differ between trials"},
             {DrawLevel::trial, DrawLevel::contact});
  add_inputs(
      plan, {"differ_in_contacts", "of these, drawn anew at each contact", "of these, drawn at each contact"},
      {DrawLevel::contact});
  add_inputs(plan,
             {"differ_in_machines", "differing between machines", "inputs that differ between machines"},
             {DrawLevel::machine});
  add_inputs(plan, {"differ_in_worlds", "differing between worlds", "inputs that differ between worlds"},
             {DrawLevel::world});
  add_inputs(
      plan, {"same_in_points", "the same in all trials of a point", "inputs that differ between points only"},
      {DrawLevel::study});
  return plan
      .value({"sampled_together", "sampled together", "inputs of a table of samples"},
             [](const Plan& p) {
               return p.study.samples ? study::samples_text(*p.study.samples) : std::optional<std::string>();
             })
      .value({"correlated", "correlated", "correlated inputs"},
             [](const Plan& p) {
               return p.study.correlations.empty() ? std::optional<std::string>()
                                                   : study::correlations_text(p.study.correlations);
             })
      .value(
          {"assumed_away", "assumes away", "effects of a real axis that the study leaves out without a word"},
          [](const Plan& p) { return assumptions(p, study::PremiseState::assumed); })
      .value({"stated_none", "states as absent", "effects of a real axis whose keys the manifest gives as 0"},
             [](const Plan& p) { return assumptions(p, study::PremiseState::stated_none); })
      .sentence(theory_text)
      .value(in_data("points_left_out", "points without their theory here"), &Plan::points_left_out)
      .table({.key = "theory",
              .heading = "Theory",
              .meaning = "theory of the first points",
              .common_above = true},
             point_description(), &Plan::points)
      .table({.key = "loops", .heading = "Loops", .shown = document::Visibility::to_people},
             document::Description<PointLoop>()
                 .value({.key = "point", .heading = "point"}, &PointLoop::point)
                 .value({.key = "condition", .heading = "condition"}, &PointLoop::setting)
                 .include(theory::loop_description(), &PointLoop::loop),
             &Plan::loops);
}

document::AnswerDescription<Plan> check_answer() {
  return {{.name = "check",
           .meaning = "the plan of a study, and the theory of its points",
           .csv_table = "theory"},
          plan_description()};
}

/// Text about the targets of a trial, rounded to counts: "to the nearest of 3.9e-06 rad: 0.0001 rad = 26
/// counts". Nothing if the manifest gives the targets in counts.
std::optional<std::string> targets_text(const study::Study& study, const study::StudyTrial& trial) {
  constexpr std::size_t shown = 5;
  const std::size_t moves = trial.target_positions.size();
  if (moves == 0) return {};
  const std::string unit = parameters::unit_on(study.units.axis, "rad");
  std::string text;
  for (std::size_t i = 0; i < std::min(moves, shown); ++i) {
    text += fmt::format("{}{:.6g} {} = {}", i == 0 ? "" : ", ", trial.target_positions[i], unit,
                        text::counted(trial.parameters.command.targets[i], "count"));
  }
  return fmt::format("to the nearest of {:.4g} {}: {}{}", loop::fine_resolution(trial.parameters.encoder),
                     unit, text, moves > shown ? ", …" : "");
}

/// Prints a warning about the first design point at which moves may end before they arrive, because the loop
/// is slow, and says how many such points there are.
void warn_of_short_moves(std::span<const SettingTheory> points) {
  const auto is_short = [](const SettingTheory& point) { return point.theory.approach.exceeds_hold(); };
  const auto first = std::ranges::find_if(points, is_short);
  if (first == points.end()) return;
  const auto others = std::ranges::count_if(points, is_short) - 1;
  status::tell(
      "warning: point {} ({}){}: the loop's slowest time constant{}: moves may end before they arrive{}\n",
      first->point, first->label, first->setting ? ", " + *first->setting : "",
      theory::slowness_text(first->theory.approach),
      others > 0 ? fmt::format("; the same holds for {} more of the {} examined", others, points.size())
                 : "");
}

std::vector<SettingTheory> examined_points(const study::Study& study, std::int64_t count) {
  const std::vector<std::string> names = summary::short_labels(study.points.labels, study.points.axes);
  const std::int64_t settings = study.settings.total();
  std::vector<SettingTheory> points(static_cast<std::size_t>(count * settings));
  const auto examine = [&](std::size_t i, std::vector<theory::KnownRotor>& rotors) {
    const std::int64_t point = static_cast<std::int64_t>(i) / settings;
    const std::int64_t setting = static_cast<std::int64_t>(i) % settings;
    const auto index = static_cast<std::size_t>(point);
    const study::StudyTrial trial =
        study::study_trial(study, point, study::trial_indices(study).trial_of(0, setting));
    points[i] = {
        point,
        study.points.labels[index],
        names.size() == 1 ? std::nullopt : std::optional(names[index]),
        study.settings.empty() ? std::nullopt : std::optional(study::label_of(study.settings, setting)),
        theory::examine(study, point, setting, rotors),
        theory::predict_hunting(trial.parameters),
        targets_text(study, trial)};
  };
  std::vector<theory::KnownRotor> of_first;
  if (!points.empty()) examine(0, of_first);
  parallel::for_each_index(points.empty() ? 0 : points.size() - 1, [&](std::size_t i) {
    std::vector<theory::KnownRotor> rotors = of_first;
    examine(i + 1, rotors);
  });
  warn_of_short_moves(points);
  return points;
}

ExitCode check(const command_line::Arguments& arguments) {
  const study::Study study = commands::load_study(arguments.operands()[0], arguments);
  if (arguments.has("hash")) {
    standard_output::print("{}\n", study.study_sha256);
    return ExitCode::success;
  }
  plugins::require_no_hidden_state(study);
  if (study.tuning && study::first_goal(study)) tuning::criteria_of(study);  // a wrong one is an error
  commands::print_warnings(study);
  const std::int64_t all = study::point_count(study);
  const std::int64_t shown = arguments.has("all-points") ? all : std::min(all, points_shown);
  return answers::print(
      arguments, check_answer().of({study, forecast::measure_cost(study), forecast::measure_size(study),
                                    examined_points(study, shown)}));
}

}  // namespace

commands::Command check_command() {
  return {
      {"check",
       "MANIFEST|FILE",
       {command_line::excluding({"hash"}, answers::format_option()),
        {"set", "KEY=VALUE", "override a manifest key; may be repeated", true},
        command_line::excluding(
            {"hash"}, {"all-points", "", "print the theory of every design point, not only of the first 20"}),
        {"hash", "",
         "print only the SHA-256 of all that determines the trials, which 'zerocount run --study' takes"}}},
      "validate a manifest; print its plan and the theory of its points",
      check_help,
      check,
      [] { return std::vector{check_answer().complete_type()}; }};
}

}  // namespace zerocount::study_commands
