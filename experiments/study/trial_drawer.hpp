#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "experiments/distributions/quantile_function.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::study {

/// Draws many trials of one study: study_trial() with the constants of the quantile functions and the memory
/// of a trial kept from one draw to the next. For one thread.
class TrialDrawer {
 public:
  /// @param study stays as long as this
  explicit TrialDrawer(const Study& study);

  /// Makes `trial` bitwise equal to study_trial(study, point, index).
  void draw(std::int64_t point, std::int64_t index, StudyTrial& trial);

 private:
  const Study& study_;
  std::shared_ptr<const StudyPlan> plan_;                                  ///< of which the functions are
  std::vector<std::optional<distributions::QuantileFunction>> quantiles_;  ///< [distribution] once drawn
  std::vector<double> numbers_;                                            ///< [slot]
};

}  // namespace zerocount::study
