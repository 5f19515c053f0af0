#include "experiments/study/copula.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/numerics/dense.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/study/sampling.hpp"

namespace zerocount::study {

std::optional<SquareMatrix> cholesky_factor(const SquareMatrix& correlations) {
  constexpr double min_pivot = 1e-6;  // of L: below it a value would follow from the others
  const auto size = static_cast<Eigen::Index>(correlations.size());
  Eigen::MatrixXd matrix(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    matrix.row(i) = Eigen::RowVectorXd::Map(correlations[static_cast<std::size_t>(i)].data(), size);
  matrix = numerics::cholesky_factor(matrix);
  if (!(matrix.diagonal().minCoeff() >= min_pivot)) return std::nullopt;
  SquareMatrix factor = correlations;
  for (Eigen::Index i = 0; i < size; ++i)
    Eigen::RowVectorXd::Map(factor[static_cast<std::size_t>(i)].data(), size) = matrix.row(i);
  return factor;
}

double copula_uniform(const GaussianCopula& copula, std::size_t member,
                      const std::function<double(std::size_t)>& independent) {
  const std::vector<double>& row = copula.factor[member];
  if (std::all_of(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(member),
                  [](double x) { return x == 0.0; }))
    return independent(member);
  double score = 0.0;
  for (std::size_t j = 0; j <= member; ++j) {
    if (row[j] != 0.0) score += row[j] * numerics::normal_quantile(independent(j));
  }
  return std::clamp(numerics::normal_probability(score), 0x1p-53, 1.0 - 0x1p-53);
}

std::string correlations_text(const std::vector<Correlation>& correlations) {
  std::string text;
  for (const auto& [first, second, coefficient] : correlations) {
    text += fmt::format("{}{} and {} ({})", text.empty() ? "" : ", ", first, second, coefficient);
  }
  return text;
}

std::string samples_text(const JointSamples& samples) {
  constexpr std::array<std::string_view, 5> names{"the study", "each world", "each machine", "each trial",
                                                  "each contact"};
  return fmt::format("{}: a row of {} ({} draw{}) for {}", fmt::join(samples.parameters, ", "), samples.file,
                     samples.rows, samples.rows == 1 ? "" : "s",
                     names[static_cast<std::size_t>(samples.level)]);
}

}  // namespace zerocount::study
