#include "analysis/monitor/machine_monitor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/parallel/parallel.hpp"
#include "core/failure/failure.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::monitor {
namespace {

constexpr std::int64_t max_simulated = 100'000;  // values of a simulated sequence
constexpr std::int64_t min_simulated = 64;

/// The values of blocks of consecutive moves; what is left of the last one is not used.
std::vector<double> blocks_of(const MonitoredMeasure& measure, const std::vector<double>& moves,
                              std::int64_t block) {
  if (block == 1) return moves;
  std::vector<double> values;
  const auto size = static_cast<std::size_t>(block);
  for (std::size_t first = 0; first + size <= moves.size(); first += size)
    values.push_back(block_value(measure, std::span(moves).subspan(first, size)));
  return values;
}

double typical_value(const MonitoredMeasure& measure, std::vector<double> values) {
  if (measure.quality)
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The unit in which values are stored, where a column has this unit.
std::string shown_unit(const MonitoredMeasure& measure, const std::string& unit) {
  return have_same_dimension(unit, measure.unit) ? measure.unit : linear_unit(measure);
}

/// The settings with the measures named as columns are.
MonitorSettings with_own_names(MonitorSettings settings) {
  for (std::string& name : settings.measures)
    if (const std::optional<MonitoredMeasure> measure = measure_named(name)) name = measure->name;
  return settings;
}

bool is_wanted(const MonitorSettings& settings, const MonitoredMeasure& measure) {
  if (settings.measures.empty()) return !measure.accumulates;
  return std::ranges::find(settings.measures, measure.name) != settings.measures.end();
}

[[noreturn]] void refuse_without_common(const Baseline& baseline, const MoveLog& log,
                                        const MonitorSettings& settings) {
  const auto names = [](const auto& columns) {
    std::vector<std::string> all;
    all.reserve(columns.size());
    for (const auto& column : columns) all.push_back(column.measure.name);
    return fmt::format("{}", fmt::join(all, ", "));
  };
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: no measure to compare{}: it has {}, and {} has {}; expected columns named alike",
                  log.name(), settings.measures.empty() ? "" : " among those of --measure",
                  names(log.columns()), baseline.name, names(baseline.columns)));
}

}  // namespace

bool are_dependent(double correlation, std::size_t values) {
  constexpr double normal_quantile = 3.29;
  return correlation * std::sqrt(static_cast<double>(values)) > normal_quantile;
}

MachineMonitor::MachineMonitor(const Baseline& baseline, const MoveLog& log, MonitorSettings settings)
    : settings_(with_own_names(std::move(settings))), unused_(log.others()) {
  for (const std::string& name : settings_.measures)
    if (log.find(name) == nullptr || baseline.find(name) == nullptr)
      throw Failure(ExitCode::bad_input, fmt::format("--measure {}: {} has no such measure", name,
                                                     log.find(name) == nullptr ? log.name() : baseline.name));
  for (const MoveLog::Column& column : log.columns()) {
    const Baseline::Column* const before = baseline.find(column.measure.name);
    const bool named = !settings_.measures.empty();
    const bool wanted = before != nullptr && is_wanted(settings_, column.measure);
    if (!wanted && (before == nullptr || !named)) unused_.push_back(column.measure.name);
    if (!wanted) continue;
    if (!have_same_dimension(before->unit, column.unit))
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: {} is in '{}', and in {} in '{}'; expected units of the same dimension",
                                log.name(), column.measure.name, column.unit, baseline.name, before->unit));
    add(baseline, *before, column);
  }
  if (states_.empty()) refuse_without_common(baseline, log, settings_);
  for (MeasureState& state : states_) state.evidence = 1.0 / static_cast<double>(states_.size());
}

void MachineMonitor::add(const Baseline& baseline, const Baseline::Column& before,
                         const MoveLog::Column& column) {
  std::vector<double> values = blocks_of(before.measure, before.values, settings_.block);
  if (values.empty())
    throw Failure(ExitCode::bad_data,
                  fmt::format("the baseline has {} moves; expected at least a block of {}",
                              before.values.size(), settings_.block));
  MeasureState state{.measure = column.measure,
                     .unit = shown_unit(column.measure, before.unit.empty() ? column.unit : before.unit),
                     .baseline_median = typical_value(before.measure, before.values),
                     .to_see = change_to_see(column.measure, values, settings_.change)};
  if (!baseline.is_model) state.correlation = serial_correlation(values);
  std::ranges::sort(values);
  const random::RandomKey ties =
      designs::random_key(settings_.seed, fmt::format("monitor.{}", column.measure.name));
  ChangeTest test(values, ties);
  watched_.push_back({.test = std::move(test), .baseline = std::move(values)});
  states_.push_back(std::move(state));
}

std::vector<std::string> MachineMonitor::dependent() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (states_[i].correlation && are_dependent(*states_[i].correlation, watched_[i].baseline.size()))
      names.push_back(states_[i].measure.name);
  return names;
}

void MachineMonitor::update_measure(std::size_t number, double value) {
  Watched& watched = watched_[number];
  MeasureState& state = states_[number];
  const double p = watched.test.update(value);
  watched.values.push_back(value);
  const ChangeMartingale& martingale = watched.test.martingale();
  const double capital = martingale.capital();
  state.evidence = std::max(state.evidence, capital / static_cast<double>(states_.size()));
  if (state.alarm_at) return;
  watched.p_values.push_back(p);
  if (capital < alarm_capital()) return;
  state.direction = martingale.direction();
  state.alarm_at = martingale.values() * settings_.block;
  state.since = (martingale.since(watched.p_values) - 1) * settings_.block + 1;
  watched.p_values = {};
}

void MachineMonitor::update(const MoveLog& log) {
  const std::int64_t block = settings_.block;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    MeasureState& state = states_[i];
    const std::vector<double>& moves = log.find(state.measure.name)->values;
    for (std::int64_t done = watched_[i].test.martingale().values() * block;
         done + block <= std::ssize(moves); done += block)
      update_measure(i,
                     block_value(state.measure, std::span(moves).subspan(static_cast<std::size_t>(done),
                                                                         static_cast<std::size_t>(block))));
    const std::int64_t first = state.since.value_or(1) - 1;
    if (first < std::ssize(moves))
      state.median = typical_value(state.measure, {moves.begin() + first, moves.end()});
  }
  moves_ = log.moves();
}

/// Asks all measures and directions at once. The limit doubles, so that a growing log is simulated seldom.
void MachineMonitor::simulate_changes(std::int64_t values) {
  const auto limit = std::min(
      max_simulated,
      std::max(min_simulated, static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(values)))));
  struct Task {
    std::size_t measure;
    Direction direction;
    std::optional<std::int64_t> seen{};
  };
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (watched_[i].seen_limit >= limit) continue;
    for (const Direction direction : states_[i].to_see.directions)
      if (!watched_[i].seen[direction]) tasks.push_back({i, direction});
    watched_[i].seen_limit = limit;
  }
  parallel::for_each_index(tasks.size(), [&](std::size_t number) {
    Task& task = tasks[number];
    const MeasureState& state = states_[task.measure];
    task.seen = values_to_see({.measure = state.measure,
                               .baseline = watched_[task.measure].baseline,
                               .direction = task.direction,
                               .size = state.to_see.size,
                               .alarm = alarm_capital(),
                               .max_values = limit,
                               .seed = settings_.seed});
  });
  for (const Task& task : tasks) watched_[task.measure].seen[task.direction] = task.seen;
}

bool MachineMonitor::is_unchanged(std::int64_t values) {
  simulate_changes(values);
  bool any = false;
  bool all = true;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].seen_after.reset();
    if (states_[i].to_see.directions.empty()) continue;
    any = true;
    std::int64_t last = 0;
    for (const auto& [direction, seen] : watched_[i].seen) last = std::max(last, seen.value_or(values + 1));
    if (last <= values) states_[i].seen_after = last * settings_.block;
    all = all && last <= values;
  }
  return any && all;
}

MonitorState MachineMonitor::state() {
  MonitorState state{.moves = moves_};
  for (const MeasureState& one : states_) {
    state.evidence = std::max(state.evidence, one.evidence);
    const bool is_first =
        one.alarm_at && (state.alarm == nullptr || *one.alarm_at < *state.alarm->alarm_at ||
                         (*one.alarm_at == *state.alarm->alarm_at && one.evidence > state.alarm->evidence));
    if (is_first) state.alarm = &one;
  }
  const std::int64_t values = moves_ / settings_.block;
  if (state.alarm != nullptr)
    state.status = MachineStatus::changed;
  else if (values > 0 && is_unchanged(values))
    state.status = MachineStatus::unchanged;
  return state;
}

}  // namespace zerocount::monitor
