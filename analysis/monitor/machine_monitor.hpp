#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/monitor/change_test.hpp"
#include "analysis/monitor/monitor_baseline.hpp"
#include "analysis/monitor/move_log.hpp"
#include "analysis/monitor/parameter_change.hpp"

namespace zerocount::monitor {

/// Change of a measure that must be excluded before the machine counts as unchanged. It is excluded when a
/// change of this size would have given an alarm with a probability of 90 %.
struct ChangeToSee {
  /// [class] Size of the change in the unit of the values; 0 if the class has no scale (change_to_see()).
  std::vector<double> sizes{};
  /// Directions in which all classes with a scale can change so much; empty: the measure is not judged.
  std::vector<Direction> directions{};
};

/// Chooses the change to be seen. Its size in a class is `change` times the magnitude of the class's median
/// in the baseline, by default 0.2 times. A proportion changes by the amount `change`, by default 0.1. A
/// direction is possible if the measure can have the changed median.
///
/// A class has no scale if its median is infinite, or if no direction is possible. If the measure is not a
/// proportion, a class also has no scale if its median is 0, or if its values have both signs. The measure is
/// judged by the classes that have a scale.
/// @param baseline [class] Values of the baseline.
ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const std::vector<double>> baseline,
                          std::optional<double> change);

/// How a change of the machine acts on the values of a measure.
enum class ChangeForm {
  shift,  ///< The size is added to each value.
  factor  ///< Each value is multiplied by the number that changes the median of its class by the size.
};

/// Forms of change that are simulated for the measure: both, or only the shift for a proportion.
std::span<const ChangeForm> forms_of(const MonitoredMeasure& measure);

/// Arguments of values_to_see().
struct DelayQuestion {
  const MonitoredMeasure& measure;
  std::span<const std::vector<double>> baseline;  ///< [class] Values of the baseline, sorted.
  Direction direction;
  ChangeForm form;
  std::span<const double> sizes;  ///< [class] Size of the change, which is present from the first value on.
  double alarm;                   ///< Capital at which the change counts as seen.
  std::int64_t max_values;
  std::uint64_t seed;
};

/// Number of values after which the change is seen with a probability of 90 %; nothing if it exceeds
/// `max_values`.
///
/// The number is estimated from 200 simulated sequences: at most 12 of them need more values. If the
/// probability of seeing the change within this number were less than 90 %, so few would need more with a
/// probability of at most 3 %. Each sequence has a baseline that is resampled class by class from the given
/// one (about 5000 values, if the given one has more). Its later values are drawn from the given baseline,
/// each class as often as it occurs there, and are changed.
std::optional<std::int64_t> values_to_see(const DelayQuestion& question);

struct MonitorSettings {
  double alarm{0.001};  ///< Largest probability of a false alarm within any number of moves.
  /// Size of the change to be seen before the machine is `unchanged`; nothing: default of change_to_see().
  std::optional<double> change{};
  std::int64_t block{1};  ///< Number of consecutive moves that make one value.
  std::string group{};    ///< Column of the groups of moves, each of which makes one value; empty: none.
  std::uint64_t seed{1};  ///< Seed for ties, simulated changes and random orders.
  /// Names of the measures to watch; empty: all that both sides have and that do not accumulate.
  std::vector<std::string> measures{};
};

enum class MachineStatus { changed, unchanged, undecided };

/// Medians of a measure for one class of similar moves.
struct LikeValue {
  std::string measure;
  std::string like;                ///< Name of the class: "move 3", "target 20 count upwards".
  double baseline{0.0};            ///< Median of the class in the baseline; infinite: never.
  std::int64_t baseline_moves{0};  ///< Number of moves of the class in the baseline.
  /// Median of the class in the log, since the change if there is an alarm; nothing if it has no such moves.
  std::optional<double> median{};
  std::int64_t moves{0};  ///< Number of moves of the class in the log, since the change if there is an alarm.
};

/// State of one watched measure.
struct MeasureState {
  MonitoredMeasure measure;
  std::string unit;
  double evidence{1.0};                    ///< Largest capital so far, divided by the number of measures.
  std::optional<Direction> direction{};    ///< Direction of the change; nothing without an alarm.
  std::optional<std::int64_t> alarm_at{};  ///< Move that gave the alarm, from 1; nothing without an alarm.
  /// Estimated first move of the change, from 1; nothing without an alarm.
  std::optional<std::int64_t> since{};
  /// Median of the baseline; for a quality, the proportion of moves that have it. Infinite: never. Nothing if
  /// the distribution has several peaks, one for each class of moves; `by_like` then has the medians.
  std::optional<double> baseline_median{};
  /// Median of the log; for a quality, the proportion of moves that have it. It covers the moves from `since`
  /// on, or all moves without an alarm. Nothing without such moves, or if `by_like` has the medians.
  std::optional<double> median{};
  /// Medians of the classes of moves. Empty for a quality, and if the classes explain less than half of the
  /// variance of the ranks.
  std::vector<LikeValue> by_like{};
  /// serial_correlation() of the values of a measured baseline. With several classes, each value counts by
  /// its rank within its class. Nothing for a simulated baseline.
  std::optional<double> correlation{};
  Dependence dependence{};  ///< Test of the values of a measured baseline for exchangeability.
  ChangeToSee to_see{};
  /// Number of moves after which the change `to_see` would have been seen with a probability of 90 %, in each
  /// of its directions and forms. Nothing if there are not yet as many moves, or if this was not asked.
  std::optional<std::int64_t> seen_after{};
};

/// Reason why a measure of the baseline or of the log is not watched, or why a label is not used.
enum class WhyUnwatched {
  missing,          ///< The log has no such column.
  not_in_baseline,  ///< The baseline has no such column.
  accumulates       ///< The measure grows from move to move, and the settings do not name it.
};

/// A measure that is not watched, or a label that is not used.
struct UnwatchedMeasure {
  std::string measure;
  WhyUnwatched why;
  /// Column with a resembling name on the side that lacks the measure; nothing if there is none.
  std::optional<std::string> near{};
};

struct MonitorState {
  MachineStatus status{MachineStatus::undecided};
  const MeasureState* alarm{nullptr};  ///< Measure that gave the first alarm; null without an alarm.
  double evidence{0.0};   ///< Largest evidence of all measures; 1/MonitorSettings::alarm gives an alarm.
  std::int64_t moves{0};  ///< Number of moves taken from the log.
};

/// Watches the moves of one machine with a ChangeTest for each measure. With K measures, each gives an alarm
/// at the capital K/alarm. The probability of a false alarm of each measure is then at most alarm/K, and that
/// of any false alarm at most `alarm`, however the measures depend on each other. (The mean capital of the
/// measures would not give this bound: each capital is a martingale for the p-values of its own measure
/// only.)
///
/// A value belongs to one move, to `block` consecutive moves or to a group of moves. It is ranked among the
/// values of its class (Likes). The bound holds if the values of each class are exchangeable.
///
/// Moves of one day resemble each other and are not exchangeable, but the days may be. If groups of moves are
/// exchangeable, any function of a group, such as its median, is exchangeable too. The p-value of a group
/// among the groups before it is then valid, however the moves within a group depend on each other. Single
/// moves of a group are not ranked, because all their p-values would depend on what the group has in common.
class MachineMonitor {
 public:
  /// @param log log whose header has been read
  /// @throws Failure: bad_input if there is no measure to compare, if the baseline or the log lacks a measure
  /// that the settings name, or if a measure or the targets have units of different dimensions; bad_data if
  /// the baseline has fewer moves than a block
  MachineMonitor(const Baseline& baseline, const MoveLog& log, MonitorSettings settings);

  /// Takes the moves that were added to the log since the last call.
  void update(const MoveLog& log);

  /// The state after the moves taken so far. Without an alarm, it simulates the changes to be seen, on which
  /// the status then depends.
  MonitorState state();

  const std::vector<MeasureState>& measures() const { return states_; }
  /// Measures whose values in the baseline are not exchangeable. The significance level of each of K measures
  /// is 0.01 or, if that is larger, 0.05/K.
  std::vector<const MeasureState*> dependent() const;
  const Likes& likes() const { return likes_; }
  /// Number of values of the log that were compared.
  std::int64_t values() const { return std::ssize(units_); }
  std::int64_t baseline_values() const { return std::ssize(baseline_ends_); }
  /// Number of moves that are not compared because the baseline has no moves like them.
  std::int64_t unlike() const { return unlike_; }
  /// Name of the class of the first move that unlike() counts, such as "move 3"; empty if there is none.
  const std::string& first_unlike() const { return first_unlike_; }
  /// Number of moves that are not compared because they continue the last group of the baseline.
  std::int64_t continued() const { return continued_; }
  const MonitorSettings& settings() const { return settings_; }
  /// Columns of the log that are neither watched, nor labels (`move`, `target`) by which moves are compared,
  /// nor the group. If the settings name measures, the other measures that both sides have are not listed.
  const std::vector<std::string>& unused() const { return unused_; }
  /// Measures of either side that are not watched; empty if the settings name measures.
  const std::vector<UnwatchedMeasure>& unwatched() const { return unwatched_; }
  /// The label columns `move` and `target` if only one side has them. Moves are then compared without this
  /// label. A simulated study has both labels; beside it, a label is listed only if the log has the column in
  /// another letter case.
  const std::vector<UnwatchedMeasure>& unused_labels() const { return unused_labels_; }

 private:
  /// Test of one watched measure.
  struct Watched {
    ChangeTest test;
    std::vector<double> p_values{};             ///< p-values of the values until the alarm; empty after it.
    std::vector<std::vector<double>> baseline;  ///< [class of values] Values of the baseline, sorted.
    /// Results of values_to_see() for each change; nothing: not seen within `seen_limit` values.
    std::map<std::pair<Direction, ChangeForm>, std::optional<std::int64_t>> seen{};
    std::int64_t seen_limit{0};  ///< Largest `max_values` with which changes were simulated; 0: none were.
  };
  /// First and last move of one value, as indices in the log.
  struct Unit {
    std::int64_t first;
    std::int64_t last;
  };

  /// Columns of a measure in the baseline and in the log.
  using Pair = std::pair<const MoveLog::Column*, const MoveLog::Column*>;
  /// Columns of the measures that are watched. Notes the other measures of the log in `unused_`.
  std::vector<Pair> common_columns(const Baseline& baseline, const MoveLog& log);
  /// Fills `unwatched_`. @param common columns of the measures that are watched
  void note_unwatched(const Baseline& baseline, const MoveLog& log, const std::vector<Pair>& common);
  /// Begins to watch a measure. @param before column of the baseline @param column column of the log
  /// @returns the values of the baseline, in their order
  std::vector<double> add(const MoveLog::Column& before, const MoveLog::Column& column);
  /// Tests the values of a measured baseline for exchangeability. @param values [measure][value]
  void test_dependence(const std::vector<std::vector<double>>& values);
  using Columns = std::vector<const std::vector<double>*>;  ///< [measure][move of the log] Values.
  void take_move(const MoveLog& log, const Columns& columns, std::size_t move);
  void finish_unit(const Columns& columns);
  void update_measure(std::size_t number, std::size_t of_class, double value);
  void update_median(MeasureState& state, const MoveLog& log);
  void simulate_changes(std::int64_t values);
  bool is_unchanged(std::int64_t values);
  double alarm_capital() const { return static_cast<double>(states_.size()) / settings_.alarm; }

  MonitorSettings settings_;
  std::vector<std::string> unused_{};
  std::vector<UnwatchedMeasure> unwatched_{};
  std::vector<UnwatchedMeasure> unused_labels_{};
  std::vector<std::size_t> baseline_ends_;  ///< [value of the baseline] One past the last move of the value.
  Likes likes_;
  /// Classes of values. The key is the set of classes of the value's moves (set_of()).
  std::map<std::vector<std::size_t>, std::size_t> classes_{};
  std::vector<std::size_t> baseline_classes_{};  ///< [value of the baseline] Class of the value.
  std::string last_group_{};                     ///< Last group of the baseline; empty without groups.
  std::vector<MeasureState> states_{};
  std::vector<Watched> watched_{};   ///< [measure] The tests that watch the measure, and their state.
  std::vector<Unit> units_{};        ///< [value of the log] Moves of the values that were compared.
  std::vector<std::size_t> open_{};  ///< Moves of the value that is not complete yet, as indices in the log.
  std::vector<std::size_t> open_likes_{};  ///< [move of open_] Class of the move.
  /// [move of the log] Class of the move; nothing if the move is not compared.
  std::vector<std::optional<std::size_t>> like_at_{};
  bool continues_baseline_{true};  ///< With groups: true while the log continues the baseline's last group.
  std::string first_unlike_{};
  std::int64_t moves_{0};
  std::int64_t unlike_{0};
  std::int64_t continued_{0};
};

/// Everything that the answer of `monitor` describes: a monitored machine, its baseline and its state.
struct MonitorResult {
  const MachineMonitor& monitor;
  const Baseline& baseline;
  MonitorState state;
  std::string log{};  ///< Name of the file with the moves.
  /// Explanation of an alarm by changed parameters of the simulated study; null if there is none.
  const ChangeExplanation* explanation{nullptr};
  /// Number of moves with which both the log and a measured baseline begin (equal_moves()).
  std::int64_t repeated{0};
};

document::AnswerDescription<MonitorResult> monitor_answer();

/// Exit code of a status: regression if changed, success if unchanged, inconclusive if undecided.
ExitCode exit_code_of(MachineStatus status);

}  // namespace zerocount::monitor
