#include "runners/tuning/limits.hpp"

#include <algorithm>
#include <initializer_list>

#include "core/failure/failure.hpp"
#include "experiments/rules/value_rules.hpp"
#include "runners/tuning/idealisations.hpp"

namespace zerocount::tuning {
namespace {

/// Why the idealisations together cannot be simulated; empty if they can.
std::string refusal_of(std::initializer_list<const Idealisation*> together, const study::PointEdit& at) {
  for (const Idealisation* one : together) {
    if (!one->refusal.empty()) return one->refusal;
  }
  return rules::refusal_of(at);
}

Limit limit_of(std::initializer_list<const Idealisation*> together, const study::Study& study,
               const trials::Replicates& units, const trials::Effort& effort) {
  study::PointEdit at(study, units.point);
  Limit limit;
  for (const Idealisation* one : together) {
    one->edit(at);
    limit.cause += (limit.cause.empty() ? "" : " and ") + one->cause;
    if (limit.note.empty()) limit.note = one->note;
  }
  if (const std::string refusal = refusal_of(together, at); !refusal.empty())
    return {limit.cause, std::nullopt, refusal};
  const Change change = [&](trial::TrialParameters& p) {
    for (const Idealisation* one : together) {
      if (one->change) one->change(p);
    }
  };
  try {
    limit.rate = rate_of(at.study(), units, units.count, &change, effort);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::bad_input) throw;
    return {limit.cause, std::nullopt, failure.what()};
  }
  return limit;
}

bool is_lower(const Limit& a, const Limit& b) {
  return a.rate < b.rate;  // one without a rate is below all others
}

}  // namespace

double rate_of(const study::Study& study, const trials::Replicates& units, std::int64_t count,
               const Change* change, const trials::Effort& effort) {
  const Candidate candidate{{}, {}, results_of(study, units, count, change, effort)};
  return estimate_of(aim_of(study), candidate, units.count).rate;
}

std::vector<Limit> limits_of(const study::Study& study, const trials::Replicates& units,
                             const trials::Effort& effort) {
  const std::vector<Idealisation> all = idealisations_of(study, units.point);
  std::vector<Limit> limits{{"none", rate_of(study, units, units.count, nullptr, effort)}};
  for (const Idealisation& one : all) limits.push_back(limit_of({&one}, study, units, effort));
  Limit best = *std::ranges::max_element(limits, is_lower);
  const double best_alone = *best.rate;
  for (auto a = all.begin(); a != all.end(); ++a) {
    for (auto b = a + 1; b != all.end() && *best.rate < 1.0; ++b)
      best = std::max(best, limit_of({&*a, &*b}, study, units, effort), is_lower);
  }
  if (*best.rate > best_alone) limits.push_back(best);
  return limits;
}

}  // namespace zerocount::tuning
