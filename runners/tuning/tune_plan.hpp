#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "experiments/study/study.hpp"
#include "runners/trials/effort.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/search/study_search.hpp"

namespace zerocount::tuning {

/// Budget of a tuning for the search, the proof and the extras together. Without trials and seconds, the
/// search has its default size, and the proof and the extras take what they need.
struct TuneBudget {
  std::optional<std::int64_t> trials{};
  std::optional<double> seconds{};
};

/// Number of trials that an effort is enough for, by its trials and by its time.
/// @param speed simulation speed, trials/s; infinity: only the trials limit
std::int64_t affordable_trials(const trials::Effort& effort, double speed);

/// Measures how fast trials of the study are simulated, at the values of its manifest, on machines of a
/// search, trials/s. It takes a twentieth of the effort's time, or at most half a second if the time has no
/// limit.
/// @throws trial::Interrupted if a stop is requested or the time is over
double measured_speed(const study::Study& study, const trials::Effort& effort);

/// Size of the search of a tuning that has no budget.
SearchSize default_search_size(const study::Study& study);

/// Longest time that the search of a tuning without a budget takes, s. It is computed from the trials of the
/// search and the speed at the manifest's values, measured in half a second.
/// @throws trial::Interrupted if a stop is requested
double default_search_seconds(const study::Study& study, const trials::Effort& effort);

/// Size of the search of a tuning, and the effort that it may spend.
struct SearchPlan {
  SearchSize size;
  trials::Effort effort;
};

/// Plans the search of a tuning. The search gets half of the budget, but at least what the smallest search
/// needs, and at most what leaves enough for the smallest proof.
/// @param speed simulation speed, trials/s; infinity without a limit of time
/// @throws Failure if the budget is not enough for a search and a proof: bad_input for trials; inconclusive
/// for time, which depends on the computer
SearchPlan plan_search(const study::Study& study, const TuneBudget& budget, const trials::Effort& whole,
                       double speed);

/// Plans the search for another control law so that enough effort remains to judge this control on fresh
/// machines.
/// @param speed simulation speed, trials/s; infinity without a limit of time
/// @throws trials::Spent if the effort is not enough for both
SearchPlan plan_other_search(const study::Study& study, std::span<const study::FreeParameter> free,
                             const trials::Effort& effort, double speed);

/// Number of trials that the smallest search for another control law takes, including its judgement on fresh
/// machines.
std::int64_t least_trials_of_other_search(const study::Study& study,
                                          std::span<const study::FreeParameter> free);

/// Division of the effort that remains after the proof among the extras of the answer.
struct RestPlan {
  /// Number of machines on which each point (set of values) of the extras is simulated.
  std::int64_t machines{0};
  std::int64_t trials_of_maps{0};  ///< Number of trials kept for the maps; 0 if the maps are not affordable.
};

/// Chooses the number of machines per point (set of values) of the extras so that the effort is enough for
/// all points and searches, and also for the maps if these fit.
/// @param points number of points that all extras simulate
/// @param searches trials of the smallest searches for other controls together
/// @param speed simulation speed, trials/s; infinity without a limit of time
RestPlan plan_rest(const study::Study& study, std::int64_t points, std::int64_t trials_of_maps,
                   std::int64_t searches, const trials::Effort& effort, double speed);

/// Number of machines on which another control law is judged: 1000, or as many as the effort is enough for.
/// @param speed simulation speed, trials/s; infinity without a limit of time
/// @throws trials::Spent if the effort is not enough for 50 machines
std::int64_t machines_of_judgement(const study::Study& study, const trials::Effort& effort, double speed);

}  // namespace zerocount::tuning
