#include "runners/tuning/retuning.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::tuning {

std::vector<LifeInterval> intervals_of_life(const study::Ages& ages, double every) {
  const double last = ages.at.back();
  const double first_cut = std::floor(ages.at.front() / every) + 1.0;  // in multiples of `every`
  const double cuts = std::max(std::ceil(last / every) - first_cut, 0.0);
  if (cuts < 1.0 || cuts >= static_cast<double>(max_life_intervals))
    throw Failure(ExitCode::bad_input,
                  fmt::format("option '--retune-every': the ages from {} to {} have {} interval{} of {}; "
                              "expected 2 to {}",
                              fmt::format("{:g}", ages.at.front()), study::age_text(ages, last), cuts + 1.0,
                              cuts < 1.0 ? "" : "s", study::age_text(ages, every), max_life_intervals));
  std::vector<LifeInterval> intervals;
  for (double cut = 0.0; cut <= cuts; cut += 1.0) {
    const double from = cut == 0.0 ? ages.at.front() : (first_cut + cut - 1.0) * every;
    const double to = cut == cuts ? last : (first_cut + cut) * every;
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
