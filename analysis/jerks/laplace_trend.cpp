#include "analysis/jerks/laplace_trend.hpp"

#include <cmath>
#include <numeric>

#include "analysis/statistics/normal.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"

namespace zerocount::jerks {

LaplaceTerm laplace_term(std::span<const std::int64_t> instants, std::int64_t size) {
  const auto n = static_cast<double>(instants.size());
  const auto m = static_cast<double>(size);
  const auto sum = static_cast<double>(std::accumulate(instants.begin(), instants.end(), std::int64_t{0}));
  return {std::ssize(instants), sum - 0.5 * n * (m + 1.0), n * (m + 1.0) * (m - n) / 12.0};
}

double laplace_score(const LaplaceTerm& term) {
  if (!(term.variance > 0.0)) return statistics::unknown;
  return term.excess / std::sqrt(term.variance);
}

LaplaceSum::LaplaceSum(double confidence) {
  statistics::require_confidence(confidence);
  critical_ = statistics::normal_quantile(confidence);
}

void LaplaceSum::add(const LaplaceTerm& term) {
  const double score = laplace_score(term);
  if (std::isnan(score)) return;
  ++counted_.moves;
  excess_ += term.excess;
  variance_ += term.variance;
  scores_ += score;
  if (term.events < min_laplace_events) return;
  ++counted_.tested;
  counted_.slowing += score < -critical_;
  counted_.quickening += score > critical_;
}

LaplaceSummary LaplaceSum::summary() const {
  LaplaceSummary result = counted_;
  if (result.moves == 0) return result;
  result.summed = excess_ / std::sqrt(variance_);
  result.stouffer = scores_ / std::sqrt(static_cast<double>(result.moves));
  result.p_slowing = statistics::normal_upper_tail(-result.summed);
  return result;
}

}  // namespace zerocount::jerks
