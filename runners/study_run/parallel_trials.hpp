#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/batch/batch.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::study_run {

/// Calls `work` for each index below `count`, in parallel, each time with an engine that no other call uses
/// at that time.
void for_each_with_engine(std::size_t count,
                          const std::function<void(std::size_t, batch::BatchEngine&)>& work);

/// The outcomes of trials, in their order. @throws trial::Interrupted
std::vector<trial::TrialOutcome> outcomes_of(std::span<const trial::TrialParameters> trials,
                                             batch::BatchEngine& engine, const std::stop_token& stop);

}  // namespace zerocount::study_run
