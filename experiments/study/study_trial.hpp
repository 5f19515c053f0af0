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
  std::vector<double> inputs;  ///< [input column], in that column's unit; for profiles and values drawn per
                               ///< contact the value at the start
};

/// The random numbers of a profile that are given; the others stay as drawn.
struct GivenProfile {
  std::optional<double> mean;        ///< quantile of the profile's mean, if that is drawn
  std::optional<double> field;       ///< the field g of the profile at one position, a standard normal number
  std::optional<double> position{};  ///< rad or m, where it has this value; default: where the trial begins
};

/// Random numbers that stand for the drawn ones.
struct GivenDraws {
  /// Slot of the plan → uniform number in (0, 1). Correlations do not apply to these.
  std::map<std::uint32_t, double> uniforms{};
  std::map<std::uint32_t, GivenProfile> profiles{};  ///< slot of the plan → its profile
  /// In place of the trial's draw (TrialTurns), for all random numbers that are not given. It may exceed
  /// Study::trials.
  std::optional<std::int64_t> number{};
  std::optional<std::int64_t> rotor{};  ///< in place of the trial's machine, for profiles drawn per machine
  std::optional<std::int64_t> world{};  ///< in place of the trial's world
};

/// The parameters of trial `index` (0 … trials − 1) at design point `point` (0 … points − 1). A pure function
/// of the study, safe to call from any thread.
StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index,
                       const GivenDraws& given = {});

/// As study_trial, with all numbers in the manifest's units, and without targets if these are in SI units.
/// The caller may change parameters and must then call complete_trial().
StudyTrial study_trial_as_given(const Study& study, std::int64_t point, std::int64_t index,
                                const GivenDraws& given = {});

/// As study_trial, but without profiles, which take long to realise: for what does not depend on friction.
StudyTrial commanded_trial(const Study& study, std::int64_t point, std::int64_t index);

}  // namespace zerocount::study
