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

#include "analysis/monitor/move_log.hpp"
#include "core/trial/parameters.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::monitor {

/// The moves with which later moves are compared.
struct Baseline : Moves {
  /// True if the moves are simulated, false if they were measured on the machine.
  bool is_model{false};
  std::int64_t machines{0};  ///< Number of simulated machines; without machines, the number of trials.
};

/// Labels of the moves of a trial that begins at position 0.
std::vector<MoveLabel> labels_of(const trial::TrialParameters& parameters);

/// Selection of moves of a results file.
struct ModelMoves {
  std::int64_t point{0};
  std::optional<std::int64_t> machine{};  ///< Machine; nothing: all machines.
};

/// The moves of a log. @throws Failure (bad_data) if there is none
Baseline baseline_of(const MoveLog& log);

/// The moves of a results file, trial after trial.
/// @param file of one setting
Baseline baseline_of(const reading::AllTrialsFile& file, const ModelMoves& moves);

/// Labels by which moves are grouped into classes of similar moves.
enum class LikeBy { nothing, direction, number, target, number_and_target };

/// The moves of a baseline, grouped into classes of similar moves: with the same number in the sequence, to
/// the same target, or in the same direction. The labels of the baseline decide which of these are used. The
/// values do not influence the choice, so values that are exchangeable within classes remain so.
class Likes {
 public:
  /// @param moves number of moves of the baseline
  /// @param later labels of the log, which give the unit of its targets
  Likes(LikeBy by, const MoveLabels& baseline, std::size_t moves, const MoveLabels& later);

  LikeBy by() const { return by_; }
  bool uses_number() const { return by_ == LikeBy::number || by_ == LikeBy::number_and_target; }
  bool uses_target() const { return by_ == LikeBy::target || by_ == LikeBy::number_and_target; }
  /// Whether classes depend on the direction. The number in a sequence determines where a move comes from;
  /// without a number the direction is used.
  bool uses_direction() const { return by_ == LikeBy::target || by_ == LikeBy::direction; }
  std::size_t count() const { return names_.size(); }
  /// [move of the baseline] Class of the move.
  const std::vector<std::size_t>& of_baseline() const { return of_baseline_; }
  /// The class of a later move; nothing if the baseline has no move like it.
  std::optional<std::size_t> of(const MoveLabel& label) const;
  /// The class of a move whose label is in the units of the baseline.
  std::optional<std::size_t> of_own(const MoveLabel& label) const;
  /// "move 3", "target 20 count upwards"
  const std::string& name(std::size_t like) const { return names_[like]; }
  /// The name of a later move, with its target in the unit of the baseline.
  std::string name_of(const MoveLabel& label) const;

  /// The value in a form in which moves of all classes can be compared. A measure that is mirrored with the
  /// move is given in the direction of the move, or by its magnitude if the class has no known direction.
  double oriented(const MonitoredMeasure& measure, std::size_t like, double value) const;
  /// Whether oriented() takes magnitudes of most moves.
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
  std::vector<std::string> names_{};  ///< [class] Name.
  /// [class] Common direction of all moves of the class in the baseline; 0: none.
  std::vector<int> directions_{};
};

/// Chooses the labels by which the baseline's values repeat. The choices in order are: number and target,
/// target, number, direction, as far as both sides have them. The first one is taken for which at least 90 %
/// of the values have at least four similar others (or all others, in a shorter baseline); otherwise nothing.
/// Numbers count only if there are several. A value of several moves is similar to values with the same set
/// of classes.
/// @param ends [value] one past its last move in the baseline
/// @param file name of the file with the later moves, for messages
/// @param moves number of moves of the baseline
/// @throws Failure (bad_input) if targets are in units of different dimensions
Likes likes_of(const MoveLabels& baseline, std::size_t moves, std::span<const std::size_t> ends,
               const MoveLabels& later, const std::string& file);

/// The sorted, distinct classes of a set of moves.
/// @param likes class of each move
std::vector<std::size_t> set_of(std::span<const std::size_t> likes);

/// The value of consecutive moves: the mean over their classes of typical_value(), of oriented values.
double value_of(const MonitoredMeasure& measure, const Likes& likes, std::span<const std::size_t> classes,
                std::span<const double> values);

}  // namespace zerocount::monitor
