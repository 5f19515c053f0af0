#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/statistics/sample_size.hpp"
#include "analysis/summary/shown_points.hpp"
#include "analysis/text/percent.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/study/study.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/plugins/hidden_state.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/point_theory_text.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/study_run/cost.hpp"
#include "runners/study_run/engine_use.hpp"
#include "runners/study_run/progress.hpp"
#include "runners/study_run/study_size.hpp"
#include "runners/tuning/unit_runner.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* check_help =
    "Reports every error of the manifest with its place. Without errors, prints the plan (design\n"
    "points, trials, cost, size) and the theory of each design point:\n"
    "  - the bounds of ki by the paper's criteria (6) and (7), which ignore sampling, delay and\n"
    "    amplifier, and the bound of the sampled loop at the lowest stiffness k1, which includes\n"
    "    them; both also at the lowest k1 of the study (the low end of its distribution, or the\n"
    "    minimum of the profiles)\n"
    "  - the rules for the DAC and the sample rate\n"
    "  - the slowest time constant of the sampled loop at k1 and k1 + k2, and the time that the\n"
    "    slowest move needs, to compare with the hold\n"
    "  - gain and phase margins of the sampled loop, with all blocks of the controller, at k1, at\n"
    "    k1 + k2 and while the rotor slides\n"
    "  - for coulomb, dahl and lugre the hunting of trial 0: amplitude and period\n"
    "  - the bandwidth while it slides: the highest frequency at which the open loop has gain 1\n"
    "\n"
    "Example: zerocount check experiments/manifests/paper-gains.yaml\n";

constexpr std::int64_t points_shown = 20;

/// Prints the input columns that are drawn as often as one of `drawn`, after `title`; nothing if there are
/// none.
void print_columns(const study::Study& study, std::string_view title,
                   std::initializer_list<study::Per> drawn) {
  std::string names;
  for (const study::InputColumn& column : study.input_columns) {
    if (std::find(drawn.begin(), drawn.end(), column.per) != drawn.end()) names += " " + column.name;
  }
  if (!names.empty()) standard_output::print("  {}:{}\n", title, names);
}

/// Trials that the rule takes against a number fixed beforehand, at three success rates.
void print_cost_of_stopping(const study::StoppingRule& rule) {
  standard_output::print(
      "  its bounds hold at whatever number of trials it ends, which takes more than a fixed number:\n");
  for (const double rate : {0.5, 0.9, 0.99}) {
    const statistics::SequentialCost cost =
        statistics::sequential_cost(rule.success_rate_halfwidth, rule.confidence, rate, rule.block);
    standard_output::print(
        "    success rate {}: about {} trials at each point, {:.1f} times the {} of a fixed number{}\n",
        text::percent(rate), cost.sequential, cost.ratio(), cost.fixed,
        cost.sequential > rule.max_trials ? fmt::format("; max_trials ends it before, at {}", rule.max_trials)
                                          : "");
  }
}

void print_what_differs(const study::Study& study) {
  if (study.input_columns.empty()) standard_output::print("  differing between trials: nothing\n");
  print_columns(study, "differing between trials", {study::Per::trial, study::Per::contact});
  print_columns(study, "of these, drawn anew at each contact", {study::Per::contact});
  print_columns(study, "differing between rigs", {study::Per::rig});
  print_columns(study, "differing between worlds", {study::Per::world});
  print_columns(study, "the same in all trials of a point", {study::Per::study});
  if (study.samples) standard_output::print("  sampled together: {}\n", study::samples_text(*study.samples));
  if (!study.correlations.empty())
    standard_output::print("  correlated: {}\n", study::correlations_text(study.correlations));
}

void print_plan(const study::Study& study) {
  const study_run::StudyCost cost = study_run::measure_cost(study);
  standard_output::print("{}: {}\n", study.name,
                         study.description.empty() ? "(no description)" : study.description);
  standard_output::print("  {} × {} trials = {} trials, {} each\n",
                         counted(study::point_count(study), "design point"), study.trials,
                         study::trial_count(study), counted(study.moves, "move"));
  if (study.rigs > 0) {
    standard_output::print("  at each point {} rigs × {} trials of each\n", study.rigs,
                           study.trials / study.rigs);
  }
  if (study.worlds > 0) {
    standard_output::print("  in {} worlds, {} in each\n", study.worlds,
                           study.rigs > 0 ? counted(study.rigs / study.worlds, "rig")
                                          : fmt::format("about {} trials", study.trials / study.worlds));
  }
  if (study.stop) {
    standard_output::print(
        "  or fewer: after every {} at each point it ends if all success rates are known to ± {:.4g}\n",
        study.stop->block, study.stop->success_rate_halfwidth);
    print_cost_of_stopping(*study.stop);
    if (study.rigs > 0) {
      standard_output::print(
          "  (of these {} rigs; more trials do not show how other rigs differ; see 'zerocount plan "
          "--rig-sd')\n",
          study.rigs);
    }
  }
  standard_output::print("  {:.4g} samples at {:.0f} ns: about {} on {}\n", cost.samples,
                         1e9 * cost.seconds_per_sample, study_run::duration_text(cost.seconds()),
                         counted(cost.cores, "core"));
  const std::string engine = study_run::engine_text(study_run::points_on_reference(study));
  if (!engine.empty()) standard_output::print("  {}\n", engine);
  const study_run::StudySize size = study_run::measure_size(study);
  standard_output::print("  results file about {}; while it runs up to {} on the disk and {} of memory\n",
                         study_run::bytes_text(size.file_bytes),
                         study_run::bytes_text(size.file_bytes + size.shard_bytes),
                         study_run::bytes_text(size.memory_bytes));
  print_what_differs(study);
}

void print_theory_heading(const study::Study& study) {
  standard_output::print(
      "\nTheory, over the first {} trials of each point, each with the friction it starts on:\n",
      std::min(study.trials, theory::max_trials_examined));
  if (study.trials > theory::max_trials_examined_closely) {
    standard_output::print(
        "(sampled loop, time constants and margins over the first {}, and the trials with the lowest and the "
        "highest k1)\n",
        theory::max_trials_examined_closely);
  }
}

/// Adds the targets of trial 0 in SI units, and the counts that they become; nothing for targets in counts.
void add_targets(std::vector<TheoryItem>& items, const study::Study& study, std::int64_t point) {
  constexpr std::size_t shown = 5;
  const study::StudyTrial trial = study::study_trial(study, point, 0);
  const std::size_t moves = trial.target_positions.size();
  if (moves == 0) return;
  const std::string unit = parameters::unit_on(study.units.axis, "rad");
  std::string text;
  for (std::size_t i = 0; i < std::min(moves, shown); ++i) {
    text += fmt::format("{}{:.6g} {} = {}", i == 0 ? "" : ", ", trial.target_positions[i], unit,
                        counted(trial.parameters.command.targets[i], "count"));
  }
  items.push_back({"targets of trial 0", fmt::format("to the nearest of {:.4g} {}: {}{}",
                                                     loop::fine_resolution(trial.parameters.encoder), unit,
                                                     text, moves > shown ? ", …" : "")});
}

ExitCode check(const command_line::Arguments& arguments) {
  const std::string& manifest = arguments.operands()[0];
  const study::Study study = commands::load_study(manifest, arguments);
  plugins::require_no_hidden_state(study);
  if (study.tuning && study.goal) tuning::criterion_of(study);  // a wrong one is an error
  commands::print_warnings(study);
  print_plan(study);
  print_theory_heading(study);
  const std::int64_t shown = arguments.has("all-points") ? study::point_count(study)
                                                         : std::min(study::point_count(study), points_shown);
  std::vector<std::vector<TheoryItem>> items;
  for (std::int64_t point = 0; point < shown; ++point) {
    const theory::PointTheory theory = theory::examine(study, point);
    items.push_back(theory_items(theory));
    add_targets(items.back(), study, point);
    const std::string& label = study.point_labels[static_cast<std::size_t>(point)];
    if (!theory.approach.exceeds_hold()) continue;
    status::tell(
        "warning: point {} ({}): the loop's slowest time constant{}: moves may end before they arrive\n",
        point, label, slowness_text(theory.approach));
  }
  std::vector<std::string> labels = summary::short_labels(study.point_labels, study.axes);
  labels.resize(static_cast<std::size_t>(shown));
  standard_output::write_fitted(theory_text(labels, items, study::point_count(study)));
  if (shown < study::point_count(study)) {
    standard_output::print("  … and {} more points (--all-points shows them)\n",
                           study::point_count(study) - shown);
  }
  return ExitCode::success;
}

}  // namespace

commands::Command check_command() {
  return {{"check",
           "MANIFEST",
           {{"set", "KEY=VALUE", "override a manifest key; may be repeated", true},
            {"all-points", "", "print the theory of every design point, not only of the first 20"}}},
          "validate a manifest; print its plan and the theory of its points",
          check_help,
          check};
}

}  // namespace zerocount::study_commands
