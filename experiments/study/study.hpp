#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/friction/profile.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/aging.hpp"
#include "experiments/study/tuning.hpp"

namespace zerocount::study {

enum class Design { monte_carlo, latin_hypercube, sobol, saltelli };

/// How often a random value is drawn: once per study, world, rig, trial or contact. In order of frequency.
enum class DrawLevel : std::uint8_t {
  study,
  world,  ///< what all machines share, and nobody knows
  rig,
  trial,
  contact  ///< friction only: at t = 0 and at each re-stick of a trial
};

/// Name of the factor for all random numbers that trials use while they run: noise, missed counts, the levels
/// of the load history.
inline constexpr std::string_view within_trial_factor = "within_trial";

/// The engine that runs the trials. Their results agree to the tolerances in core/batch/README.md, not
/// bitwise.
enum class Engine {
  batch,     ///< many trials at a time in SIMD lanes
  reference  ///< one after the other
};

/// One axis of the sweep: the value of one swept key (or the case) at every design point.
struct SweepAxis {
  enum class Kind { number, text };
  std::string name;     ///< dotted path of the key, or "case"
  std::string unit;     ///< "1" where dimensionless; empty for text
  std::string meaning;  ///< one line, from the table of parameters
  Kind kind{Kind::number};
  std::vector<double> numbers;     ///< [point]; NaN if the key has a distribution at that point
  std::vector<std::string> texts;  ///< [point]; used if kind is text
};

/// One column of trial inputs: a parameter that differs between trials or points.
struct InputColumn {
  std::string name;                   ///< dotted path, e.g. "friction.k1" or "command.targets.0"
  std::string unit;                   ///< "1" where dimensionless
  std::string meaning;                ///< one line, from the table of parameters
  DrawLevel level{DrawLevel::study};  ///< how often it is drawn, the most frequent of all points; study if it
                                      ///< is not drawn
};

/// A friction profile realised for this study's seed.
struct RealisedProfile {
  std::string name;  ///< dotted path of the parameter, with "@point" appended if points differ
  std::string unit;
  std::shared_ptr<const friction::Profile> profile;  ///< of the rotor of all trials, or of rig 0
  std::function<std::shared_ptr<const friction::Profile>(std::int64_t rig)>
      of_rig{};  ///< empty if all trials use one rotor
};

/// An entry of `correlation`: the correlation of the normal scores Φ⁻¹(F(x)) of two parameters.
struct Correlation {
  std::string first;  ///< dotted path
  std::string second;
  double coefficient{0.0};  ///< −1 < ρ < 1
};

/// Joint draws of several parameters (`samples`). A row is drawn as a whole, with equal probability.
struct JointSamples {
  std::string file;                     ///< as the manifest names it
  std::string text;                     ///< of the table
  std::vector<std::string> parameters;  ///< [column] dotted path
  std::int64_t rows{0};
  DrawLevel level{DrawLevel::trial};  ///< how often a row is drawn
};

/// One move of a sequence (`command.sequence`).
struct SequenceMove {
  std::int64_t target{-1};  ///< index in the list; −1: beyond the first or last target
  int direction{1};         ///< of the approach: 1 from below, −1 from above
  std::int64_t cycle{0};    ///< from 0
};

/// The features of the loop that a study can use, at any point and in any trial: decides which optional
/// columns its tables have. Found from the limits of the parameters, so that studies which differ only in
/// their seed have the same columns.
struct StudyFeatures {
  parameters::AxisKind axis{parameters::AxisKind::rotary};  ///< whose units the tables have
  bool open_loop{false};                                    ///< torque levels in place of targets
  bool travel{false};                                       ///< the reference takes time to its target
  bool phases{false};                                       ///< the control has two phases
  bool load{false};                                         ///< there is a second mass
  bool load_count{false};      ///< it has an encoder of its own, which does not close the (position) loop
  bool motor_count{false};     ///< it has one, which closes that loop
  bool drive_torque{false};    ///< the motor torque is not the (delayed) code times the resolution
  bool encoder_errors{false};  ///< an encoder may have errors
  /// Moves may end beside their targets by design: no integral control, Coulomb friction, or moves that are
  /// long.
  bool final_error{false};
  bool own_controller{false};  ///< the controller is a plugin
  bool stopping{false};        ///< a trial is ended where a move diverges
  bool motion{false};          ///< the true motion is measured
  bool steps{false};           ///< and the moves end at a target
  bool following{false};       ///< and the reference is not a step
  bool reversals{false};       ///< and it is a sine
  /// The design is saltelli: the trials of a row share most of their numbers, and bounds for independent
  /// trials are too narrow.
  bool dependent_trials{false};
  trial::ErrorBands bands{};       ///< bands of the error whose entry and settling are measured
  trial::Tolerances tolerances{};  ///< of the position error, for which settling is measured
  bool position_error{false};      ///< the true overshoot, and settling within the tolerances, are measured
  bool rigs{false};  ///< trials share rigs: the bounds account for the correlation of the trials of a rig
  /// The design spreads the trials more evenly than chance (latin_hypercube, sobol): bounds are wider than
  /// needed.
  bool spread_trials{false};
};

/// Sequential stopping (`stop`): after each block of trials the study ends if the bounds of the success rate
/// are narrow enough at every point. The bounds are a confidence sequence, which allows repeated tests.
struct StoppingRule {
  double success_rate_halfwidth{
      0.1};                    ///< half-width of the bounds (see analysis/statistics/confidence_sequence.hpp)
  double confidence{0.95};     ///< of the bounds of one point
  std::int64_t block{1};       ///< trials per point between two tests
  std::int64_t min_trials{1};  ///< trials per point before the study may end
  std::int64_t max_trials{1};  ///< trials per point at which the study ends in any case
};

/// A limit of a goal: the largest magnitude of a measure of a move that meets it.
struct GoalLimit {
  std::string measure;  ///< its name in files: "overshoot", "band_exits[2]", "tolerance_settling_time[1e-08]"
  double largest{0.0};  ///< in the measure's unit
};

/// A goal of a study (`goal`, `goals`). A move meets it if its error is within the band for good after
/// `within` at the latest (BandOutcome::settling_time). The goal is a claim about all axes that the manifest
/// describes, one-sided, with this confidence:
///   without `machines`: at least the proportion `moves` of all their moves meets it;
///   with `machines`: at least the proportion `machines` of them meets it in at least `moves` of its moves.
///
/// With a tolerance the position error |ε| stays within it (MoveOutcome::tolerance_settling_times) in place
/// of the band. A move also misses the goal if a measure of `limits` is larger than allowed, or NaN.
struct Goal {
  std::string name{};                 ///< of `goals`; empty where the study has one goal
  std::int64_t band{0};               ///< counts; one of StudyFeatures::bands; not used with a tolerance
  std::optional<double> tolerance{};  ///< rad, or m; one of StudyFeatures::tolerances
  parameters::AxisKind axis{};        ///< of the study: it determines the units
  double within{1.0};                 ///< s from the start of the move
  std::vector<std::int64_t> on{};     ///< moves of a trial that it is about, rising; empty: all
  std::vector<GoalLimit> limits{};
  double moves{0.99};
  std::optional<double> machines{};
  double confidence{0.95};
};

/// The trials that a results file keeps beside the statistics.
enum class Retention {
  trials,     ///< all
  failures,   ///< those that did not succeed in all their moves
  statistics  ///< none
};

/// Trials counted on a real rig.
struct ObservedCounts {
  std::int64_t successes{0};  ///< trials all of whose moves ended at zero error
  std::int64_t of{1};         ///< trials, all on one rig
};

/// Whether a study has an effect of a real axis.
enum class PremiseState {
  considered,   ///< it acts in some trials
  stated_none,  ///< the manifest gives its parameter as 0
  assumed       ///< the manifest does not name it, and the trials are without it
};

/// The assumption that an effect of a real axis is absent.
struct Premise {
  std::string_view assumption;  ///< "no delay"
  PremiseState state{PremiseState::assumed};
};

/// A manifest as it was given.
struct ManifestSource {
  std::string text;                    ///< exact bytes
  std::string sha256;                  ///< of the text, lower-case hexadecimal
  std::vector<std::string> overrides;  ///< "key=value", as given with --set, in order
};

/// The design points of a study.
struct DesignPoints {
  std::vector<std::string> labels;  ///< [point]
  std::vector<SweepAxis> axes;      ///< of the sweep
};

/// Columns of the tables of inputs: the parameters that differ between trials, rigs and worlds.
struct InputColumns {
  std::vector<InputColumn> inputs;  ///< of trials
  /// Drawn for each rig, the same at all points; empty without rigs. What conditions override has a column
  /// for each of them: "friction.k2@loaded".
  std::vector<InputColumn> rigs;
  std::vector<InputColumn> worlds;  ///< likewise for each world
};

struct StudyPlan;  // see plan.hpp

/// The checked contents of one manifest: everything that determines its trials.
struct Study {
  // The manifest as given.
  ManifestSource manifest;
  std::string name;
  std::string description;
  std::vector<std::string> warnings;  ///< possibly unintended input, one line each
  std::vector<Premise> premises{};    ///< which effects the trials have, and which they leave out

  // The trials to run, and the question to answer.
  parameters::StudyUnits units;
  double period{
      2.0 * std::numbers::pi};  ///< period of profiles along the axis: a revolution, rad; or the travel, m
  std::uint64_t seed{0};
  std::int64_t trials{0};  ///< per design point; the maximum with `stop`
  std::int64_t rigs{0};    ///< number of rigs; 0: no trials share a rig
  std::int64_t worlds{0};  ///< number of worlds, which divides `rigs`; 0: nothing is drawn for each
  /// What every machine bears in turn, by names; empty: one condition. With ages each condition at each age,
  /// "loaded, 100000 cycles", those of an age together.
  std::vector<std::string> conditions{};
  std::vector<std::string> condition_names{};  ///< of the manifest; empty: it has no conditions
  Ages ages{};
  Design design{Design::monte_carlo};
  bool independent_points{false};
  std::vector<Correlation> correlations;  ///< of drawn parameters; all others are independent
  std::optional<JointSamples> samples;    ///< joint draws of several parameters
  std::optional<StoppingRule> stop;       ///< set for sequential stopping
  std::vector<Goal> goals{};              ///< all of which must be met; empty: the study has none
  std::optional<Tuning> tuning{};
  std::map<std::string, std::string>
      observed;  ///< point label → observation on the real rig (the text of a case for all its points)
  std::map<std::string, ObservedCounts> observed_counts;  ///< point label → its counts, where it has any
  std::vector<std::int64_t> retained_trials;  ///< trial indices whose traces are kept, at every point
  Retention retention{Retention::trials};
  /// The user's controller, which runs the trials if it is loaded; null: there is none.
  std::shared_ptr<const plugin::ControllerPlugin> plugin;
  Engine engine{Engine::batch};  ///< chosen for the run; not part of the manifest

  // Compiled from the manifest.
  /// Hash of the values of manifest and overrides, of plugin and samples: equal hashes mean the same trials.
  std::string study_sha256;
  DesignPoints points;
  InputColumns columns;
  std::vector<std::string> factors;  ///< factors of the design saltelli, in its order; otherwise empty
  std::vector<RealisedProfile> profiles;
  std::int64_t moves{1};               ///< per trial
  std::vector<SequenceMove> sequence;  ///< [move]; empty without a sequence
  bool open_loop{false};               ///< the moves are torque levels, without targets
  StudyFeatures features;
  /// From which study_trial() makes the parameters of a trial. A plan does not change once a study has it:
  /// what is made of it may be kept as long as the pointer stays.
  std::shared_ptr<const StudyPlan> plan;
};

/// The parameters of one trial, and its inputs as stored in the results file.
struct StudyTrial {
  trial::TrialParameters parameters;
  std::vector<double> target_positions{};  ///< [move] with command.units: si, rad or m; otherwise empty
  std::vector<double> inputs;  ///< [input column], in that column's unit; for profiles and values drawn per
                               ///< contact the value at the start
};

/// The goal, the first of several; null where the study has none.
inline const Goal* first_goal(const Study& study) {
  return study.goals.empty() ? nullptr : &study.goals.front();
}

/// Whether some of the drawn parameters depend on each other: `correlation` or `samples`.
inline bool has_dependent_parameters(const Study& study) {
  return !study.correlations.empty() || (study.samples && study.samples->parameters.size() > 1);
}

/// E.g. "friction.k1, friction.k2: a row of posterior.csv (1000 draws) for each rig".
std::string samples_text(const JointSamples& samples);

/// E.g. "friction.k1 and friction.k2 (0.6), friction.k1 and friction.beta (-0.5)".
std::string correlations_text(const std::vector<Correlation>& correlations);

inline std::int64_t point_count(const Study& study) {
  return static_cast<std::int64_t>(study.points.labels.size());
}
inline std::int64_t trial_count(const Study& study) {
  return point_count(study) * study.trials;
}

/// How the trials of a point take turns: trial i runs on rig i mod R, under condition ⌊i/R⌋ mod C, and has
/// the random numbers of j = i mod R + R·⌊i/(R·C)⌋. So each rig bears every condition on the same draws. With
/// ages these are the conditions at each age: number c + (conditions)·a is condition c at age a.
struct TrialTurns {
  std::int64_t rigs{1};        ///< R; 1 where no trials share a rig
  std::int64_t conditions{1};  ///< C; 1 without conditions and ages

  std::int64_t condition_of(std::int64_t trial) const { return trial / rigs % conditions; }
  /// j, of which there are trials/C.
  std::int64_t draw_of(std::int64_t trial) const {
    return trial % rigs + rigs * (trial / (rigs * conditions));
  }
  /// The trial with draw j under a condition.
  std::int64_t trial_of(std::int64_t draw, std::int64_t condition) const {
    return draw % rigs + rigs * (condition + conditions * (draw / rigs));
  }
  bool operator==(const TrialTurns&) const = default;
};

inline std::int64_t condition_count(const Study& study) {
  return std::max<std::int64_t>(std::ssize(study.conditions), 1);
}
/// Number of conditions at one age: 1 without conditions.
inline std::int64_t conditions_of_age(const Study& study) {
  return std::max<std::int64_t>(std::ssize(study.condition_names), 1);
}

/// " under condition loaded"; empty without conditions.
std::string condition_text(const Study& study, std::int64_t condition);
/// The noun for an entry of Study::conditions: "condition", "age", "condition and age".
std::string_view turn_word(const Study& study);
inline TrialTurns turns_of(const Study& study) {
  return {std::max<std::int64_t>(study.rigs, 1), condition_count(study)};
}
/// Number of different draws of the trials of a point: its trials under one condition.
inline std::int64_t draw_count(const Study& study) {
  return study.trials / condition_count(study);
}

/// The rig (0 … rigs − 1) of trial `trial_index` at every point, for a study with rigs.
inline std::int64_t rig_of(const Study& study, std::int64_t trial_index) {
  return trial_index % study.rigs;
}

/// The world (0 … worlds − 1) of trial `trial_index` at every point, for a study with worlds: that of its rig
/// r is r mod worlds.
inline std::int64_t world_of(const Study& study, std::int64_t trial_index) {
  return turns_of(study).draw_of(trial_index) % study.worlds;
}

/// Whether existing trials stay the same when `trials` is increased. False for a Latin hypercube, whose
/// strata depend on the number of trials.
bool trials_stay_when_extended(Design design);

/// The parameters of trial `index` (0 … trials − 1) at design point `point` (0 … points − 1). A pure function
/// of the study, safe to call from any thread.
StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index);

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
  std::optional<std::int64_t> rotor{};  ///< in place of the trial's rig, for profiles drawn per rig
  std::optional<std::int64_t> world{};  ///< in place of the trial's world
};

/// As study_trial, with these random numbers.
StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index, const GivenDraws& given);

/// As study_trial, with all numbers in the manifest's units, and without targets if these are in SI units.
/// The caller may change parameters and must then call complete_trial().
StudyTrial study_trial_as_given(const Study& study, std::int64_t point, std::int64_t index,
                                const GivenDraws& given = {});

/// As study_trial, but without profiles, which take long to realise: for what does not depend on friction.
StudyTrial commanded_trial(const Study& study, std::int64_t point, std::int64_t index);

/// Completes the parameters of a trial after all numbers are set in the manifest's units: converts gains from
/// SI units with the trial's sample time and encoder, and gives the coarse encoder of a linear axis the
/// resolution of the fine one by default.
void complete_trial(const parameters::StudyUnits& units, trial::TrialParameters& trial);

/// The inputs of rig `rig` (0 … rigs − 1): [rig column], in that column's unit.
std::vector<double> rig_inputs(const Study& study, std::int64_t rig);

/// The inputs of world `world` (0 … worlds − 1): [world column], in that column's unit.
std::vector<double> world_inputs(const Study& study, std::int64_t world);

/// A value that is drawn for each world.
struct WorldValues {
  std::string name;  ///< dotted path
  std::string unit;
  std::vector<double> values;  ///< [world]
};

/// The values drawn per world at a design point, those of the sweep included; empty without worlds.
std::vector<WorldValues> world_values(const Study& study, std::int64_t point);

}  // namespace zerocount::study
