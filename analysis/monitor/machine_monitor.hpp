#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/monitor/change_test.hpp"
#include "analysis/monitor/detection_delay.hpp"
#include "analysis/monitor/monitor_baseline.hpp"
#include "analysis/monitor/move_log.hpp"

namespace zerocount::monitor {

struct MonitorSettings {
  double alarm{0.001};                  ///< probability of a false alarm, within any number of moves
  std::optional<double> change{};       ///< to be seen for `unchanged`; see change_to_see()
  std::int64_t block{1};                ///< consecutive moves that make one value
  std::uint64_t seed{1};                ///< of ties and of simulated changes
  std::vector<std::string> measures{};  ///< to watch; empty: all that both sides have
};

/// Whether successive values correlate more than independent ones do, at a significance of 0.0005.
bool are_dependent(double correlation, std::size_t values);

enum class MachineStatus { changed, unchanged, undecided };

/// What is known of one measure.
struct MeasureState {
  MonitoredMeasure measure;
  std::string unit;
  double evidence{1.0};  ///< largest capital until now, as a proportion of the number of measures
  std::optional<Direction> direction{};    ///< of the change, with an alarm
  std::optional<std::int64_t> alarm_at{};  ///< move, from 1
  std::optional<std::int64_t> since{};     ///< move, from 1
  double baseline_median{0.0};             ///< of a quality the mean; infinite: never
  std::optional<double> median{};          ///< likewise of the moves since `since`, or of all
  /// serial_correlation() of the values of a measured baseline.
  std::optional<double> correlation{};
  ChangeToSee to_see{};
  std::optional<std::int64_t>
      seen_after{};  ///< moves after which `to_see` would have been seen, at most `moves`
};

struct MonitorState {
  MachineStatus status{MachineStatus::undecided};
  const MeasureState* alarm{nullptr};  ///< the measure that gave the first alarm
  double evidence{0.0};                ///< largest of all measures; the alarm is at 1/alarm
  std::int64_t moves{0};
};

/// Watches the moves of one machine: a ChangeTest for each measure. With K measures the alarm of each is at
/// the capital K/alarm, so that the sum of their false alarms is bounded, whatever the measures have to do
/// with each other. (The mean of their capitals would not do: each is a martingale of its own p-values only.)
class MachineMonitor {
 public:
  /// @param log has its header
  /// @throws Failure (bad_input) if no measure is on both sides, or their units have different dimensions
  MachineMonitor(const Baseline& baseline, const MoveLog& log, MonitorSettings settings);

  /// Takes the moves of the log that are new.
  void update(const MoveLog& log);

  /// The state after these moves. Simulates the changes to be seen where that decides.
  MonitorState state();

  const std::vector<MeasureState>& measures() const { return states_; }
  /// Measures of which successive values of the baseline correlate: they are not exchangeable.
  std::vector<std::string> dependent() const;
  const MonitorSettings& settings() const { return settings_; }
  /// Columns of the log that nothing is compared with.
  const std::vector<std::string>& unused() const { return unused_; }

 private:
  struct Watched {
    ChangeTest test;
    std::vector<double> p_values{};  ///< until the alarm
    std::vector<double> baseline;    ///< sorted
    std::vector<double> values{};    ///< those of moves, or blocks
    /// [direction] values_to_see(), and the limit that it was asked with.
    std::map<Direction, std::optional<std::int64_t>> seen{};
    std::int64_t seen_limit{0};
  };

  void add(const Baseline& baseline, const Baseline::Column& before, const MoveLog::Column& column);
  void update_measure(std::size_t number, double value);
  void simulate_changes(std::int64_t values);
  bool is_unchanged(std::int64_t values);
  double alarm_capital() const { return static_cast<double>(states_.size()) / settings_.alarm; }

  MonitorSettings settings_;
  std::vector<std::string> unused_{};
  std::vector<MeasureState> states_{};
  std::vector<Watched> watched_{};  ///< [measure]
  std::int64_t moves_{0};
};

}  // namespace zerocount::monitor
