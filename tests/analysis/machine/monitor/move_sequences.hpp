#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/machine/monitor/change_test.hpp"
#include "analysis/machine/monitor/machine_monitor.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::testing {

/// Distribution of the simulated measure of a move: lognormal, lognormal in coarse steps, or 0 and 1.
enum class Moves { lognormal, tied, binary };
std::string_view name_of(Moves kind);

/// A random value of a move's measure. `lognormal`: median 0.05, logarithmic standard deviation 0.25; `tied`:
/// the lognormal value in steps of 0.02; `binary`: 1 with the probability 0.95, otherwise 0.
/// @param factor factor of the value, or of the probability of `binary`
double move_value(Moves kind, random::NumberSource& numbers, double factor = 1.0);

/// The source of random numbers for sequence `number` of an experiment, always the same for the same
/// arguments.
random::NumberSource numbers_of(std::string_view experiment, std::uint32_t number);

struct Sequence {
  Moves kind{Moves::lognormal};
  std::int64_t baseline{200};
  std::int64_t moves{10'000};  ///< maximum number of moves after the baseline
  std::int64_t change{0};      ///< number of the first changed move, from 1; 0: no move is changed
  double factor{1.0};          ///< factor of the changed moves' values, or of their probability
};

/// The largest capital (evidence of the change test, a test martingale that starts at 1) within sequence
/// `number`.
double largest_capital(const Sequence& sequence, std::uint32_t number);

/// Number of moves from the change until the capital of the change test reaches `alarm`. Empty if it never
/// does; 0 or less if it does before the change.
std::optional<std::int64_t> delay_of(const Sequence& sequence, double alarm, std::uint32_t number);

/// Text of a log of moves with one measure: the line `head`, then one value per line.
std::string log_text(std::string_view head, const std::vector<double>& values);
monitor::MoveLog log_of(std::string_view text, std::string name = "moves.csv", std::string group = {});

/// Parameters of simulated days of moves with lognormal settling times (coefficient of variation 25 %). The
/// effect of the day contributes the fraction `correlation` of the variance of the logarithms.
struct Days {
  std::int64_t baseline{20};
  std::int64_t days{60};
  std::int64_t moves{50};  ///< number of moves per day
  double correlation{0.0};
  double factor{1.0};  ///< factor of the settling times after the baseline; 1: no change
};
/// The settling times (s) of `count` simulated days, in the order of the moves.
std::vector<double> times_of_days(const Days& days, std::int64_t count, double factor,
                                  random::NumberSource& numbers);
/// Text of a log with the columns `arrival_time` and `day`, with `moves` moves per day. The days are numbered
/// from `first`.
std::string log_of_days(const std::vector<double>& times, std::int64_t moves, std::int64_t first);

/// A monitor that has seen all moves of sequence `number` of simulated days.
monitor::MachineMonitor monitor_of_days(const Days& days, const monitor::MonitorSettings& settings,
                                        std::uint32_t number);

}  // namespace zerocount::testing
