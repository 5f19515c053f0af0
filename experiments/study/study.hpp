#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/features.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/sampling.hpp"
#include "experiments/study/sequence.hpp"
#include "experiments/study/setting.hpp"

namespace zerocount::study {

/// The text of a study's manifest and the overrides, as they were given.
struct ManifestSource {
  std::string text;                    ///< the exact bytes of the manifest file
  std::string sha256;                  ///< SHA-256 checksum of `text`, lower-case hexadecimal
  std::vector<std::string> overrides;  ///< overrides of keys, "key=value" as given with --set, in order
};

/// Trials counted on a real machine, for comparison with the simulated success rate.
struct ObservedCounts {
  std::int64_t successes{0};  ///< number of trials all of whose moves ended at zero error
  std::int64_t of{1};         ///< total number of trials, all on one machine
};

struct StudyPlan;  // see plan.hpp

/// The checked contents of one manifest: everything that determines its trials.
struct Study {
  // The manifest as given.
  ManifestSource manifest;
  std::string name;
  std::string description;
  std::vector<std::string> warnings;  ///< warnings about input that is possibly unintended, one line each
  /// States of the assumptions that effects of a real axis are absent: considered, stated or assumed.
  std::vector<Premise> premises{};

  // The trials to run, and the question to answer.
  parameters::StudyUnits units;
  /// Period of friction parameters that vary along the axis: a revolution, rad; or the travel, m.
  double period{2.0 * std::numbers::pi};
  std::uint64_t seed{0};
  std::int64_t trials{0};    ///< number of trials per design point; the maximum with `stop`
  std::int64_t machines{0};  ///< number of machines; 0: no trials share a machine
  /// Number of worlds (possible sets of the values that nobody knows and all machines share), which divides
  /// `machines`; 0: nothing is drawn for each world.
  std::int64_t worlds{0};
  Settings settings{};  ///< conditions and ages; every machine is simulated in each setting
  Design design{Design::monte_carlo};
  bool independent_points{false};
  std::vector<Correlation>
      correlations;  ///< Correlations of drawn parameters; pairs of parameters not listed are independent
  std::optional<JointSamples> samples;  ///< joint draws of several parameters from a table; empty: none
  std::optional<StoppingRule> stop;  ///< rule for sequential stopping; empty: the study runs all its trials
  std::vector<Goal> goals{};         ///< goals, all of which must be met; empty: the study has none
  std::optional<Tuning> tuning{};
  /// Point label → observation on the real machine. The text of a case is repeated for all its points.
  std::map<std::string, std::string> observed;
  /// Label of the design point → counts observed on the real machine, if the manifest gives them.
  std::map<std::string, ObservedCounts> observed_counts;
  /// Indices of the trials whose traces (signals over time) are kept, at every design point.
  std::vector<std::int64_t> retained_trials;
  Retention retention{Retention::trials};
  /// The user's controller, which runs the trials if it is loaded; null: there is none.
  std::shared_ptr<const plugin::ControllerPlugin> plugin;
  /// Engine that runs the trials, chosen for the run; not part of the manifest.
  Engine engine{Engine::batch};

  // Compiled from the manifest.
  /// Hash of the values of manifest and overrides, of plugin and samples: equal hashes mean the same trials.
  std::string study_sha256;
  DesignPoints points;
  InputColumns columns;
  /// Names of the factors of the design saltelli, in the design's order; otherwise empty.
  std::vector<std::string> factors;
  std::vector<RealisedProfile> profiles;
  std::int64_t moves{1};  ///< number of moves in one trial
  /// [index of the move] moves of the sequence (`command.sequence`); empty without a sequence.
  std::vector<SequenceMove> sequence;
  bool open_loop{false};  ///< the moves are commanded torque levels, without targets and without control
  StudyFeatures features;
  /// Compiled values from which study_trial() makes the parameters of a trial. The plan of a study never
  /// changes, so anything derived from it stays valid as long as the pointer is the same.
  std::shared_ptr<const StudyPlan> plan;
};

/// The first goal of the study; null if it has none.
inline const Goal* first_goal(const Study& study) {
  return study.goals.empty() ? nullptr : &study.goals.front();
}

/// Whether some of the drawn parameters depend on each other: `correlation` or `samples`.
inline bool has_dependent_parameters(const Study& study) {
  return !study.correlations.empty() || (study.samples && study.samples->parameters.size() > 1);
}

inline std::int64_t point_count(const Study& study) {
  return static_cast<std::int64_t>(study.points.labels.size());
}
inline std::int64_t trial_count(const Study& study) {
  return point_count(study) * study.trials;
}

/// Number of groups (such as machines) in this way of grouping the trials; 0 if the study does not have the
/// grouping.
std::int64_t group_count(const Study& study, Grouping grouping);

TrialIndices trial_indices(const Study& study);

/// Index of the group (such as the machine) to which the trial with this index belongs, the same at every
/// design point.
inline std::int64_t group_of(const Study& study, Grouping grouping, std::int64_t trial_index) {
  return trial_indices(study).group_of(grouping, trial_index);
}

/// Number of draws per design point. A draw is one set of random numbers, which is used once in each setting
/// (condition at an age); so this is the number of trials in one setting.
inline std::int64_t draw_count(const Study& study) {
  return study.trials / study.settings.total();
}

/// Number of draws at this level (per world, machine, trial …) by the trials of a design point in one setting
/// (condition at an age). For contacts, only the first contact of each trial is counted.
std::int64_t draw_count(const Study& study, DrawLevel level);

}  // namespace zerocount::study
