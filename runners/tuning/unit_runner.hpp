#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "analysis/tuning/candidate.hpp"
#include "analysis/tuning/effort.hpp"
#include "core/batch/batch.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/measure_table.hpp"
#include "results/reading/study_file.hpp"

/// Tuning of a study: the search on machines of its own, the proof on others, and what the answer rests on.
namespace zerocount::tuning {

/// The study with these overrides ("key=value") after its own.
/// @throws Failure (bad_input) as parse_study
study::Study variant_of(const study::Study& study, const std::vector<std::string>& overrides);

/// "controller.ki=5000", in digits that read back to the same value.
std::vector<std::string> overrides_of(std::span<const study::FreeParameter> free, const Values& values);

/// The units of a study: machines, or trials each on a machine of its own.
struct Units {
  std::int64_t count{0};
  std::int64_t trials_each{1};
  std::int64_t point{0};  ///< of the study
};

/// The units of a study that is given: its rigs, or its trials.
Units units_of(const study::Study& study, std::int64_t point);

/// So many units or a few more, as many in each world.
std::int64_t in_equal_worlds(const study::Study& study, std::int64_t units);

/// Overrides that make a study of these units: independent draws, nothing retained.
std::vector<std::string> overrides_for(const study::Study& study, const Units& units);

/// The quantity that tuning minimises.
struct Criterion {
  const layout::Measure* measure{nullptr};
  double quantile{0.95};
};

/// @throws Failure (bad_input) if Tuning::minimise names no quantile of a measure
Criterion criterion_of(const study::Study& study);

Aim aim_of(const study::Study& study);

/// Changes the parameters of a trial after they are drawn.
using Change = std::function<void(trial::TrialParameters&)>;

/// Units [from, to) of a study.
struct UnitsToRun {
  const study::Study* study{nullptr};
  std::int64_t from{0};
  std::int64_t to{0};
  std::vector<UnitResult>* results{nullptr};  ///< get one entry a unit
  const Change* change{nullptr};              ///< null: none
};

/// Runs the trials of all entries on all cores. The results do not depend on the number of cores.
/// @param units of each of the studies
/// @throws trial::Interrupted
void run_units(std::span<const UnitsToRun> entries, const Units& units, const std::stop_token& stop);

/// The results of the first `count` units of a study.
/// @param change null: none
/// @throws trial::Interrupted, Spent
std::vector<UnitResult> results_of(const study::Study& study, const Units& units, std::int64_t count,
                                   const Change* change, const Effort& effort);

/// The results of all units of a study of one point, from its results file.
std::vector<UnitResult> results_in(const reading::StudyFile& file, const study::Study& study,
                                   const Units& units);

}  // namespace zerocount::tuning
