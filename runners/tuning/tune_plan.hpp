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

/// Number of trials that an effort is enough for.
/// @param speed trials/s
std::int64_t affordable_trials(const trials::Effort& effort, double speed);

/// Measures the speed of the study at the values of its manifest, on machines of a search, trials/s. It takes
/// a twentieth of the effort's time, or at most half a second if the time has no limit.
/// @throws trial::Interrupted
double measured_speed(const study::Study& study, const trials::Effort& effort);

/// Size of a search without a budget.
SearchSize default_search_size(const study::Study& study);

/// Duration that the search may take without a budget, s. It is computed from the trials of the search and
/// the speed at the manifest's values, measured in half a second.
/// @throws trial::Interrupted
double default_search_seconds(const study::Study& study, const trials::Effort& effort);

/// Size of a search, and the effort that it may spend.
struct SearchPlan {
  SearchSize size;
  trials::Effort effort;
};

/// Plans the search of a tuning. It gets half of the budget, but at least what the smallest search needs, and
/// at most what leaves enough for the smallest proof.
/// @param speed trials/s; infinity without a limit of time
/// @throws Failure if the budget is not enough for a search and a proof: bad_input for trials; inconclusive
/// for time, which depends on the computer
SearchPlan plan_search(const study::Study& study, const TuneBudget& budget, const trials::Effort& whole,
                       double speed);

/// Plans the search for another control so that the control can be judged on fresh machines afterwards.
/// @throws trials::Spent if the effort is not enough for both
SearchPlan plan_other_search(const study::Study& study, std::span<const study::FreeParameter> free,
                             const trials::Effort& effort, double speed);

/// Number of trials of the smallest search for another control, including its judgement.
std::int64_t least_trials_of_other_search(const study::Study& study,
                                          std::span<const study::FreeParameter> free);

/// Division of the effort that the proof leaves for the extras.
struct RestPlan {
  std::int64_t machines{0};        ///< Number of machines on which each point is simulated.
  std::int64_t trials_of_maps{0};  ///< Trials kept for the maps; 0 if the maps are not affordable.
};

/// Chooses the number of machines per point so that the effort is enough for all points and searches, and
/// also for the maps if these fit.
/// @param searches trials of the smallest searches for other controls together
RestPlan plan_rest(const study::Study& study, std::int64_t points, std::int64_t trials_of_maps,
                   std::int64_t searches, const trials::Effort& effort, double speed);

/// Number of machines on which another control is judged: 1000, or as many as the effort is enough for.
/// @throws trials::Spent if the effort is not enough for 50 machines
std::int64_t machines_of_judgement(const study::Study& study, const trials::Effort& effort, double speed);

}  // namespace zerocount::tuning
