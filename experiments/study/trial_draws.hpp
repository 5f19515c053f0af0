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

/// The coordinates of a trial's random numbers.
struct TrialDraws {
  const Study& study;
  std::uint64_t index;    ///< index of the trial among the trials of its setting (TrialIndices::draw_of)
  std::uint64_t place;    ///< index of the trial's point in the design
  std::uint64_t machine;  ///< index of its machine in the design, as `place`; 0 without machines
  std::uint64_t world;    ///< index of its world; 0 without worlds
  std::uint32_t stream;   ///< random stream of values drawn per trial or contact
  const GivenDraws& given;
  QuantileFunctions* quantiles{nullptr};  ///< cache, [distribution of the plan]; null: none are kept

  const StudyPlan& plan() const { return *study.plan; }
};

/// @param draw TrialIndices::draw_of the trial
TrialDraws draws_of(const Study& study, std::int64_t point, std::int64_t draw, const GivenDraws& given);

/// A trial, identified by its point of the plan and its draw.
struct TrialPlace {
  std::size_t point;
  std::int64_t draw;
};

/// The place of a trial.
/// @throws Failure (bad_input) if the study does not have the point or the trial
TrialPlace place_of(const Study& study, std::int64_t point, std::int64_t index);

/// The uniform number of a drawn value, with the copula of the study.
double uniform_of(const TrialDraws& draws, std::uint32_t slot, DrawLevel level);

/// The number of a slot, whose value is a number or a distribution, at the age of the point.
/// @throws Failure (bad_input) if aging moves it out of the range of the parameter
double drawn_number(const TrialDraws& draws, std::uint32_t slot, const Value& value, std::size_t point);

/// The number of the slot at a point of the plan. The value of the slot must not be a profile.
double number_at(const TrialDraws& draws, std::uint32_t slot, std::size_t point);

/// Function that returns the value of a slot at a contact; for a value that is drawn at each contact.
std::function<double(std::uint64_t contact)> value_per_contact(const TrialDraws& draws, std::uint32_t slot,
                                                               const Value& value, std::size_t point);

/// The mean of the slot's profile at the age of the point; NaN if the slot has no profile.
double profile_mean(const TrialDraws& draws, std::uint32_t slot, std::size_t point);

/// The profile of the slot at the age of the point: aging multiplies all its values by one factor.
/// @param start position where the trial begins, rad or m
std::shared_ptr<const friction::Profile> profile_at_age(const TrialDraws& draws, std::uint32_t slot,
                                                        std::size_t point, double start);

/// Completes the parameters of a trial after all numbers are set in the manifest's units: converts gains from
/// SI units with the trial's sample time and encoder, and gives the coarse encoder of a linear axis the
/// resolution of the fine one by default.
void complete_trial(const parameters::StudyUnits& units, trial::TrialParameters& trial);

/// Sets the targets of a sequence, and StudyTrial::target_positions.
/// @param numbers [slot of the plan]
void set_targets(const Study& study, const std::vector<double>& numbers, StudyTrial& trial);

/// Converts targets in SI units to the nearest counts of the fine encoder. All else in the trial must be
/// complete.
void complete_targets(StudyTrial& trial);

/// Draws many trials of one study: study_trial() with the constants of the quantile functions and the memory
/// of a trial kept from one draw to the next. Not thread-safe.
class TrialDrawer {
 public:
  /// @param study must outlive this object
  explicit TrialDrawer(const Study& study);

  /// Makes `trial` bitwise equal to study_trial(study, point, index).
  void draw(std::int64_t point, std::int64_t index, StudyTrial& trial);

 private:
  const Study& study_;
  std::shared_ptr<const StudyPlan> plan_;  ///< plan to which `quantiles_` belongs
  QuantileFunctions quantiles_;            ///< [distribution] filled when first drawn
  std::vector<double> numbers_;            ///< [slot] memory for the numbers of a trial
};

}  // namespace zerocount::study
