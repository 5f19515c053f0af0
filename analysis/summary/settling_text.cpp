#include "analysis/summary/settling_text.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/text/text.hpp"

namespace zerocount::summary {

std::string settling_text(const measures::PointSummary& point, double time) {
  if (!std::isnan(time) || point.of(&trial::MoveOutcome::settling_time).moves == 0)
    return text::short_number(time);
  return std::isnan(point.hold) ? "> hold" : fmt::format("> {} s", text::short_number(point.hold));
}

}  // namespace zerocount::summary
