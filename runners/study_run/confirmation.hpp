#pragma once

#include <cstdint>
#include <memory>

#include "analysis/summary_answer/parts.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::study_run {

/// Runs about `trials` new trials of a point of a results file, on all cores, and writes nothing. Everything
/// is drawn anew, what is drawn once per study too, from a seed that follows from that of the study. The
/// design is monte_carlo, whatever that of the file. Every machine bears every condition of the study. In a
/// study with rigs every trial has a rig of its own, so that Clopper–Pearson bounds hold; if the study has a
/// goal, new rigs have as many trials each as those of the file. The result does not depend on the number of
/// cores.
/// @param plugin the user's controller, if the study has one
/// @throws Failure (bad_input) for a study without targets, or whose plugin is not loaded.
summary_answer::Confirmation confirm_point(const reading::ResultsFile& file, std::int64_t point,
                                           std::int64_t trials,
                                           std::shared_ptr<const plugin::ControllerPlugin> plugin);

}  // namespace zerocount::study_run
