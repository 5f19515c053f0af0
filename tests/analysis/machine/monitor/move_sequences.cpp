#include "tests/analysis/machine/monitor/move_sequences.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/designs/designs.hpp"

namespace zerocount::testing {
namespace {

constexpr std::uint64_t seed = 20261127;

monitor::ChangeTest test_after_baseline(const Sequence& sequence, random::NumberSource& numbers) {
  std::vector<double> baseline;
  for (std::int64_t i = 0; i < sequence.baseline; ++i) baseline.push_back(move_value(sequence.kind, numbers));
  return monitor::ChangeTest({std::move(baseline)}, designs::random_key(seed, "ties"));
}

std::string experiment_of(const Sequence& sequence) {
  return fmt::format("{}.{}.{}", name_of(sequence.kind), sequence.baseline, sequence.factor);
}

}  // namespace

std::string_view name_of(Moves kind) {
  switch (kind) {
    case Moves::lognormal:
      return "continuous";
    case Moves::tied:
      return "tied";
    case Moves::binary:
      break;
  }
  return "binary";
}

double move_value(Moves kind, random::NumberSource& numbers, double factor) {
  if (kind == Moves::binary) return numbers.uniform() < 0.95 * factor ? 1.0 : 0.0;
  const double value = 0.05 * std::exp(0.25 * numbers.normal()) * factor;
  return kind == Moves::tied ? 0.02 * std::rint(value / 0.02) : value;
}

random::NumberSource numbers_of(std::string_view experiment, std::uint32_t number) {
  return random::NumberSource(designs::random_key(seed, experiment), number);
}

double largest_capital(const Sequence& sequence, std::uint32_t number) {
  random::NumberSource numbers = numbers_of(experiment_of(sequence), number);
  monitor::ChangeTest test = test_after_baseline(sequence, numbers);
  double largest = 0.0;
  for (std::int64_t t = 0; t < sequence.moves; ++t) {
    test.update(move_value(sequence.kind, numbers));
    largest = std::max(largest, test.martingale().capital());
  }
  return largest;
}

std::optional<std::int64_t> delay_of(const Sequence& sequence, double alarm, std::uint32_t number) {
  random::NumberSource numbers = numbers_of(experiment_of(sequence), number);
  monitor::ChangeTest test = test_after_baseline(sequence, numbers);
  for (std::int64_t t = 1; t <= sequence.moves; ++t) {
    test.update(move_value(sequence.kind, numbers, t >= sequence.change ? sequence.factor : 1.0));
    if (test.martingale().capital() >= alarm) return t - sequence.change + 1;
  }
  return std::nullopt;
}

std::string log_text(std::string_view head, const std::vector<double>& values) {
  std::string text = fmt::format("{}\n", head);
  for (const double value : values) text += fmt::format("{}\n", value);
  return text;
}

monitor::MoveLog log_of(std::string_view text, std::string name, std::string group) {
  monitor::MoveLog log(std::move(name), std::move(group));
  log.read_last(text.substr(log.read(text)));
  return log;
}

std::vector<double> times_of_days(const Days& days, std::int64_t count, double factor,
                                  random::NumberSource& numbers) {
  constexpr double spread = 0.25;
  std::vector<double> times;
  for (std::int64_t day = 0; day < count; ++day) {
    const double shared = std::sqrt(days.correlation) * numbers.normal();
    for (std::int64_t i = 0; i < days.moves; ++i)
      times.push_back(0.05 * factor *
                      std::exp(spread * (shared + std::sqrt(1.0 - days.correlation) * numbers.normal())));
  }
  return times;
}

std::string log_of_days(const std::vector<double>& times, std::int64_t moves, std::int64_t first) {
  std::string text = "arrival_time,day\n";
  for (std::size_t i = 0; i < times.size(); ++i)
    text += fmt::format("{},{}\n", times[i], first + static_cast<std::int64_t>(i) / moves);
  return text;
}

monitor::MachineMonitor monitor_of_days(const Days& days, const monitor::MonitorSettings& settings,
                                        std::uint32_t number) {
  random::NumberSource numbers =
      numbers_of(fmt::format("days.{}.{}", days.correlation, days.baseline), number);
  const std::vector<double> before = times_of_days(days, days.baseline, 1.0, numbers);
  const std::vector<double> after = times_of_days(days, days.days, days.factor, numbers);
  const monitor::MoveLog log =
      log_of(log_of_days(after, days.moves, days.baseline), "moves.csv", settings.group);
  monitor::MachineMonitor machine(
      monitor::baseline_of(log_of(log_of_days(before, days.moves, 0), "baseline.csv", settings.group)), log,
      settings);
  machine.update(log);
  return machine;
}

}  // namespace zerocount::testing
