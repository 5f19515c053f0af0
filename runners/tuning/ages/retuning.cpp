#include "runners/tuning/ages/retuning.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::tuning {

namespace {

constexpr double rounding = 1e-9;  // relative, of a multiple

/// The multiple as a user would write it: 3 times 0.1 is 0.3. An age of the study that is as near is it.
double multiple_of(double every, double times, const std::vector<double>& ages) {
  const double product = times * every;
  for (const double age : ages) {
    if (std::abs(age - product) <= rounding * product) return age;
  }
  const double unit = std::pow(10.0, 11.0 - std::floor(std::log10(product)));
  const double digits = std::round(product * unit);
  return std::isfinite(digits / unit) ? digits / unit : product;
}

}  // namespace

std::vector<LifeInterval> intervals_of_life(const study::Ages& ages, double every) {
  const double last = ages.at.back();
  // In multiples of `every`; those that are an end of the life are no cuts.
  const double first_cut = std::floor(ages.at.front() / every * (1.0 + rounding)) + 1.0;
  const double cuts = std::max(std::ceil(last / every * (1.0 - rounding)) - first_cut, 0.0);
  if (cuts < 1.0 || cuts >= static_cast<double>(max_life_intervals))
    throw Failure(ExitCode::bad_input,
                  fmt::format("option '--retune-every': the ages from {} to {} have {} interval{} of {}; "
                              "expected 2 to {}",
                              fmt::format("{:g}", ages.at.front()), study::age_text(ages, last), cuts + 1.0,
                              cuts < 1.0 ? "" : "s", study::age_text(ages, every), max_life_intervals));
  std::vector<LifeInterval> intervals;
  for (double cut = 0.0; cut <= cuts; cut += 1.0) {
    const double from = cut == 0.0 ? ages.at.front() : multiple_of(every, first_cut + cut - 1.0, ages.at);
    const double to = cut == cuts ? last : multiple_of(every, first_cut + cut, ages.at);
    LifeInterval interval{{from}};
    for (const double age : ages.at) {
      if (age > from && age < to) interval.ages.push_back(age);
    }
    interval.ages.push_back(to);
    intervals.push_back(std::move(interval));
  }
  return intervals;
}

study::Study study_in(const study::Study& study, const LifeInterval& interval) {
  const std::int64_t of_age = study.trials / std::ssize(study.ages.at);
  std::vector<std::string> overrides{fmt::format("ages.at={}", ages_value(interval.ages)),
                                     fmt::format("trials={}", of_age * std::ssize(interval.ages))};
  if (!study.retained_trials.empty()) overrides.emplace_back("retain={trials: []}");
  return trials::variant_of(study, overrides);
}

std::size_t first_affordable(std::span<const std::int64_t> least, std::int64_t trials) {
  std::size_t first = least.size();
  while (first > 0 && least[first - 1] <= trials) trials -= least[--first];
  return first;
}

std::size_t worst_claim_at(const study::Study& study, const AgeVerdict& age) {
  const std::vector<ClaimOfLife> claims = claims_of_life(study);
  const auto merit = [&](std::size_t claim) {
    const study::Goal& goal = study.goals[claims[claim].goal];
    return std::tuple(goal::rank_of(age.statuses[claim]),
                      age.rates[claim].low - goal.machines.value_or(goal.moves));
  };
  std::size_t worst = 0;
  for (std::size_t claim = 1; claim < claims.size(); ++claim) {
    if (merit(claim) < merit(worst)) worst = claim;
  }
  return worst;
}

bool is_met_at(const AgeVerdict& age) {
  return std::ranges::all_of(age.statuses, [](goal::Status status) { return status == goal::Status::met; });
}

}  // namespace zerocount::tuning
