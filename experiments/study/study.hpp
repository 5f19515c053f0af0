#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/friction/profile.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount {

enum class Design { monte_carlo, latin_hypercube, sobol, saltelli };

/// How often a random value is drawn: all that shares it draws it once.
enum class Per : std::uint8_t {
  study,
  rig,
  trial,
  contact  ///< of friction: at t = 0 and at each re-stick of a trial
};

/// Name of the factor that stands for all random numbers that trials draw while they run: their noise, their
/// missed counts, the levels of their histories.
inline constexpr std::string_view within_trial_factor = "within_trial";

/// What runs the trials. The numbers of both agree to what core/batch/README.md says, and not to the last
/// bit.
enum class Engine {
  batch,     ///< many trials at a time in vector lanes
  reference  ///< one after the other
};

/// One axis of the sweep: the value of one swept key (or the case) at every design point.
struct SweepAxis {
  enum class Kind { number, text };
  std::string name;     ///< dotted path of the key, or "case"
  std::string unit;     ///< "1" where dimensionless; empty for text
  std::string meaning;  ///< one line, from the table of parameters
  Kind kind{Kind::number};
  std::vector<double> numbers;     ///< [point]; NaN where the point leaves the key to a distribution
  std::vector<std::string> texts;  ///< [point]; used where kind is text
};

/// One column of trial inputs: a parameter that differs between trials or points.
struct InputColumn {
  std::string name;     ///< dotted path, e.g. "friction.k1" or "command.targets.0"
  std::string unit;     ///< "1" where dimensionless
  std::string meaning;  ///< one line, from the table of parameters
  Per per{Per::study};  ///< how often it is drawn: of different points, the most often; study where it is not
};

/// A friction profile realised for this study's seed.
struct RealisedProfile {
  std::string name;  ///< dotted path of the parameter, with "@point" appended where points differ
  std::string unit;
  std::shared_ptr<const Profile> profile;  ///< the one rotor of all trials, or that of rig 0
  std::function<std::shared_ptr<const Profile>(std::int64_t rig)>
      of_rig{};  ///< empty where all trials are on one rotor
};

/// One move of a sequence (`command.sequence`): which of the listed targets it goes to, and from where.
struct SequenceMove {
  std::int64_t target{-1};  ///< index in the list; −1: beyond an end of it, only to approach from there
  int direction{1};         ///< of the approach: 1 from below, −1 from above
  std::int64_t cycle{0};    ///< from 0
};

/// What the sample records of a study hold beyond the columns that all have.
struct TraceExtras {
  bool reference{false};     ///< at some point, the reference is not a step
  bool phase{false};         ///< at some point, the control has two phases
  bool drive_torque{false};  ///< at some point, the motor's torque is not the code times the resolution,
                             ///< but for the delay of a closed loop
};

/// What the outcomes of a study hold beyond the columns that all have.
struct OutcomeExtras {
  bool stopped{false};  ///< at some point, a trial is ended where a move diverges
};

/// What the trials of a study may meet in the loop, by all that their parameters can be.
struct LoopExtras {
  bool encoder_errors{false};  ///< in some trial, an encoder is not ideal
  /// In some trial nothing brings the moves to their targets: there is no integral control, or Coulomb
  /// friction.
  bool lasting_errors{false};
};

/// When a study has trials enough (`stop`): looks after each block of trials, and ends where the success rate
/// of every point is known well enough, however often it has looked.
struct StoppingRule {
  double success_rate_halfwidth{
      0.1};  ///< half the width of the bounds (see analysis/statistics/confidence_sequence.hpp)
  double confidence{0.95};     ///< of the bounds of one point
  std::int64_t block{1};       ///< trials at a point between two looks
  std::int64_t min_trials{1};  ///< at a point, before it may end
  std::int64_t max_trials{1};  ///< at a point, with which it ends in any case
};

struct StudyPlan;  // compiled form of the manifest, private to this folder

/// One manifest, understood: everything that determines its trials.
struct Study {
  std::string name;
  std::string description;
  StudyUnits units;
  double period{2.0 * std::numbers::pi};  ///< of profiles along the axis: a revolution, rad; or the travel, m
  std::uint64_t seed{0};
  std::int64_t trials{0};            ///< per design point; the most that there may be, if `stop` decides
  std::int64_t rigs{0};              ///< that the trials run on; 0: no trials share a rig
  std::optional<StoppingRule> stop;  ///< where the number of trials is decided while it runs
  Design design{Design::monte_carlo};
  std::vector<std::string> factors;  ///< of the design saltelli, in its order; otherwise empty
  bool independent_points{false};
  Engine engine{Engine::batch};  ///< chosen for the run; no part of the manifest

  std::string manifest_text;           ///< exact bytes of the manifest
  std::string manifest_sha256;         ///< of manifest_text, lower-case hexadecimal
  std::vector<std::string> overrides;  ///< "key=value", as given with --set, in order
  std::string study_sha256;            ///< of manifest_text and overrides: equal means the same trials

  std::vector<std::string> point_labels;  ///< [point]
  std::vector<SweepAxis> axes;
  std::vector<InputColumn> input_columns;
  std::vector<InputColumn>
      rig_columns;  ///< those drawn for each rig, the same at all points; none without rigs
  std::vector<RealisedProfile> profiles;
  std::map<std::string, std::string>
      observed;  ///< point label → what was observed on the real rig (a case's text at all its points)
  std::vector<std::int64_t> retained_trials;  ///< trial indices whose sample records are kept, at every point
  std::int64_t moves{1};                      ///< per trial
  std::vector<SequenceMove> sequence;         ///< [move]; empty where there is none
  bool open_loop{false};                      ///< the moves are torque levels, without targets
  TraceExtras trace_extras;
  OutcomeExtras outcome_extras;
  LoopExtras loop_extras;
  std::vector<std::string> warnings;  ///< what is allowed but may surprise, a line each, with its place

  std::shared_ptr<const StudyPlan> plan;
};

/// One trial, ready to run, and what the results file records of its parameters.
struct StudyTrial {
  TrialParameters parameters;
  std::vector<double> inputs;  ///< [input column], in that column's unit; of a profile, and of what each
                               ///< contact draws, the value where the trial starts
};

inline std::int64_t point_count(const Study& study) {
  return static_cast<std::int64_t>(study.point_labels.size());
}
inline std::int64_t trial_count(const Study& study) {
  return point_count(study) * study.trials;
}

/// The rig (0 … rigs − 1) that trial `trial_index` of every point runs on, in a study that has rigs.
inline std::int64_t rig_of(const Study& study, std::int64_t trial_index) {
  return trial_index % study.rigs;
}

/// Whether the trials of a study stay what they are when `trials` grows. Those of a Latin hypercube do not:
/// it is laid out for its number of trials.
bool trials_stay_when_extended(Design design);

/// The parameters of trial `index` (0 … trials − 1) at design point `point` (0 … points − 1). A pure function
/// of the study, safe to call from any thread.
StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index);

/// The same with all numbers as the manifest gives them: its parameters have to be completed (complete_trial)
/// before they are run. For those who change some of them first.
StudyTrial study_trial_as_given(const Study& study, std::int64_t point, std::int64_t index);

/// What differs between the rigs, of rig `rig` (0 … rigs − 1): [rig column], in that column's unit.
std::vector<double> rig_inputs(const Study& study, std::int64_t rig);

}  // namespace zerocount
