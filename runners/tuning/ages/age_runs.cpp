#include "runners/tuning/ages/age_runs.hpp"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

std::vector<ClaimOfLife> claims_of_life(const study::Study& study) {
  const auto conditions = static_cast<std::size_t>(study::conditions_of_age(study));
  std::vector<ClaimOfLife> claims;
  for (std::size_t goal = 0; goal < study.goals.size(); ++goal) {
    for (std::size_t condition = 0; condition < conditions; ++condition) claims.push_back({goal, condition});
  }
  return claims;
}

std::string text_of(const study::Study& study, const ClaimOfLife& claim) {
  std::string text;
  if (study.goals.size() > 1) text = fmt::format(" '{}'", study.goals[claim.goal].name);
  if (!study.condition_names.empty()) text += " under condition " + study.condition_names[claim.condition];
  return text;
}

std::string ages_value(const std::vector<double>& ages) {
  return fmt::format("[{}]", fmt::join(ages, ","));
}

AgeRuns::AgeRuns(const study::Study& study, const trials::Replicates& units, std::string_view purpose,
                 trials::Effort effort)
    : study_(study),
      units_(units),
      seed_(trials::fresh_seed(study.seed, purpose)),
      effort_(std::move(effort)) {}

study::Study AgeRuns::at_age(double age) const {
  std::vector<std::string> overrides{fmt::format("ages.at={}", ages_value({age})),
                                     fmt::format("seed={}", seed_)};
  for (std::string& one : trials::overrides_for(study_, units_)) overrides.push_back(std::move(one));
  return trials::variant_of(study_, overrides);
}

std::string AgeRuns::refusal_at(double age) const {
  try {
    at_age(age);
    return "";
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::bad_input) throw;
    const std::string message = failure.what();
    return message.substr(0, message.find('\n'));
  }
}

AgeVerdict AgeRuns::at(double age, const std::vector<study::FreeParameter>& free,
                       const Values& values) const {
  const study::Study study = at_values(at_age(age), free, values).value();
  const Candidate candidate{{}, values, results_of(study, units_, units_.count, nullptr, effort_)};
  const goal::Verdict verdict = goal::judge_goals(study.goals, counts_of(study, units_, candidate.units), 1);
  AgeVerdict found;
  found.age = age;
  for (const goal::ClaimVerdict& claim : goal::claims_of(verdict)) {
    const bool of_machines = study.goals[claim.goal].machines.has_value();
    found.rates.push_back(of_machines ? claim.verdict->machines : claim.verdict->moves);
    found.statuses.push_back(claim.verdict->status);
  }
  found.criterion = estimate_of(aim_of(study), candidate, units_.count).criterion;
  return found;
}

std::int64_t trials_at_one_age(const study::Study& study, std::int64_t trials_each) {
  return trials_each / std::ssize(study.ages.at);
}

}  // namespace zerocount::tuning
