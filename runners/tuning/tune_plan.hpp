#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "experiments/study/study.hpp"
#include "runners/trials/effort.hpp"
#include "runners/tuning/race/search.hpp"
#include "runners/tuning/search/study_search.hpp"

namespace zerocount::tuning {

/// What a tuning may spend on the search, the proof and all that follows; without both values what the search
/// takes by default, and what the proof and the rest need.
struct TuneBudget {
  std::optional<std::int64_t> trials{};
  std::optional<double> seconds{};
};

/// Trials that an effort is enough for.
/// @param speed trials/s
std::int64_t affordable_trials(const trials::Effort& effort, double speed);

/// Trials per second of the study at the values of its manifest, on the units of a search, measured in a
/// twentieth of the time of the effort, and in half a second at most where it has no limit.
/// @throws trial::Interrupted
double measured_speed(const study::Study& study, const trials::Effort& effort);

/// The size of a search without a budget.
SearchSize default_search_size(const study::Study& study);

/// What the search may take without a budget, s: its trials at the speed of the manifest's values, as
/// measured in half a second.
/// @throws trial::Interrupted
double default_search_seconds(const study::Study& study, const trials::Effort& effort);

/// A search and its part of the effort.
struct SearchPlan {
  SearchSize size;
  trials::Effort effort;
};

/// Plans the search of a tuning: half of the budget, and so much less that the smallest proof is possible.
/// @param speed trials/s; infinite without a limit of time
/// @throws Failure if the budget is not enough for a search and a proof: bad_input for trials; inconclusive
/// for time, which depends on the machine
SearchPlan plan_search(const study::Study& study, const TuneBudget& budget, const trials::Effort& whole,
                       double speed);

/// Plans the search for another control, and its judgement on new machines.
/// @throws trials::Spent if the effort is not enough for both
SearchPlan plan_other_search(const study::Study& study, std::span<const study::FreeParameter> free,
                             const trials::Effort& share, double speed);

/// Trials that are enough for the smallest search for another control, and its judgement.
std::int64_t least_trials_of_other_search(const study::Study& study,
                                          std::span<const study::FreeParameter> free);

/// How what follows the proof shares the effort that is left.
struct RestPlan {
  std::int64_t units{0};           ///< on which a point is simulated
  std::int64_t trials_of_maps{0};  ///< kept for them; 0 where they are not affordable
};

/// Chooses the number of units per point so that the effort is enough for all points, for the searches, and
/// for the maps if they fit beside these.
/// @param searches trials of the smallest searches of other controls together
RestPlan plan_rest(const study::Study& study, std::int64_t points, std::int64_t trials_of_maps,
                   std::int64_t searches, const trials::Effort& effort, double speed);

/// Units on which another control is judged: 1000, or as many as the effort is enough for.
/// @throws trials::Spent if these are fewer than 50
std::int64_t units_of_judgement(const study::Study& study, const trials::Effort& share, double speed);

}  // namespace zerocount::tuning
