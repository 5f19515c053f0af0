#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The parameters of one trial, and its inputs as stored in the results file.
struct StudyTrial {
  trial::TrialParameters parameters;
  std::vector<double> target_positions{};  ///< [move] with command.units: si, rad or m; otherwise empty
  /// [input column] value in the unit of that column. For profiles and values drawn per contact: the value at
  /// the start of the trial.
  std::vector<double> inputs;
};

/// Given random numbers of a profile. Those without a value stay as drawn.
struct GivenProfile {
  std::optional<double> mean;        ///< quantile of the profile's mean, if that is drawn
  std::optional<double> field;       ///< the field g of the profile at one position, a standard normal number
  std::optional<double> position{};  ///< position of `field`, rad or m; default: where the trial begins
};

/// Given random numbers, used in place of the drawn ones.
struct GivenDraws {
  /// Slot of the plan → uniform number in (0, 1). Correlations do not change the given numbers.
  std::map<std::uint32_t, double> uniforms{};
  std::map<std::uint32_t, GivenProfile> profiles{};  ///< slot of the plan → its given numbers
  /// Draw to use in place of the trial's own (TrialIndices::draw_of), for all random numbers that are not
  /// given. It may exceed Study::trials.
  std::optional<std::int64_t> number{};
  std::optional<std::int64_t>
      rotor{};  ///< machine to use for profiles drawn per machine, not the trial's own
  std::optional<std::int64_t> world{};  ///< world to use in place of the trial's own
};

/// The parameters of trial `index` (0 … trials − 1) at design point `point` (0 … points − 1). A pure function
/// of the study, safe to call from any thread.
StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index,
                       const GivenDraws& given = {});

/// As study_trial(), but with all numbers in the units of the manifest, and without targets if they are in SI
/// units. The caller may change parameters and must then call complete_trial().
StudyTrial study_trial_as_given(const Study& study, std::int64_t point, std::int64_t index,
                                const GivenDraws& given = {});

/// As study_trial(), but without profiles, which take long to realise. For callers that do not depend on
/// friction.
StudyTrial commanded_trial(const Study& study, std::int64_t point, std::int64_t index);

}  // namespace zerocount::study
