#include "runners/tuning/machine_runs/machine_runner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/batch/batch.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t trials_of_reference = 8;  // of a block that lanes do not run

/// A machine of a study that is to run, with the entry of the list of runs to which it belongs.
struct MachineOfEntry {
  const MachinesToRun* entry;
  std::int64_t machine;
};

/// Machines whose trials one thread runs at once. They belong to one or several entries of the list of runs.
using Block = std::vector<MachineOfEntry>;

/// Appends the value that the criterion takes for a move to `values`; infinity for "never". Appends nothing
/// if the measure has no value for this move.
void add_value(std::vector<double>& values, const Criterion& criterion, const trial::MoveOutcome& move) {
  const double scale = criterion.scale ? criterion.scale->from_start(move.travel_time) : 1.0;
  if (!trial::was_run(move)) {
    values.push_back(std::numeric_limits<double>::infinity());
  } else if (const std::optional<double> value = measures::ranked_value(*criterion.measure, move)) {
    values.push_back(measures::lateness(*value / scale));
  }
}

/// Adds the moves of a trial to the counts of its machine: judged moves, moves that meet each goal, and
/// criterion values.
class TrialCounter {
 public:
  explicit TrialCounter(const study::Study& study)
      : goals_(measures::move_criteria_of(study)),
        criteria_(criteria_of(study)),
        settings_(static_cast<std::size_t>(study.settings.total())) {}

  void add(std::span<const trial::MoveOutcome> moves, std::int64_t setting, MachineResult& result) const {
    result.claims.resize(goals_.size() * settings_);
    for (std::size_t goal = 0; goal < goals_.size(); ++goal) {
      ClaimResult& claim = result.claims[goal * settings_ + static_cast<std::size_t>(setting)];
      for (const trial::MoveOutcome& move : moves) {
        if (!measures::asks(goals_[goal], move)) continue;
        ++claim.moves;
        claim.met += measures::meets(goals_[goal], move) ? 1 : 0;
        add_value(claim.values, criteria_[goal], move);
        result.slid = result.slid || move.broke_away;
      }
    }
  }

 private:
  std::vector<measures::MoveCriterion> goals_;
  std::vector<Criterion> criteria_;
  std::size_t settings_;
};

/// Parameters of the i-th trial of a machine (0 … trials_each − 1), with the change of the entry applied.
trial::TrialParameters trial_of(const MachinesToRun& entry, const trials::Replicates& machines,
                                std::int64_t machine, std::int64_t i) {
  const std::int64_t trial = trials::trial_of_replicate(*entry.study, machines, machine, i);
  trial::TrialParameters parameters = study::study_trial(*entry.study, machines.point, trial).parameters;
  if (entry.change != nullptr) (*entry.change)(parameters);
  return parameters;
}

std::vector<trial::TrialParameters> trials_of(const Block& block, const trials::Replicates& machines) {
  std::vector<trial::TrialParameters> trials;
  for (const MachineOfEntry& one : block) {
    for (std::int64_t i = 0; i < machines.trials_each; ++i)
      trials.push_back(trial_of(*one.entry, machines, one.machine, i));
  }
  return trials;
}

/// Number of machines whose trials one thread runs at once.
/// @param all number of trials that are run together
std::size_t machines_of_block(const MachinesToRun& entry, const trials::Replicates& machines,
                              std::int64_t all) {
  const bool in_lanes = batch::runs_in_lanes(trial_of(entry, machines, entry.from, 0));
  const std::int64_t trials = in_lanes ? trials::block_for_lanes(all) : trials_of_reference;
  return static_cast<std::size_t>(std::max<std::int64_t>(1, trials / machines.trials_each));
}

/// Divides the machines into the smallest number n of blocks of at most `size` machines. Block b gets the
/// machines b, b + n, b + 2n, …, so it has machines of every entry (study to run) with at least n machines.
/// The time of a trial depends on its entry, so blocks with machines of a single entry would take different
/// times.
void add_blocks(std::span<const MachineOfEntry> machines, std::size_t size, std::vector<Block>& blocks) {
  const std::size_t count = (machines.size() + size - 1) / size;
  for (std::size_t block = 0; block < count; ++block) {
    blocks.emplace_back();
    for (std::size_t i = block; i < machines.size(); i += count) blocks.back().push_back(machines[i]);
  }
}

/// Divides the machines of all entries (studies to run) into blocks of about equal work, however few machines
/// each entry has.
/// @param all number of trials of all entries
std::vector<Block> blocks_of(std::span<const MachinesToRun> entries, const trials::Replicates& machines,
                             std::int64_t all) {
  std::map<std::size_t, std::vector<MachineOfEntry>> by_size;
  for (const MachinesToRun& entry : entries) {
    if (entry.from >= entry.to) continue;
    std::vector<MachineOfEntry>& same = by_size[machines_of_block(entry, machines, all)];
    for (std::int64_t machine = entry.from; machine < entry.to; ++machine) same.push_back({&entry, machine});
  }
  std::vector<Block> blocks;
  for (const auto& [size, same] : by_size) add_blocks(same, size, blocks);
  return blocks;
}

/// Moves of the i-th trial of a machine, converted from the finer counts and samples of the changed trial to
/// the units of its study.
/// @param finer measures of the moves in the units of the changed trial
std::vector<trial::MoveOutcome> moves_in_study_units(const MachineOfEntry& one,
                                                     const trials::Replicates& machines, std::int64_t i,
                                                     std::span<const trial::MoveOutcome> finer) {
  const trial::TrialParameters parameters = trial_of(*one.entry, machines, one.machine, i);
  std::vector<trial::MoveOutcome> moves;
  for (std::size_t move = 0; move < finer.size(); ++move)
    moves.push_back(in_study_units(finer[move], one.entry->finer, one.entry->study->features.bands,
                                   trial::move_timing(parameters, move)));
  return moves;
}

void add_outcomes(const Block& block, const trials::Replicates& machines,
                  std::span<const trial::TrialOutcome> outcomes) {
  std::optional<TrialCounter> counter;
  const MachinesToRun* entry = nullptr;
  std::int64_t settings = 1;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto trial = static_cast<std::int64_t>(i);
    const MachineOfEntry& one = block[i / static_cast<std::size_t>(machines.trials_each)];
    if (one.entry != std::exchange(entry, one.entry)) {
      counter.emplace(*entry->study);
      settings = entry->study->settings.total();
    }
    const bool same_units = entry->finer == FinerUnits{};
    const std::vector<trial::MoveOutcome> converted =
        same_units ? std::vector<trial::MoveOutcome>{}
                   : moves_in_study_units(one, machines, trial % machines.trials_each, outcomes[i].moves);
    counter->add(same_units ? outcomes[i].moves : converted, trial % machines.trials_each % settings,
                 (*entry->results)[static_cast<std::size_t>(one.machine)]);
  }
}

/// Criterion that is a quantile of a measure of the true motion or the position error, such as
/// rest_torque_noise.p95; nothing if the text names no such measure of the study.
std::optional<Criterion> motion_criterion(const study::Study& study, std::string_view text) {
  const auto dot = text.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const auto quantile = std::ranges::find(comparison::quantile_names, text.substr(dot + 1),
                                          &std::pair<std::string_view, double>::first);
  if (quantile == comparison::quantile_names.end()) return std::nullopt;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    bool study::StudyFeatures::*const use = measure.only_with;
    const bool is_motion = use == &study::StudyFeatures::motion || use == &study::StudyFeatures::following ||
                           use == &study::StudyFeatures::reversals;
    if (measure.field.column.name != text.substr(0, dot) || !layout::is_in_file(measure, study.features))
      continue;
    if (measure.tolerance || (is_motion && study.features.*use)) return Criterion{&measure, quantile->second};
  }
  return std::nullopt;
}

/// Whether the text names a settling time in the bands or tolerances of the goals, such as
/// "band_settling_time.p95".
bool is_of_settling(std::string_view text) {
  return text.starts_with("band_settling_time.");
}

Criterion criterion_of(const study::Study& study, std::size_t goal, const std::string& wanted_text) {
  const goal::Question question = only(goal::question_of(study), goal);
  const bool has_several = study.goals.size() > 1;
  const bool is_default = wanted_text == study::Tuning{}.minimise;
  const std::string text = is_default || (has_several && is_of_settling(wanted_text))
                               ? goal::settling_measure(question) + wanted_text.substr(wanted_text.rfind('.'))
                               : wanted_text;
  if (const std::optional<Criterion> criterion = motion_criterion(study, text)) return *criterion;
  const auto dot = text.rfind('.');
  const std::string name = text.substr(0, dot);
  const bool lacks_band = name.starts_with("band_") && !name.ends_with("]") && dot != std::string::npos;
  const std::string with_band =
      lacks_band ? fmt::format("{}[{}]{}", name, question.goal()->band, text.substr(dot)) : text;
  if (const std::string_view meanings = trial::meanings_of_settling_time(text); !meanings.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: tune.minimise: '{}' may mean two measures; expected {}", study.name, text,
                              meanings));
  const auto quantity = comparison::find_requirable(with_band);
  if (!quantity || quantity->kind != comparison::RequirementKind::quantile) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: tune.minimise: '{}' is not a quantile of a measure; expected one such as "
                              "band_settling_time.p95, arrival_time.median or, with verdict.motion, "
                              "rest_torque_noise.p95",
                              study.name, text));
  }
  const layout::Measure& wanted = *quantity->measure.measure;
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    if (measure.field.column.name == wanted.field.column.name && measure.band == wanted.band)
      return {&measure, quantity->probability};
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: tune.minimise: '{}' needs an error band that the study does not measure; "
                            "expected one of verdict.bands or the goal's",
                            study.name, text));
}

}  // namespace

std::vector<std::string> names_of(std::span<const study::FreeParameter> free) {
  std::vector<std::string> names;
  for (const study::FreeParameter& one : free) names.push_back(one.name);
  return names;
}

std::optional<study::Study> at_values(const study::Study& study, std::span<const study::FreeParameter> free,
                                      const Values& values) {
  return trials::with_values(study, names_of(free), values);
}

std::vector<std::string> overrides_of(std::span<const study::FreeParameter> free, const Values& values) {
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < free.size(); ++i)
    overrides.push_back(fmt::format("{}={}", free[i].name, values[i]));
  return overrides;
}

bool is_of_settling(const study::Study& study) {
  return !study.tuning || is_of_settling(study.tuning->minimise);
}

std::string criterion_name(const study::Study& study) {
  const std::string& name = study.tuning->minimise;
  const auto has_tolerance = [](const study::Goal& goal) { return goal.tolerance.has_value(); };
  if (!is_of_settling(study) || std::ranges::none_of(study.goals, has_tolerance)) return name;
  const std::string_view measure =
      std::ranges::all_of(study.goals, has_tolerance) ? "tolerance_settling_time" : "goal_settling_time";
  return std::string(measure) + name.substr(name.rfind('.'));
}

bool is_proportion_of_allowed(const study::Study& study) {
  return study.goals.size() > 1 && is_of_settling(study);
}

std::vector<Criterion> criteria_of(const study::Study& study) {
  const std::string text = study.tuning ? study.tuning->minimise : study::Tuning{}.minimise;
  std::vector<Criterion> criteria;
  for (std::size_t goal = 0; goal < std::max<std::size_t>(study.goals.size(), 1); ++goal) {
    criteria.push_back(criterion_of(study, goal, text));
    if (is_proportion_of_allowed(study)) criteria.back().scale = study.goals[goal].within;
  }
  return criteria;
}

Aim aim_of(const study::Study& study) {
  Aim aim{.claims = {},
          .settings = static_cast<std::size_t>(study.settings.total()),
          .quantile = criteria_of(study).front().quantile,
          .worlds = study.worlds};
  const std::vector<study::Goal> goals =
      study.goals.empty() ? std::vector{study::Goal{.moves = 1.0}} : study.goals;
  for (const study::Goal& goal : goals) aim.claims.insert(aim.claims.end(), aim.settings, goal);
  return aim;
}

ClaimPlace place_of_claim(const study::Study& study, std::size_t claim) {
  const auto settings = static_cast<std::size_t>(study.settings.total());
  return {claim / settings, claim % settings};
}

std::size_t claim_at(const study::Study& study, const ClaimPlace& place) {
  return place.goal * static_cast<std::size_t>(study.settings.total()) + place.setting;
}

bool has_named_claims(const study::Study& study) {
  return study.goals.size() > 1 || !study.settings.empty();
}

ClaimNames names_of(const study::Study& study, const ClaimPlace& place) {
  ClaimNames names;
  if (has_named_claims(study) && !study.goals.empty() && !study.goals[place.goal].name.empty())
    names.goal = study.goals[place.goal].name;
  if (!study.settings.empty()) names.setting = study::label_of(study.settings, place.setting);
  return names;
}

std::string claim_text(const study::Study& study, const ClaimPlace& place) {
  return (study.goals.size() > 1 ? fmt::format(" '{}'", study.goals[place.goal].name) : std::string()) +
         study::setting_phrase(study.settings, static_cast<std::int64_t>(place.setting));
}

MachineResult result_of(const study::Study& study, std::span<const trial::TrialOutcome> outcomes) {
  const TrialCounter counter(study);
  MachineResult result;
  for (const trial::TrialOutcome& one : outcomes) counter.add(one.moves, 0, result);
  return result;
}

void run_machines(std::span<const MachinesToRun> entries, const trials::Replicates& machines,
                  const trials::Effort& effort) {
  trials::TrialSet set;
  for (const MachinesToRun& entry : entries) {
    entry.results->resize(static_cast<std::size_t>(entry.to));
    set.count += (entry.to - entry.from) * machines.trials_each;
  }
  const std::vector<Block> blocks = blocks_of(entries, machines, set.count);
  set.blocks = blocks.size();
  set.draw = [&](std::size_t block) { return trials_of(blocks[block], machines); };
  trials::run(set, effort, [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
    add_outcomes(blocks[block], machines, outcomes);
  });
}

std::vector<MachineResult> results_of(const study::Study& study, const trials::Replicates& machines,
                                      std::int64_t count, const Change* change,
                                      const trials::Effort& effort) {
  std::vector<MachineResult> results;
  const MachinesToRun all{&study, 0, std::min(count, machines.count), &results, change};
  run_machines({&all, 1}, machines, effort);
  return results;
}

std::vector<MachineResult> results_in(const reading::AllTrialsFile& file, const study::Study& study,
                                      const trials::Replicates& machines) {
  const TrialCounter counter(study);
  const study::TrialIndices indices = study::trial_indices(study);
  std::vector<MachineResult> results(static_cast<std::size_t>(machines.count));
  measures::visit_trials(file, file.rows(), [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
    counter.add(moves, indices.setting_of(row),
                results[static_cast<std::size_t>(indices.draw_of(row) % machines.count)]);
  });
  return results;
}

}  // namespace zerocount::tuning
