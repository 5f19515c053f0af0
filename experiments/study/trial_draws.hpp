#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/friction/profile.hpp"
#include "experiments/distributions/distribution.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::study {

using QuantileFunctions = std::vector<std::optional<distributions::QuantileFunction>>;

/// The indices from which all random numbers of a trial follow: its draw, its machine and its world.
struct TrialDraws {
  const Study& study;
  /// Index of the trial's draw (set of random numbers) among those of its setting (TrialIndices::draw_of).
  std::uint64_t index;
  /// Index of the point of the design (such as a point of the Sobol sequence) that the trial uses.
  std::uint64_t place;
  std::uint64_t machine;  ///< index of the design's point that the trial's machine uses; 0 without machines
  std::uint64_t world;    ///< index of the trial's world (set of shared unknown values); 0 without worlds
  std::uint32_t stream;   ///< random stream of values drawn per trial or contact
  const GivenDraws& given;
  /// Cache: [distribution of the plan] its quantile function; null: none are kept.
  QuantileFunctions* quantiles{nullptr};

  const StudyPlan& plan() const { return *study.plan; }
};

/// The indices from which the random numbers of a trial follow.
/// @param draw TrialIndices::draw_of the trial
TrialDraws draws_of(const Study& study, std::int64_t point, std::int64_t draw, const GivenDraws& given);

/// A trial, identified by its point of the plan (a design point in a setting) and its draw (set of random
/// numbers).
struct TrialPlace {
  std::size_t point;
  std::int64_t draw;
};

/// The point of the plan (a design point in a setting) and the draw of trial `index` at a design point.
/// @throws Failure (bad_input) if the study does not have the point or the trial
TrialPlace place_of(const Study& study, std::int64_t point, std::int64_t index);

/// The uniform number in (0, 1) that a trial has drawn for the value of a slot (a parameter in the plan),
/// correlated as the study's copula says.
double uniform_of(const TrialDraws& draws, std::uint32_t slot, DrawLevel level);

/// The number that a trial has for a slot (a parameter in the plan), whose value is a number or a
/// distribution, at the age of the point.
/// @throws Failure (bad_input) if aging moves it out of the range of the parameter
double drawn_number(const TrialDraws& draws, std::uint32_t slot, const Value& value, std::size_t point);

/// The number that a trial has for the slot (a parameter in the plan) at a design point in a setting. The
/// value of the slot must not be a profile along the axis.
double number_at(const TrialDraws& draws, std::uint32_t slot, std::size_t point);

/// Function that returns the value of a slot (a parameter in the plan) at each contact of a trial; for a
/// value that is drawn at t = 0 and each time that friction sticks again.
std::function<double(std::uint64_t contact)> value_per_contact(const TrialDraws& draws, std::uint32_t slot,
                                                               const Value& value, std::size_t point);

/// The mean along the axis of the friction parameter in the slot, at the age of the point; NaN if the
/// parameter does not vary along the axis.
double profile_mean(const TrialDraws& draws, std::uint32_t slot, std::size_t point);

/// The friction parameter of the slot along the axis, at the age of the point: aging multiplies all its
/// values by one factor.
/// @param start position where the trial begins, rad or m
std::shared_ptr<const friction::Profile> profile_at_age(const TrialDraws& draws, std::uint32_t slot,
                                                        std::size_t point, double start);

/// Completes the parameters of a trial after all numbers are set in the manifest's units: converts gains from
/// SI units with the trial's sample time and encoder, and gives the coarse encoder of a linear axis the
/// resolution of the fine one by default.
void complete_trial(const parameters::StudyUnits& units, trial::TrialParameters& trial);

/// Sets the target positions of a trial's sequence of moves, and StudyTrial::target_positions.
/// @param numbers [slot of the plan] number of the trial
void set_targets(const Study& study, const std::vector<double>& numbers, StudyTrial& trial);

/// Converts targets in SI units to the nearest counts of the fine encoder. All else in the trial must be
/// complete.
void complete_targets(StudyTrial& trial);

/// Draws many trials of one study: study_trial() with the constants of the quantile functions and the memory
/// of a trial kept from one draw to the next. Not thread-safe.
class TrialDrawer {
 public:
  /// Prepares the draws of a study's trials.
  /// @param study must outlive this object
  explicit TrialDrawer(const Study& study);

  /// Makes `trial` bitwise equal to study_trial(study, point, index).
  void draw(std::int64_t point, std::int64_t index, StudyTrial& trial);

 private:
  const Study& study_;
  std::shared_ptr<const StudyPlan> plan_;  ///< plan to which `quantiles_` belongs
  QuantileFunctions quantiles_;  ///< [distribution of the plan] its quantile function, made when first drawn
  std::vector<double> numbers_;  ///< [slot of the plan] memory for the numbers of a trial
};

}  // namespace zerocount::study
