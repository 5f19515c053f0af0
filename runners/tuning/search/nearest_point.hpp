#pragma once

#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include "experiments/study/study.hpp"
#include "runners/tuning/race/search_space.hpp"
#include "runners/tuning/units/loop_examiner.hpp"

namespace zerocount::tuning {

/// The point that comes nearest to the wanted margins, where none keeps them.
struct NearestPoint {
  Values values;
  SmallestMargins margins;  ///< of all examined machines
};

/// Whether these are at least as large as wanted.
bool keeps(const SmallestMargins& margins, const study::LoopMargins& wanted);

/// The point with the least LoopExaminer::shortfall of the wanted margins. Nothing without points that are
/// allowed.
/// @param tried points whose margins were examined; of many about a thousand are taken
/// @param candidate the study with such values, of the machines of `examiner`; nothing where they are not
/// allowed together
/// @param slides whether machines slide
/// @throws trial::Interrupted
std::optional<NearestPoint> nearest_point(
    std::span<const Values> tried, const LoopExaminer& examiner, const study::LoopMargins& wanted,
    const std::function<std::optional<study::Study>(const Values&)>& candidate, bool slides,
    const std::stop_token& stop);

}  // namespace zerocount::tuning
