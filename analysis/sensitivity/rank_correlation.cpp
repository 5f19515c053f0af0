#include "analysis/sensitivity/rank_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "analysis/statistics/distributions.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr std::size_t min_values = 10;

// The values of a sample as ranks.
struct Ranks {
  std::vector<std::size_t> order;  // indices, by ascending value
  std::vector<double> middle;      // [i]: its mid-distribution
};

std::vector<std::size_t> ascending_order(std::span<const double> values) {
  std::vector<std::pair<double, std::size_t>> sorted;
  sorted.reserve(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) sorted.emplace_back(values[i], i);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::size_t> order;
  order.reserve(values.size());
  for (const auto& [value, index] : sorted) order.push_back(index);
  return order;
}

// Calls visit(first, last) for each run of equal values in the order.
template <class Visit>
void visit_ties(std::span<const double> values, const std::vector<std::size_t>& order, const Visit& visit) {
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first + 1;
    while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
    visit(first, last);
    first = last;
  }
}

Ranks ranked(std::span<const double> values) {
  Ranks ranks{ascending_order(values), std::vector<double>(values.size())};
  visit_ties(values, ranks.order, [&](std::size_t first, std::size_t last) {
    const double middle = 0.5 * static_cast<double>(first + last) / static_cast<double>(values.size());
    for (std::size_t place = first; place < last; ++place) ranks.middle[ranks.order[place]] = middle;
  });
  return ranks;
}

// [i]: 1/n Σ_l m(x_i, x_l) weight_l.
std::vector<double> mean_above(const Ranks& x, std::span<const double> weight) {
  std::vector<double> means(weight.size());
  double above = std::accumulate(weight.begin(), weight.end(), 0.0);
  visit_ties(x.middle, x.order, [&](std::size_t first, std::size_t last) {
    double tied = 0.0;
    for (std::size_t place = first; place < last; ++place) tied += weight[x.order[place]];
    above -= tied;
    for (std::size_t place = first; place < last; ++place) {
      means[x.order[place]] = (above + 0.5 * tied) / static_cast<double>(weight.size());
    }
  });
  return means;
}

// E[F·G] − ¼ of two mid-distributions, with its influence function.
struct CoMoment {
  double value{0.0};
  std::vector<double> influence;
};

CoMoment co_moment(const Ranks& x, const Ranks& y) {
  const std::vector<double>& f = x.middle;
  const std::vector<double>& g = y.middle;
  const double n = static_cast<double>(f.size());
  const double product = std::inner_product(f.begin(), f.end(), g.begin(), 0.0) / n;
  const std::vector<double> along_f = mean_above(x, g);
  const std::vector<double> along_g = mean_above(y, f);
  CoMoment moment{product - 0.25, std::vector<double>(f.size())};
  for (std::size_t i = 0; i < f.size(); ++i) {
    moment.influence[i] = f[i] * g[i] + along_f[i] + along_g[i] - 3.0 * product;
  }
  return moment;
}

}  // namespace

bool is_constant(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); });
}

std::vector<double> mid_distribution(std::span<const double> values) {
  return ranked(values).middle;
}

BoundedNumber fisher_bounds(double correlation, double standard_error, double confidence) {
  const double slope = 1.0 - correlation * correlation;
  if (!(slope > 0.0)) return {correlation, correlation, correlation};
  const double half = statistics::two_sided_normal_quantile(confidence) * standard_error / slope;
  const double middle = std::atanh(correlation);
  return {correlation, std::tanh(middle - half), std::tanh(middle + half)};
}

BoundedNumber rank_correlation(std::span<const double> x, std::span<const double> y, double confidence) {
  if (x.size() < min_values) return {};
  if (is_constant(x) || is_constant(y)) return {};
  const Ranks ranked_x = ranked(x);
  const Ranks ranked_y = ranked(y);
  const CoMoment together = co_moment(ranked_x, ranked_y);
  const CoMoment of_x = co_moment(ranked_x, ranked_x);
  const CoMoment of_y = co_moment(ranked_y, ranked_y);
  const double scale = std::sqrt(of_x.value * of_y.value);
  const double correlation = std::clamp(together.value / scale, -1.0, 1.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double influence =
        together.influence[i] / scale -
        0.5 * correlation * (of_x.influence[i] / of_x.value + of_y.influence[i] / of_y.value);
    squares += influence * influence;
  }
  const double n = static_cast<double>(x.size());
  return fisher_bounds(correlation, std::sqrt(squares / (n * (n - 3.0))), confidence);
}

}  // namespace zerocount::sensitivity
