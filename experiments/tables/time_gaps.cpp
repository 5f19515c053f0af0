#include "experiments/tables/time_gaps.hpp"

#include <algorithm>

namespace zerocount::tables {
namespace {

constexpr std::size_t steps_on_a_side = 20;
constexpr std::size_t fewest_steps = 10;  // tell the usual one
constexpr double usual_quantile = 0.9;
constexpr double times_usual = 4.0;
constexpr std::size_t fewest_long_steps = 3;  // are rare in any record
constexpr double rare = 0.03;                 // of the steps

/// The 90 % quantile of the neighbouring steps of step `index`, without this step itself; 0 if there are too
/// few.
double usual_step(const std::vector<double>& steps, std::size_t index) {
  const std::size_t first = index - std::min(index, steps_on_a_side);
  const std::size_t end = std::min(steps.size(), index + 1 + steps_on_a_side);
  std::vector<double> about(steps.begin() + static_cast<std::ptrdiff_t>(first),
                            steps.begin() + static_cast<std::ptrdiff_t>(end));
  about.erase(about.begin() + static_cast<std::ptrdiff_t>(index - first));
  if (about.size() < fewest_steps) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(usual_quantile * static_cast<double>(about.size()));
  std::nth_element(about.begin(), about.begin() + place, about.end());
  return about[static_cast<std::size_t>(place)];
}

bool is_rare(const std::vector<double>& sorted_steps, double step) {
  const auto as_long =
      static_cast<std::size_t>(sorted_steps.end() - std::ranges::lower_bound(sorted_steps, 0.5 * step));
  return as_long <= fewest_long_steps ||
         static_cast<double>(as_long) <= rare * static_cast<double>(sorted_steps.size());
}

}  // namespace

std::vector<TimeGap> time_gaps(std::span<const double> times) {
  std::vector<double> steps;
  for (std::size_t row = 1; row < times.size(); ++row) steps.push_back(times[row] - times[row - 1]);
  if (steps.size() <= fewest_steps) return {};
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted);
  const bool all_alike = sorted.back() <= times_usual * sorted.front();
  if (all_alike) return {};
  std::vector<TimeGap> gaps;
  for (std::size_t index = 0; index < steps.size(); ++index) {
    const double usual = usual_step(steps, index);
    if (usual > 0.0 && steps[index] > times_usual * usual && is_rare(sorted, steps[index]))
      gaps.push_back({index + 1, steps[index], usual});
  }
  return gaps;
}

}  // namespace zerocount::tables
