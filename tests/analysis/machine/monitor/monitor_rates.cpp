// Tables of docs/monitor.md: false alarms, and delays beside a test of fixed length.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/distributions.hpp"
#include "tests/analysis/machine/monitor/move_sequences.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t never = std::int64_t{1} << 50;

void print_false_alarms(std::uint32_t sequences) {
  fmt::print("alarms in {} sequences of 10000 moves\n\n", sequences);
  fmt::print("| values | baseline | 0.05 | 0.01 | 0.001 |\n| --- | --- | --- | --- | --- |\n");
  for (const Moves kind : {Moves::lognormal, Moves::tied, Moves::binary})
    for (const std::int64_t baseline : {20, 200, 2000}) {
      std::vector<double> largest(sequences);
      parallel::for_each_index(sequences, [&](std::size_t i) {
        largest[i] = largest_capital({.kind = kind, .baseline = baseline}, static_cast<std::uint32_t>(i));
      });
      const auto above = [&](double alarm) {
        return std::ranges::count_if(largest, [&](double capital) { return capital >= 1.0 / alarm; });
      };
      fmt::print("| {} | {} | {} | {} | {} |\n", name_of(kind), baseline, above(0.05), above(0.01),
                 above(0.001));
      std::fflush(stdout);
    }
}

/// The power of the two-sided Mann–Whitney test of `moves` changed moves against the baseline, estimated from
/// 400 pairs of samples.
double power_of_ranks(const Sequence& sequence, std::int64_t moves, double level) {
  constexpr std::uint32_t pairs = 400;
  const double critical = statistics::normal_quantile(1.0 - 0.5 * level);
  std::vector<char> found(pairs);
  parallel::for_each_index(pairs, [&](std::size_t pair) {
    random::NumberSource numbers =
        numbers_of(fmt::format("ranks.{}.{}", moves, sequence.factor), static_cast<std::uint32_t>(pair));
    std::vector<std::pair<double, bool>> all;
    for (std::int64_t i = 0; i < sequence.baseline; ++i)
      all.emplace_back(move_value(sequence.kind, numbers), false);
    for (std::int64_t i = 0; i < moves; ++i)
      all.emplace_back(move_value(sequence.kind, numbers, sequence.factor), true);
    std::ranges::sort(all);
    const auto n = static_cast<double>(all.size());
    double sum = 0.0;   // of the mid-ranks of the changed moves
    double ties = 0.0;  // Σ (g³ − g)
    for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
      std::size_t changed = 0;
      for (end = first; end < all.size() && all[end].first == all[first].first; ++end)
        changed += all[end].second ? 1 : 0;
      const auto group = static_cast<double>(end - first);
      sum += static_cast<double>(changed) * (static_cast<double>(first + end) + 1.0) / 2.0;
      ties += group * group * group - group;
    }
    const auto m = static_cast<double>(moves);
    const double variance = m * (n - m) / 12.0 * (n + 1.0 - ties / (n * (n - 1.0)));
    found[pair] = std::abs(sum - m * (n + 1.0) / 2.0) >= critical * std::sqrt(variance);
  });
  return static_cast<double>(std::ranges::count(found, 1)) / pairs;
}

/// Number of changed moves that a test with a fixed number of moves needs for this power.
std::int64_t moves_for_power(const Sequence& sequence, double power, double level) {
  std::int64_t low = 1;
  std::int64_t high = 2;
  while (power_of_ranks(sequence, high, level) < power) {
    if (high > 50'000) return never;
    low = high;
    high *= 2;
  }
  while (high - low > std::max<std::int64_t>(1, low / 50)) {
    const std::int64_t middle = (low + high) / 2;
    (power_of_ranks(sequence, middle, level) < power ? low : high) = middle;
  }
  return high;
}

std::string text_of(std::int64_t moves) {
  return moves >= never ? "–" : std::to_string(moves);
}

/// Text of the delays (moves from the change to the alarm) that 50 % and 90 % of the sequences do not exceed.
std::string delays_text(const Sequence& sequence, double alarm) {
  constexpr std::uint32_t sequences = 200;
  std::vector<std::int64_t> delays(sequences);
  parallel::for_each_index(sequences, [&](std::size_t i) {
    delays[i] = delay_of(sequence, 1.0 / alarm, static_cast<std::uint32_t>(i)).value_or(never);
  });
  std::ranges::sort(delays);
  return fmt::format("{}, {}", text_of(delays[sequences / 2 - 1]), text_of(delays[sequences * 9 / 10 - 1]));
}

void print_delays(Moves kind) {
  constexpr double alarm = 0.001;
  fmt::print("\n{}: moves from the change to the alarm, of 50 % and 90 %; --alarm {}\n\n", name_of(kind),
             alarm);
  fmt::print("| change | baseline | from move 1 | 1000 | 10000 | fixed length |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  for (const double factor : {0.95, 0.9, 0.8})
    for (const std::int64_t baseline : {50, 200, 2000}) {
      std::string row = fmt::format("| {:+.0f} % | {} |", (factor - 1.0) * 100.0, baseline);
      Sequence sequence{.kind = kind, .baseline = baseline, .moves = 0, .change = 1, .factor = factor};
      for (const std::int64_t change : {1, 1000, 10'000}) {
        sequence.change = change;
        sequence.moves = change + 20'000;
        row += fmt::format(" {} |", delays_text(sequence, alarm));
      }
      fmt::print("{} {}, {} |\n", row, text_of(moves_for_power(sequence, 0.5, alarm)),
                 text_of(moves_for_power(sequence, 0.9, alarm)));
      std::fflush(stdout);
    }
}

/// Prints a table about sequences of days: false alarms by move and by day, named baselines, and days until
/// an alarm.
void print_days() {
  constexpr std::uint32_t sequences = 200;
  fmt::print(
      "\ndays of 50 moves, {} sequences: false alarms in 60 days at --alarm 0.05 by move and by day; "
      "baselines named; days until 50 % and 90 % see +25 % at --alarm 0.05\n\n",
      sequences);
  fmt::print("| correlation | days of the baseline | by move | named | by day | +25 % seen by day after |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  for (const double correlation : {0.0, 0.05, 0.1, 0.3})
    for (const std::int64_t baseline : {6, 20}) {
      const Days days{.baseline = baseline, .correlation = correlation};
      Days changed = days;
      changed.factor = 1.25;
      std::vector<char> by_move(sequences), named(sequences), by_day(sequences);
      std::vector<std::int64_t> delays(sequences);
      parallel::for_each_index(sequences, [&](std::size_t i) {
        const auto number = static_cast<std::uint32_t>(i);
        const monitor::MachineMonitor moves = monitor_of_days(days, {.alarm = 0.05}, number);
        by_move[i] = moves.measures()[0].alarm_at.has_value();
        named[i] = !moves.dependent().empty();
        by_day[i] =
            monitor_of_days(days, {.alarm = 0.05, .group = "day"}, number).measures()[0].alarm_at.has_value();
        delays[i] = monitor_of_days(changed, {.alarm = 0.05, .group = "day"}, number)
                        .measures()[0]
                        .alarm_at.value_or(never * days.moves) /
                    days.moves;
      });
      std::ranges::sort(delays);
      fmt::print("| {} | {} | {} | {} | {} | {}, {} |\n", correlation, baseline,
                 std::ranges::count(by_move, 1), std::ranges::count(named, 1), std::ranges::count(by_day, 1),
                 text_of(delays[sequences / 2 - 1]), text_of(delays[sequences * 9 / 10 - 1]));
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace zerocount::testing

int main(int argc, char** argv) {
  using namespace zerocount::testing;
  const std::string what = argc > 1 ? argv[1] : "all";
  if (what == "all" || what == "days") print_days();
  if (what == "all" || what == "alarms")
    print_false_alarms(argc > 2 ? static_cast<std::uint32_t>(std::atoi(argv[2])) : 1000);
  if (what == "all" || what == "delays")
    for (const Moves kind : {Moves::lognormal, Moves::binary}) print_delays(kind);
}
