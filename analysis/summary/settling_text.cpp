#include "analysis/summary/settling_text.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/text/text.hpp"

namespace zerocount {

std::string settling_text(const PointSummary& point, double time) {
  if (!std::isnan(time) || point.of(&MoveOutcome::settling_time).moves == 0) return short_number(time);
  return std::isnan(point.hold) ? "> hold" : fmt::format("> {} s", short_number(point.hold));
}

}  // namespace zerocount
