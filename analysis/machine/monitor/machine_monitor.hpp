#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/machine/monitor/change_test.hpp"
#include "analysis/machine/monitor/monitor_baseline.hpp"
#include "analysis/machine/monitor/move_log.hpp"
#include "analysis/machine/monitor/parameter_change.hpp"

namespace zerocount::monitor {

/// Change of a measure that must be excluded before the machine counts as unchanged. It is excluded when a
/// change of this size would have given an alarm with a probability of 90 %.
struct ChangeToSee {
  /// [class of similar moves] Size of the change in the unit of the values; 0 if no change can be stated for
  /// the class, such as with a median of 0 (see change_to_see()).
  std::vector<double> sizes{};
  /// Directions in which every class with a size above 0 can change by it; empty: the measure is not judged.
  std::vector<Direction> directions{};
};

/// Chooses the change to be seen. Its size in a class is `change` times the magnitude of the class's median
/// in the baseline, by default 0.2 times. A proportion changes by the amount `change`, by default 0.1. A
/// direction is possible if the measure can have the changed median.
///
/// A class has no scale if its median is infinite, or if no direction is possible. If the measure is not a
/// proportion, a class also has no scale if its median is 0, or if its values have both signs. The measure is
/// judged by the classes that have a scale.
/// @param baseline [class of similar moves] values of the measure in the baseline
/// @param change relative size of the change, for a proportion its amount; nothing: the default
ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const std::vector<double>> baseline,
                          std::optional<double> change);

/// How a change of the machine acts on the values of a measure.
enum class ChangeForm {
  shift,  ///< The size of the change is added to each value, or subtracted for a change to lower values.
  /// Each value is multiplied by one number per class, which moves the median of the class by the size of the
  /// change.
  factor
};

/// Forms of change that are simulated for the measure: both, or only the shift for a proportion.
std::span<const ChangeForm> forms_of(const MonitoredMeasure& measure);

/// The question for values_to_see(): after how many values is a change of a measure seen?
struct DelayQuestion {
  const MonitoredMeasure& measure;
  /// [class of similar moves] Values of the measure in the baseline, sorted.
  std::span<const std::vector<double>> baseline;
  Direction direction;
  ChangeForm form;
  /// [class of similar moves] Size of the change in the unit of the values. The change is present from the
  /// first value on.
  std::span<const double> sizes;
  double alarm;  ///< Capital of the change test (ChangeMartingale) at which the change counts as seen.
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
  /// Number of consecutive moves that are combined to one value of a measure, which the change test ranks.
  std::int64_t block{1};
  /// Name of the column whose equal successive cells form a group of moves; each group makes one value.
  /// Empty: no groups.
  std::string group{};
  std::uint64_t seed{1};  ///< Seed for ties, simulated changes and random orders.
  /// Names of the measures to watch; empty: all measures that the baseline and the log have, except those
  /// that grow from move to move.
  std::vector<std::string> measures{};
};

enum class MachineStatus { changed, unchanged, undecided };

/// Medians of a measure for one class of similar moves, in the baseline and in the log.
struct LikeValue {
  std::string measure;
  std::string like;  ///< Name of the class of similar moves: "move 3", "target 20 count upwards".
  /// Median of the class in the baseline; infinite: in most moves the event never came.
  double baseline{0.0};
  std::int64_t baseline_moves{0};  ///< Number of moves of the class in the baseline.
  /// Median of the class in the log, since the change if there is an alarm; nothing if it has no such moves.
  std::optional<double> median{};
  std::int64_t moves{0};  ///< Number of moves of the class in the log, since the change if there is an alarm.
};

/// Result of monitoring one measure: evidence, alarm, medians and the tests of the assumptions.
struct MeasureState {
  MonitoredMeasure measure;
  std::string unit;
  /// Largest capital of the measure's change test so far, divided by the number of measures.
  double evidence{1.0};
  std::optional<Direction> direction{};    ///< Direction of the change; nothing without an alarm.
  std::optional<std::int64_t> alarm_at{};  ///< Move that gave the alarm, from 1; nothing without an alarm.
  /// Estimated first move of the change, from 1; nothing without an alarm.
  std::optional<std::int64_t> since{};
  /// Median of the measure in the baseline; for a yes-or-no measure, the proportion of moves with a yes.
  /// Infinite: in most moves the event never came. Nothing if the classes of similar moves differ so much
  /// that the distribution has several peaks; `by_like` then has the medians.
  std::optional<double> baseline_median{};
  /// Median of the measure in the log; for a yes-or-no measure, the proportion of moves with a yes. It covers
  /// the moves from `since` on, or all moves without an alarm. Nothing without such moves, or if `by_like`
  /// has the medians.
  std::optional<double> median{};
  /// Medians for each class of similar moves. Empty for a yes-or-no measure, and if the differences between
  /// classes explain less than half of the variance of the values' ranks.
  std::vector<LikeValue> by_like{};
  /// serial_correlation() of the values of a measured baseline. With several classes, each value counts by
  /// its rank within its class. Nothing for a simulated baseline.
  std::optional<double> correlation{};
  /// Test whether the values of a measured baseline are exchangeable, as the change test assumes.
  Dependence dependence{};
  ChangeToSee to_see{};
  /// Number of moves after which the change `to_see` would have been seen with a probability of 90 %, in the
  /// slowest of its directions and forms. Nothing if the log does not have as many moves yet, or if the
  /// status was not asked for.
  std::optional<std::int64_t> seen_after{};
};

/// Reason why a measure of the baseline or of the log is not watched, or why a label is not used.
enum class WhyUnwatched {
  missing,          ///< The log of the machine lacks a column that the baseline has.
  not_in_baseline,  ///< The baseline lacks a column that the log of the machine has.
  /// The value grows from move to move (state of the friction), and the settings do not name the measure.
  accumulates
};

/// A measure that is not watched, or a label column (`move`, `target`) that is not used, with the reason.
struct UnwatchedMeasure {
  std::string measure;
  WhyUnwatched why;
  /// Column with a resembling name on the side that lacks the measure; nothing if there is none.
  std::optional<std::string> near{};
};

struct MonitorState {
  MachineStatus status{MachineStatus::undecided};
  const MeasureState* alarm{nullptr};  ///< Measure that gave the first alarm; null without an alarm.
  /// Largest evidence of all measures (MeasureState::evidence); at 1/MonitorSettings::alarm there is an
  /// alarm.
  double evidence{0.0};
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
  /// Number of values of the log that were compared. A value is one move, a block of moves or a group of
  /// moves.
  std::int64_t values() const { return std::ssize(units_); }
  std::int64_t baseline_values() const { return std::ssize(baseline_ends_); }
  /// Number of moves of the log that are not compared because the baseline has no moves with the same label.
  std::int64_t unlike() const { return unlike_; }
  /// Name of the class of similar moves of the first move counted by unlike(), such as "move 3"; empty if
  /// none is.
  const std::string& first_unlike() const { return first_unlike_; }
  /// Number of moves that are not compared because they continue the last group of the baseline.
  std::int64_t continued() const { return continued_; }
  const MonitorSettings& settings() const { return settings_; }
  /// Heads of the columns of the log that have no use: they are not watched, not a label (`move`, `target`)
  /// by which moves are compared, and not the group. If the settings name measures, the other measures that
  /// both the baseline and the log have are not listed.
  const std::vector<std::string>& unused() const { return unused_; }
  /// Measures that only the baseline or only the log has, or that accumulate, so that they are not watched;
  /// empty if the settings name measures.
  const std::vector<UnwatchedMeasure>& unwatched() const { return unwatched_; }
  /// The label columns `move` and `target` if only one side has them. Moves are then compared without this
  /// label. A simulated study has both labels; beside it, a label is listed only if the log has the column in
  /// another letter case.
  const std::vector<UnwatchedMeasure>& unused_labels() const { return unused_labels_; }

 private:
  /// A watched measure with its change test, and what the test has shown so far.
  struct Watched {
    ChangeTest test;
    /// p-values of the log's values until the alarm, in their order; empty after the alarm.
    std::vector<double> p_values{};
    /// [class of similar moves] Values of the measure in the baseline, sorted.
    std::vector<std::vector<double>> baseline;
    /// [direction, form] Number of values after which such a change would be seen (values_to_see()); nothing:
    /// more than `seen_limit`.
    std::map<std::pair<Direction, ChangeForm>, std::optional<std::int64_t>> seen{};
    /// Largest number of values with which changes were simulated (`max_values` of values_to_see()); 0: none
    /// were.
    std::int64_t seen_limit{0};
  };
  /// First and last move of one value, as indices in the log.
  struct Unit {
    std::int64_t first;
    std::int64_t last;
  };

  /// Columns of one measure: first in the baseline, second in the log.
  using Pair = std::pair<const MoveLog::Column*, const MoveLog::Column*>;
  /// Pairs of columns, in the baseline and in the log, of the measures to watch. Also stores the heads of the
  /// log's other measures in `unused_`.
  std::vector<Pair> common_columns(const Baseline& baseline, const MoveLog& log);
  /// Fills `unwatched_`: the measures that are not watched, each with the reason.
  /// @param common columns of the measures that are watched
  void note_unwatched(const Baseline& baseline, const MoveLog& log, const std::vector<Pair>& common);
  /// Begins to watch a measure.
  /// @param before column of the baseline
  /// @param column column of the log
  /// @returns the values of the baseline (one for each move, block or group), in their order
  std::vector<double> add(const MoveLog::Column& before, const MoveLog::Column& column);
  /// Tests whether the values of a measured baseline are exchangeable, for each measure.
  /// @param values [measure][value]
  void test_dependence(const std::vector<std::vector<double>>& values);
  /// [measure][move of the log] Values of the watched measures, by pointers to the columns of the log.
  using Columns = std::vector<const std::vector<double>*>;
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
  /// [value of the baseline] Index one past the last move of the value. A value is one move, a block or a
  /// group.
  std::vector<std::size_t> baseline_ends_;
  Likes likes_;
  /// Indices of the classes of values. A value of several moves belongs to the class given by the key: the
  /// sorted, distinct classes of similar moves among its moves (set_of()).
  std::map<std::vector<std::size_t>, std::size_t> classes_{};
  std::vector<std::size_t> baseline_classes_{};  ///< [value of the baseline] Class of the value.
  std::string last_group_{};                     ///< Last group of the baseline; empty without groups.
  std::vector<MeasureState> states_{};
  /// [watched measure] The change test that watches this measure, and its state.
  std::vector<Watched> watched_{};
  std::vector<Unit> units_{};  ///< [value of the log] First and last move of each value that was compared.
  /// Moves collected for the value that is not complete yet, as indices in the log.
  std::vector<std::size_t> open_{};
  /// [move of open_] Index of the class of similar moves to which the move belongs.
  std::vector<std::size_t> open_likes_{};
  /// [move of the log] Index of the class of similar moves; nothing if the baseline has no move like it, so
  /// that it is not compared.
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
  std::string log{};  ///< Name of the file with the moves of the monitored machine.
  /// Explanation of the alarm: the parameters of the simulated study that may have changed. Null if none was
  /// computed.
  const ChangeExplanation* explanation{nullptr};
  /// Number of moves at the beginning of the log that equal the measured baseline's first moves, so that the
  /// log probably contains the baseline (equal_moves()).
  std::int64_t repeated{0};
};

document::AnswerDescription<MonitorResult> monitor_answer();

/// Exit code of a status: ExitCode::regression for changed, success for unchanged, inconclusive for
/// undecided.
ExitCode exit_code_of(MachineStatus status);

}  // namespace zerocount::monitor
