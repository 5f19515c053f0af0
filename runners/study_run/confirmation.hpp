#pragma once

#include <cstdint>
#include <memory>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::study_run {

/// A design point run again with a fresh seed.
struct Confirmation {
  std::int64_t point{0};
  std::uint64_t seed{0};
  std::int64_t trials{0};
  std::int64_t successes{0};  ///< trials all of whose moves ended at zero error
  bool on_rigs{false};        ///< each on a rig of its own
};

/// Runs `trials` new trials of a point of a results file, on all cores, and writes nothing. Everything is
/// drawn anew, what is drawn once per study too, from a seed that follows from that of the study. The trials
/// are independent whatever the design of the file: the design is monte_carlo, and in a study with rigs every
/// trial has a rig of its own. So Clopper–Pearson bounds hold. The result does not depend on the number of
/// cores.
/// @param plugin the user's controller, if the study has one
/// @throws Failure (bad_input) for a study without targets, or whose plugin is not loaded.
Confirmation confirm_point(const reading::ResultsFile& file, std::int64_t point, std::int64_t trials,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin);

}  // namespace zerocount::study_run
