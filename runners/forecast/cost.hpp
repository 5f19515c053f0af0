#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/study/study_fwd.hpp"

namespace zerocount::forecast {

/// Computing time of a study.
struct StudyCost {
  double samples{0.0};             ///< of all trials together
  double seconds_per_sample{0.0};  ///< of one core, measured on trials of the study
  int cores{1};                    ///< of this machine

  double seconds() const { return samples * seconds_per_sample / cores; }  ///< with all cores
};

/// Measures the cost of the batch engine on trials spread over the study, for about a twentieth of a second.
/// Trials are cut at 200 000 samples, or less if those would take longer.
StudyCost measure_cost(const study::Study& study);

/// Design points of a study whose trials the batch engine passes to the reference engine, which is several
/// times slower.
struct PointsOnReference {
  std::int64_t points{0};             ///< of those examined
  std::int64_t examined{0};           ///< the first points of the study, 1000 at most
  std::vector<std::string> features;  ///< that the lanes lack (batch::lacking_in_lanes), each once
};

/// Examines the first trial of each point. None are counted if the user asked for the reference engine.
PointsOnReference points_on_reference(const study::Study& study);

/// E.g. "2 of 6 points run on the reference engine, about ten times slower, because of disturbance.ripple
/// without friction".
/// Empty if no point does.
std::string engine_text(const PointsOnReference& use);

}  // namespace zerocount::forecast
