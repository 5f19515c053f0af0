#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/monitor/change_test.hpp"
#include "analysis/monitor/machine_monitor.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::testing {

/// Distribution of the values of moves.
enum class Moves { lognormal, tied, binary };
std::string_view name_of(Moves kind);

/// A random value. `lognormal`: median 0.05, logarithmic standard deviation 0.25; `tied`: the lognormal value
/// in steps of 0.02; `binary`: 1 with the probability 0.95, otherwise 0.
/// @param factor factor of the value, or of the probability of `binary`
double move_value(Moves kind, random::NumberSource& numbers, double factor = 1.0);

/// The numbers of sequence `number` of an experiment.
random::NumberSource numbers_of(std::string_view experiment, std::uint32_t number);

struct Sequence {
  Moves kind{Moves::lognormal};
  std::int64_t baseline{200};
  std::int64_t moves{10'000};  ///< maximum number of moves
  std::int64_t change{0};      ///< first changed move, from 1; 0: none
  double factor{1.0};          ///< factor of the changed moves' values, or of their probability
};

/// The largest capital within the sequence.
double largest_capital(const Sequence& sequence, std::uint32_t number);

/// Number of moves from the change until the capital reaches `alarm`. Empty if it never does; 0 or less if it
/// does before the change.
std::optional<std::int64_t> delay_of(const Sequence& sequence, double alarm, std::uint32_t number);

/// Text of a log of one measure.
std::string log_text(std::string_view head, const std::vector<double>& values);
monitor::MoveLog log_of(std::string_view text, std::string name = "moves.csv", std::string group = {});

/// Days of moves with lognormal settling times (coefficient of variation 25 %). The effect of the day
/// contributes the fraction `correlation` of the variance of the logarithms.
struct Days {
  std::int64_t baseline{20};
  std::int64_t days{60};
  std::int64_t moves{50};  ///< number of moves per day
  double correlation{0.0};
  double factor{1.0};  ///< factor of the times after the baseline
};
/// The settling times of `count` days, move after move.
std::vector<double> times_of_days(const Days& days, std::int64_t count, double factor,
                                  random::NumberSource& numbers);
/// A log with the columns `arrival_time` and `day`. The days are numbered from `first`.
std::string log_of_days(const std::vector<double>& times, std::int64_t moves, std::int64_t first);

/// The monitor after all moves of sequence `number` of days.
monitor::MachineMonitor monitor_of_days(const Days& days, const monitor::MonitorSettings& settings,
                                        std::uint32_t number);

}  // namespace zerocount::testing
