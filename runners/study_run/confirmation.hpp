#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "analysis/measures/goal_counts.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::study_run {

/// A design point run again with a fresh seed.
struct Confirmation {
  std::int64_t point{0};
  std::uint64_t seed{0};
  std::int64_t trials{0};
  std::int64_t rigs{0};                        ///< 0: no trials share one that they were drawn for
  std::int64_t successes{0};                   ///< trials all of whose moves ended at zero error
  std::optional<measures::MoveCounts> goal{};  ///< of a study with a goal
};

/// Runs about `trials` new trials of a point of a results file, on all cores, and writes nothing. Everything
/// is drawn anew, what is drawn once per study too, from a seed that follows from that of the study. The
/// design is monte_carlo, whatever that of the file. In a study with rigs every trial has a rig of its own,
/// so that Clopper–Pearson bounds hold; if the study has a goal, new rigs have as many trials each as those
/// of the file. The result does not depend on the number of cores.
/// @param plugin the user's controller, if the study has one
/// @throws Failure (bad_input) for a study without targets, or whose plugin is not loaded.
Confirmation confirm_point(const reading::ResultsFile& file, std::int64_t point, std::int64_t trials,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin);

}  // namespace zerocount::study_run
