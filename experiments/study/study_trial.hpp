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
  /// [move] target, rad or m, with command.units: si; otherwise empty.
  std::vector<double> target_positions{};
  /// [input column of the results file] value in the unit of that column. For parameters that vary along the
  /// axis or are drawn per contact: the value at the start of the trial.
  std::vector<double> inputs;
};

/// Given random numbers of a friction parameter that varies along the axis. Numbers that are not given stay
/// as drawn.
struct GivenProfile {
  std::optional<double> mean;  ///< quantile of the mean of the profile, if that is drawn
  /// Value of the Gaussian random field g of the profile at one position, a standard normal number.
  std::optional<double> field;
  std::optional<double> position{};  ///< position of `field`, rad or m; default: where the trial begins
};

/// Random numbers of a trial that the caller gives, used in place of the drawn ones.
struct GivenDraws {
  /// Slot of the plan (a parameter) → uniform number in (0, 1). Correlations do not change the given numbers.
  std::map<std::uint32_t, double> uniforms{};
  /// Slot of the plan (a parameter) → given numbers of its profile along the axis.
  std::map<std::uint32_t, GivenProfile> profiles{};
  /// Index of the draw (set of random numbers, TrialIndices::draw_of) to use in place of the trial's own, for
  /// all random numbers that are not given. It may exceed Study::trials.
  std::optional<std::int64_t> number{};
  /// Index of the machine whose rotor is used for profiles drawn per machine, in place of the trial's own.
  std::optional<std::int64_t> rotor{};
  /// Index of the world (set of shared unknown values) to use in place of the trial's own.
  std::optional<std::int64_t> world{};
};

/// The parameters of trial `index` (0 … trials − 1) at design point `point` (0 … points − 1). A pure function
/// of the study, safe to call from any thread.
StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index,
                       const GivenDraws& given = {});

/// The parameters of a trial as study_trial() makes them, but with all numbers in the units of the manifest,
/// and without targets if those are in SI units. The caller may change parameters and must then call
/// complete_trial().
StudyTrial study_trial_as_given(const Study& study, std::int64_t point, std::int64_t index,
                                const GivenDraws& given = {});

/// The parameters of a trial as study_trial() makes them, but without friction profiles along the axis, which
/// take long to realise. For callers that do not depend on friction.
StudyTrial commanded_trial(const Study& study, std::int64_t point, std::int64_t index);

}  // namespace zerocount::study
