#include "experiments/study/draws.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/numerics/dense.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/designs/designs.hpp"
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

double design_uniform(Design design, const SlotRandomness& randomness, std::uint32_t stream,
                      std::uint64_t index, std::uint64_t count) {
  const random::RandomStream numbers{.key = randomness.key, .stream = stream};
  switch (design) {
    case Design::latin_hypercube:
      return designs::latin_uniform(index, count, numbers);
    case Design::sobol:
      return designs::sobol_uniform(index, randomness.directions, numbers);
    case Design::monte_carlo:
    case Design::saltelli:
      break;
  }
  return random::open_uniform(random::random_bits(numbers, index, random::Draw::trial));
}

bool trials_stay_when_extended(Design design) {
  switch (design) {
    case Design::latin_hypercube:
      return false;
    case Design::monte_carlo:
    case Design::sobol:
    case Design::saltelli:
      break;
  }
  return true;
}

random::RandomKey sobol_place_key(std::uint64_t seed, Grouping grouping) {
  // The slash keeps it apart from names of parameters. Machines were called rigs when the name was chosen;
  // another name would be other random numbers.
  const std::string groups =
      grouping == Grouping::machine ? "rigs" : fmt::format("{}s", traits_of(grouping).name);
  return designs::random_key(seed, groups + "/places");
}

std::uint64_t sobol_place(const random::RandomKey& key, std::uint64_t index, std::uint64_t machines) {
  const std::uint64_t round = index / machines;
  const random::RandomStream order{.key = key, .stream = static_cast<std::uint32_t>(round)};
  return round * machines + designs::latin_stratum(index % machines, machines, order);
}

std::uint64_t place_in_groups(Design design, const random::RandomKey& key, std::uint64_t unit,
                              std::uint64_t groups) {
  return design == Design::sobol && groups > 0 ? sobol_place(key, unit, groups) : unit;
}

}  // namespace zerocount::study
