#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/trials/summary/summary.hpp"

namespace zerocount::summary {

/// The summary of a made-up study that sweeps controller.ki = 1, 2, …, with these statistics of its design
/// points.
inline StudySummary swept_study(std::vector<measures::PointSummary> points) {
  StudySummary summary;
  study::SweepAxis axis{"controller.ki", "N m/count", "", study::SweepAxis::Kind::number, {}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    axis.numbers.push_back(1.0 + static_cast<double>(i));
    summary.labels.push_back("controller.ki=" + std::to_string(i + 1));
  }
  summary.axes = {axis};
  summary.points = std::move(points);
  return summary;
}

}  // namespace zerocount::summary
