#pragma once

#include <cstdint>
#include <limits>

#include "core/loop/reference.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

/// Measures of the true motion of a move, whatever the encoder reads (see measures.md).
namespace zerocount::trial {

/// One sampling instant of a move, as the measures of the true motion need it.
struct MotionSample {
  std::int64_t number{0};  ///< Number of the sample, counted from the start of the move
  std::int64_t error{0};   ///< Control error e, counts
  double theta{0.0};       ///< Angle of the rotor, or of the load if its encoder closes the loop, rad
  double torque{0.0};      ///< Torque decided at this sample, N m
};

/// Accumulates the measures of the true motion over the moves of a trial. Its memory does not grow with the
/// length of the moves.
class MotionMeasures {
 public:
  /// Prepares the measures of a trial.
  /// @param resolution Δx of the fine encoder, rad.
  MotionMeasures(const TrialParameters& parameters, double resolution);

  /// Starts the next move.
  /// @param target target of the move, counts.
  /// @param samples number of samples of the move.
  void start_move(std::int64_t target, std::int64_t samples);

  /// Takes the next sample of the move.
  /// @param reference reference of the move, from which the following error is measured.
  void add(const MotionSample& sample, const loop::Reference& reference);

  /// Adds the measures of the true motion to the outcome of the move, whose other measures are final. A move
  /// that was stopped or lost its motion gets none.
  void finish(MoveOutcome& outcome);

 private:
  /// Sums over successive samples within the rest band.
  struct Rest {
    std::int64_t samples{0};
    double squared_errors{0.0};  ///< Sum of the squared true errors, counts²
    double lowest{std::numeric_limits<double>::infinity()};
    double highest{-std::numeric_limits<double>::infinity()};
    double squared_torques{0.0};  ///< Sum of the squares of the torque decided, (N m)²
    double squared_changes{0.0};  ///< Sum of the squared changes of the torque decided from sample to sample,
                                  /// < (N m)²
    double last_torque{0.0};
  };
  struct Following {
    std::int64_t samples{0};
    double squared_errors{0.0};  ///< Sum of the squared following errors, counts²
    double peak{0.0};            ///< Largest |following error|, counts
    double spike{std::numeric_limits<double>::quiet_NaN()};
  };

  void add_to_rest(const MotionSample& sample, double true_error);
  void add_to_following(double t, double error, const loop::Reference& reference);

  double resolution_;
  double phase_;
  double sample_time_;
  std::int64_t dwell_;   // samples
  std::int64_t window_;  // samples
  double band_;          // counts
  double period_;        // of a sine reference, s

  double target_{0.0};       // counts
  double from_{0.0};         // the target before
  std::int64_t samples_{0};  // of the move
  bool entered_{false};      // the band, for a whole dwell
  Rest rest_{};
  Following following_{};
  double position_sum_{0.0};     // over the window, counts from the target
  double position_before_{0.0};  // mean over the window of the move before, counts
};

}  // namespace zerocount::trial
