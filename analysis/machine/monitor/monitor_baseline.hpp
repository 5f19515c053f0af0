#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "analysis/machine/monitor/move_log.hpp"
#include "core/trial/parameters.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::monitor {

/// The baseline: moves of the unchanged machine (simulated or measured) with which later moves are compared.
struct Baseline : Moves {
  /// True if the moves are simulated, false if they were measured on the machine.
  bool is_model{false};
  /// Number of simulated machines; if the study does not define machines, the number of trials; 0 for
  /// measured moves.
  std::int64_t machines{0};
};

/// Labels of the moves of a trial that begins at position 0.
std::vector<MoveLabel> labels_of(const trial::TrialParameters& parameters);

/// Selection of moves of a simulated study's results file, as baseline.
struct ModelMoves {
  std::int64_t point{0};
  /// Index of the machine whose moves are used; nothing: all machines.
  std::optional<std::int64_t> machine{};
};

/// The moves of a measured log as a baseline.
/// @throws Failure (bad_data) if the log has no move
Baseline baseline_of(const MoveLog& log);

/// The moves of a results file as a baseline, trial after trial.
/// @param file results of one setting (a condition at an age)
/// @param moves selects them
Baseline baseline_of(const reading::AllTrialsFile& file, const ModelMoves& moves);

/// Labels by which moves are grouped into classes of similar moves.
enum class LikeBy { nothing, direction, number, target, number_and_target };

/// The moves of a baseline, grouped into classes of similar moves: with the same number in the sequence, to
/// the same target, or in the same direction. The labels of the baseline decide which of these are used. The
/// values do not influence the choice, so values that are exchangeable within classes remain so.
class Likes {
 public:
  /// @param by labels that define the classes
  /// @param baseline labels of the baseline's moves
  /// @param moves number of moves of the baseline
  /// @param later labels of the log with the later moves; they give the unit of its targets
  Likes(LikeBy by, const MoveLabels& baseline, std::size_t moves, const MoveLabels& later);

  LikeBy by() const { return by_; }
  bool uses_number() const { return by_ == LikeBy::number || by_ == LikeBy::number_and_target; }
  bool uses_target() const { return by_ == LikeBy::target || by_ == LikeBy::number_and_target; }
  /// Whether moves upwards and downwards are in different classes. With a number in the sequence, the number
  /// already determines where a move comes from, so the direction is used only without a number.
  bool uses_direction() const { return by_ == LikeBy::target || by_ == LikeBy::direction; }
  std::size_t count() const { return names_.size(); }
  /// [move of the baseline] Index of the class of similar moves to which it belongs.
  const std::vector<std::size_t>& of_baseline() const { return of_baseline_; }
  /// Index of the class of a later move, whose label is in the units of the log; nothing if the baseline has
  /// no move like it.
  std::optional<std::size_t> of(const MoveLabel& label) const;
  /// Index of the class of a move whose label is in the units of the baseline; nothing if the baseline has no
  /// move like it.
  std::optional<std::size_t> of_own(const MoveLabel& label) const;
  /// Name of the class: "move 3", "target 20 count upwards".
  const std::string& name(std::size_t like) const { return names_[like]; }
  /// Name of a later move, as of a class, with its target converted to the unit of the baseline: "target 20
  /// count".
  std::string name_of(const MoveLabel& label) const;

  /// The value of a move in a form in which moves of all classes can be compared. A measure whose sign
  /// reverses with the direction of the move is counted positive in this direction. If the class has no known
  /// direction, its magnitude is taken. Other measures stay as they are.
  double oriented(const MonitoredMeasure& measure, std::size_t like, double value) const;
  /// Whether oriented() takes magnitudes for most moves of the baseline, because the direction of their class
  /// is not known.
  bool takes_magnitudes() const;

 private:
  using Key = std::tuple<std::int64_t, double, int>;
  Key key_of(const MoveLabel& label, double target_scale, bool whole) const;
  std::string name_with_target(const MoveLabel& label, double target_scale) const;

  LikeBy by_;
  std::string unit_{};       ///< Unit of the baseline's targets.
  double later_scale_{1.0};  ///< Factor from targets of later moves to the unit of the baseline.
  bool later_whole_{false};  ///< True if converted targets of later moves are rounded to counts.
  std::map<Key, std::size_t> classes_{};
  std::vector<std::size_t> of_baseline_{};
  std::vector<std::string> names_{};  ///< [class] Name of the class of similar moves.
  /// [class] Direction that all moves of the class in the baseline have: +1 upwards, −1 downwards; 0: unknown
  /// or not the same.
  std::vector<int> directions_{};
};

/// Chooses the labels that sort the moves into classes of similar moves. The choices in order are: number and
/// target, target, number, direction, as far as the baseline and the later moves have them. The first one is
/// taken for which at least 90 % of the baseline's values have at least four others in the same class (or all
/// others, in a shorter baseline); otherwise all moves are one class. The number in the sequence is used only
/// if several numbers occur. A value made of several moves is similar to values with the same set of classes.
/// @param moves number of moves of the baseline
/// @param ends [value] index one past its last move in the baseline
/// @param later labels of the later moves
/// @param file name of the file with the later moves, for messages
/// @throws Failure (bad_input) if targets are in units of different dimensions
Likes likes_of(const MoveLabels& baseline, std::size_t moves, std::span<const std::size_t> ends,
               const MoveLabels& later, const std::string& file);

/// The distinct classes among the moves of one value, sorted.
/// @param likes [move] index of the class of each move
std::vector<std::size_t> set_of(std::span<const std::size_t> likes);

/// The value that stands for consecutive moves: for each class of similar moves among them the
/// typical_value() of their oriented values (Likes::oriented()), then the mean over the classes.
/// @param classes [move] index of the class
/// @param values [move] value of the measure
double value_of(const MonitoredMeasure& measure, const Likes& likes, std::span<const std::size_t> classes,
                std::span<const double> values);

}  // namespace zerocount::monitor
