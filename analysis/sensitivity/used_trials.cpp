#include <algorithm>
#include <cmath>

#include "analysis/sensitivity/output_sensitivity.hpp"
#include "experiments/designs/saltelli.hpp"

namespace zerocount::sensitivity {

UsedTrials used_trials(const PointInputs& point, const std::vector<double>& values) {
  UsedTrials used;
  if (point.design != study::Design::saltelli) {
    const std::size_t looked_at = point.rigs > 0 ? static_cast<std::size_t>(point.rigs) : values.size();
    for (std::size_t i = 0; i < looked_at; ++i) {
      if (std::isfinite(values[i])) used.independent.push_back(i);
    }
    used.of_rigs = point.rigs > 0 ? static_cast<std::int64_t>(values.size() - looked_at) : 0;
    used.left_out = static_cast<std::int64_t>(looked_at - used.independent.size());
    return used;
  }
  const std::size_t length = designs::saltelli_row_length(point.factors.size());
  for (std::size_t start = 0; start + length <= values.size(); start += length) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(start);
    if (!std::all_of(first, first + static_cast<std::ptrdiff_t>(length),
                     [](double v) { return std::isfinite(v); })) {
      used.left_out += static_cast<std::int64_t>(length);
      continue;
    }
    used.row_starts.push_back(start);
    used.independent.insert(used.independent.end(), {start, start + 1});
  }
  return used;
}

std::vector<double> picked(const std::vector<double>& values, const std::vector<std::size_t>& places) {
  std::vector<double> result;
  result.reserve(places.size());
  for (const std::size_t place : places) result.push_back(values[place]);
  return result;
}

SaltelliSample saltelli_sample(const PointInputs& point, const std::vector<double>& values,
                               const UsedTrials& used) {
  SaltelliSample sample;
  sample.c.resize(point.factors.size());
  for (const std::size_t start : used.row_starts) {
    sample.a.push_back(values[start]);
    sample.b.push_back(values[start + 1]);
    for (std::size_t j = 0; j < sample.c.size(); ++j) sample.c[j].push_back(values[start + 2 + j]);
  }
  return sample;
}

}  // namespace zerocount::sensitivity
