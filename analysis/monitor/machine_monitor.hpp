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

/// The change of a measure that its moves should show.
struct ChangeToSee {
  std::vector<double> sizes{};          ///< [class] in the unit of the values; 0 where it has no scale
  std::vector<Direction> directions{};  ///< that are possible; empty: the measure is not judged
};

/// A change by `change` times the baseline's median (default 0.2), or by `change` of a proportion (default
/// 0.1), in the directions in which the measure can change so much. A class has no scale if there is none,
/// its values have both signs, or its median is 0 or infinite; a measure is judged by the classes that have
/// one.
/// @param baseline [class] values
ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const std::vector<double>> baseline,
                          std::optional<double> change);

/// How the values of a changed machine differ from those before.
enum class ChangeForm {
  shift,  ///< The size is added to each value.
  factor  ///< Each value is multiplied by the number that changes the median of its class by the size.
};

/// The forms in which values of the measure can change. A proportion is changed by a shift alone.
std::span<const ChangeForm> forms_of(const MonitoredMeasure& measure);

struct DelayQuestion {
  const MonitoredMeasure& measure;
  std::span<const std::vector<double>> baseline;  ///< [class] sorted
  Direction direction;
  ChangeForm form;
  std::span<const double> sizes;  ///< [class] size of the change, which is there from the first value on
  double alarm;                   ///< capital at which the change is seen
  std::int64_t max_values;
  std::uint64_t seed;
};

/// The number of values after which the change is seen with a probability of 90 %, at most max_values;
/// nothing where it takes more. It is the number that at most 12 of 200 simulated sequences exceed: if the
/// probability were less than 90 %, so few would exceed it with a probability of 3 %. Each sequence
/// resamples the baseline (5000 of its values, if it has more) class by class, and takes later values from
/// it, of any class as often as it has them, with the change.
std::optional<std::int64_t> values_to_see(const DelayQuestion& question);

struct MonitorSettings {
  double alarm{0.001};                  ///< probability of a false alarm, within any number of moves
  std::optional<double> change{};       ///< to be seen for `unchanged`; see change_to_see()
  std::int64_t block{1};                ///< consecutive moves that make one value
  std::string group{};                  ///< column of the groups that make one value each; empty: none
  std::uint64_t seed{1};                ///< of ties and of simulated changes
  std::vector<std::string> measures{};  ///< to watch; empty: all that both sides have
};

enum class MachineStatus { changed, unchanged, undecided };

/// A measure of the moves that are like each other.
struct LikeValue {
  std::string measure;
  std::string like;      ///< "move 3", "target 20 count upwards"
  double baseline{0.0};  ///< median of the baseline; infinite: never
  std::int64_t baseline_moves{0};
  std::optional<double> median{};  ///< of the moves since the change, or of all
  std::int64_t moves{0};           ///< of which that is
};

/// What is known of one measure.
struct MeasureState {
  MonitoredMeasure measure;
  std::string unit;
  double evidence{1.0};  ///< largest capital until now, as a proportion of the number of measures
  std::optional<Direction> direction{};    ///< of the change, with an alarm
  std::optional<std::int64_t> alarm_at{};  ///< move, from 1
  std::optional<std::int64_t> since{};     ///< move, from 1
  /// The mean for a quality. Infinite: never. Nothing where the kinds of moves make several peaks (by_like).
  std::optional<double> baseline_median{};
  std::optional<double> median{};    ///< likewise of the moves since `since`, or of all
  std::vector<LikeValue> by_like{};  ///< where likes explain at least half of the variance of the ranks
  /// serial_correlation() of the values of a measured baseline, each by its rank among its like.
  std::optional<double> correlation{};
  Dependence dependence{};  ///< of the values of a measured baseline
  ChangeToSee to_see{};
  /// Number of moves after which `to_see` would have been seen with 90 % in each direction and form. Nothing
  /// where it is more than `moves`.
  std::optional<std::int64_t> seen_after{};
};

/// Why a measure of the baseline, or of the moves, is not watched, or a label not used.
enum class WhyUnwatched {
  missing,          ///< the moves have no such column
  not_in_baseline,  ///< the baseline has no such column
  accumulates       ///< it grows from move to move, and is not named in the settings
};

struct UnwatchedMeasure {
  std::string measure;
  WhyUnwatched why;
  /// Column of the side without the measure whose name resembles it.
  std::optional<std::string> near{};
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
///
/// A value is of a move, of `block` consecutive moves or of a group, and is ranked among those like it
/// (Likes). The bound holds where values that are alike are exchangeable. Of moves that a day makes alike the
/// days are: if the groups of moves are exchangeable, so is any function of one group, such as the median,
/// and the p-value of a group among the groups before it is valid, however its moves depend on each other.
/// The moves of a group themselves are not ranked: their p-values would share what the group has in common.
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
  /// Measures of which the values of the baseline are not exchangeable, at a significance of 0.01 each, or of
  /// 0.05 for all together if that is more.
  std::vector<const MeasureState*> dependent() const;
  const Likes& likes() const { return likes_; }
  std::int64_t values() const { return std::ssize(units_); }  ///< that were compared
  std::int64_t baseline_values() const { return std::ssize(baseline_ends_); }
  std::int64_t unlike() const { return unlike_; }  ///< moves that the baseline has none like
  const std::string& first_unlike() const { return first_unlike_; }  ///< its name
  std::int64_t continued() const { return continued_; }  ///< moves of the last group of the baseline
  const MonitorSettings& settings() const { return settings_; }
  /// Columns of the log that nothing is compared with.
  const std::vector<std::string>& unused() const { return unused_; }
  /// Measures of either side that are not watched; empty where the settings name measures.
  const std::vector<UnwatchedMeasure>& unwatched() const { return unwatched_; }
  /// The columns move and target, by which moves are like each other, that only one of two logs has. Beside a
  /// simulated study, which has both: those that the log has in another letter case.
  const std::vector<UnwatchedMeasure>& unused_labels() const { return unused_labels_; }

 private:
  struct Watched {
    ChangeTest test;
    std::vector<double> p_values{};             ///< until the alarm
    std::vector<std::vector<double>> baseline;  ///< [class of values] sorted
    /// values_to_see() of each change, and the limit that it was asked with.
    std::map<std::pair<Direction, ChangeForm>, std::optional<std::int64_t>> seen{};
    std::int64_t seen_limit{0};
  };
  /// The moves of one value.
  struct Unit {
    std::int64_t first;
    std::int64_t last;
  };

  /// The columns of the log that are watched, each with that of the baseline.
  using Pair = std::pair<const MoveLog::Column*, const MoveLog::Column*>;
  std::vector<Pair> common_columns(const Baseline& baseline, const MoveLog& log);
  /// @param common the columns that are watched
  void note_unwatched(const Baseline& baseline, const MoveLog& log, const std::vector<Pair>& common);
  /// @returns the values of the baseline, in their order
  std::vector<double> add(const MoveLog::Column& before, const MoveLog::Column& column);
  /// @param values [measure][value]
  void test_dependence(const std::vector<std::vector<double>>& values);
  using Columns = std::vector<const std::vector<double>*>;  ///< [measure][move of the log]
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
  std::vector<std::size_t> baseline_ends_;  ///< [value] one past its last move
  Likes likes_;
  std::map<std::vector<std::size_t>, std::size_t> classes_{};  ///< of values: sets of likes
  std::vector<std::size_t> baseline_classes_{};                ///< [value]
  std::string last_group_{};                                   ///< of the baseline
  std::vector<MeasureState> states_{};
  std::vector<Watched> watched_{};                     ///< [measure]
  std::vector<Unit> units_{};                          ///< compared
  std::vector<std::size_t> open_{};                    ///< moves of the value that is not finished
  std::vector<std::size_t> open_likes_{};              ///< theirs
  std::vector<std::optional<std::size_t>> like_at_{};  ///< [move of the log]
  bool continues_baseline_{true};                      ///< the log is still in the baseline's last group
  std::string first_unlike_{};
  std::int64_t moves_{0};
  std::int64_t unlike_{0};
  std::int64_t continued_{0};
};

/// A monitored machine, its baseline and its state: the answer of `monitor` describes them.
struct MonitorReading {
  const MachineMonitor& monitor;
  const Baseline& baseline;
  MonitorState state;
  std::string log{};                              ///< name of the file of the moves
  const ChangeExplanation* explanation{nullptr};  ///< of an alarm beside a simulated study; null: none
  std::int64_t repeated{0};                       ///< equal_moves() of the log and a measured baseline
};

document::AnswerDescription<MonitorReading> monitor_answer();

/// regression for a machine that changed, success for one that did not, inconclusive.
ExitCode exit_code_of(MachineStatus status);

}  // namespace zerocount::monitor
