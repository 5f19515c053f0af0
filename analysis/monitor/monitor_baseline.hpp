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

/// Moves that later ones are compared with.
struct Baseline : Moves {
  bool is_model{false};      ///< simulated, not of the machine
  std::int64_t machines{0};  ///< of a model: machines, or trials that share none
};

/// The labels of the moves of a trial, which begins at 0.
std::vector<MoveLabel> labels_of(const trial::TrialParameters& parameters);

/// Which moves of a results file.
struct ModelMoves {
  std::int64_t point{0};
  std::optional<std::int64_t> machine{};  ///< none: those of all
};

/// The moves of a log. @throws Failure (bad_data) if there is none
Baseline baseline_of(const MoveLog& log);

/// The moves of a results file, trial after trial.
/// @param file of one condition
Baseline baseline_of(const reading::AllTrialsFile& file, const ModelMoves& moves);

/// By which labels moves are like each other.
enum class LikeBy { nothing, direction, number, target, number_and_target };

/// The moves of a baseline in classes of moves that are like each other: of the same number in the sequence,
/// to the same target, or in the same direction. Which of these, the labels of the baseline decide; the
/// values have no part in it, so that values that are exchangeable within classes stay so.
class Likes {
 public:
  /// @param moves of the baseline @param later of the log: their unit of targets
  Likes(LikeBy by, const MoveLabels& baseline, std::size_t moves, const MoveLabels& later);

  LikeBy by() const { return by_; }
  bool uses_number() const { return by_ == LikeBy::number || by_ == LikeBy::number_and_target; }
  bool uses_target() const { return by_ == LikeBy::target || by_ == LikeBy::number_and_target; }
  /// The number in a sequence tells where a move comes from; without it the direction does.
  bool uses_direction() const { return by_ == LikeBy::target || by_ == LikeBy::direction; }
  std::size_t count() const { return names_.size(); }
  /// [move of the baseline] its class
  const std::vector<std::size_t>& of_baseline() const { return of_baseline_; }
  /// The class of a later move; nothing if the baseline has no move like it.
  std::optional<std::size_t> of(const MoveLabel& label) const;
  /// The class of a move whose label is in the units of the baseline.
  std::optional<std::size_t> of_own(const MoveLabel& label) const;
  /// "move 3", "target 20 count upwards"
  const std::string& name(std::size_t like) const { return names_[like]; }
  std::string name_of(const MoveLabel& label) const;

  /// The value as moves of all classes can be compared: that of a measure that is mirrored with the move, in
  /// the direction of the move, or, where classes have no known direction, its magnitude.
  double oriented(const MonitoredMeasure& measure, std::size_t like, double value) const;
  /// Whether oriented() takes magnitudes of most moves.
  bool takes_magnitudes() const;

 private:
  using Key = std::tuple<std::int64_t, double, int>;
  Key key_of(const MoveLabel& label, double target_scale, bool whole) const;

  LikeBy by_;
  std::string unit_{};       ///< of targets, as the baseline has them
  double later_scale_{1.0};  ///< of targets of later moves in the unit of the baseline
  bool later_whole_{false};  ///< and they are rounded to counts
  std::map<Key, std::size_t> classes_{};
  std::vector<std::size_t> of_baseline_{};
  std::vector<std::string> names_{};  ///< [class]
  std::vector<int> directions_{};     ///< [class] of all its moves in the baseline; 0: none
};

/// The labels by which the baseline's values repeat. It takes the first of number and target, target, number
/// and direction, as far as both sides have them, by which at least 90 % of the values have at least four
/// others like them (or all others, of a shorter baseline); otherwise nothing. Numbers count where there are
/// several. A value of several moves is like those of the same set of classes.
/// @param ends [value] one past its last move in the baseline @param file of the later moves, in messages
/// @throws Failure (bad_input) if targets are in units of different dimensions
/// @param moves of the baseline
Likes likes_of(const MoveLabels& baseline, std::size_t moves, std::span<const std::size_t> ends,
               const MoveLabels& later, const std::string& file);

/// The sorted classes of these moves, each once.
std::vector<std::size_t> set_of(std::span<const std::size_t> likes);

/// The value of consecutive moves: the mean over their classes of typical_value(), of oriented values.
double value_of(const MonitoredMeasure& measure, const Likes& likes, std::span<const std::size_t> classes,
                std::span<const double> values);

}  // namespace zerocount::monitor
