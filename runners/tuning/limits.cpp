#include "runners/tuning/limits.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/condition_study.hpp"
#include "runners/tuning/idealisations.hpp"

namespace zerocount::tuning {
namespace {

/// A cause of failures, under each condition that has it.
struct Cause {
  std::string name;
  std::vector<std::optional<Idealisation>> under;  ///< [condition]
};

/// Limits of a point, of which each condition is a study of its own.
class PointLimits {
 public:
  PointLimits(const study::Study& study, const trials::Replicates& units, trials::Effort effort)
      : study_(study), aim_(aim_of(study)), units_(units), effort_(std::move(effort)) {
    for (std::int64_t condition = 0; condition < study::condition_count(study); ++condition)
      conditions_.push_back(under_condition(study, condition));
    units_.trials_each /= std::ssize(conditions_);
    for (std::size_t condition = 0; condition < conditions_.size(); ++condition) {
      for (Idealisation& one : idealisations_of(conditions_[condition], units_.point)) add(condition, one);
    }
  }

  std::vector<Limit> limits() const {
    std::vector<Limit> limits{limit_of({})};
    for (const Cause& one : causes_) limits.push_back(limit_of({&one}));
    Limit best = *std::ranges::max_element(limits, is_lower);
    const Limit best_alone = best;
    for (auto a = causes_.begin(); a != causes_.end(); ++a) {
      for (auto b = a + 1; b != causes_.end() && !misses_nothing(best); ++b)
        best = std::max(best, limit_of({&*a, &*b}), is_lower);
    }
    if (is_lower(best_alone, best)) limits.push_back(best);
    return limits;
  }

 private:
  void add(std::size_t condition, Idealisation& idealisation) {
    auto cause = std::ranges::find(causes_, idealisation.cause, &Cause::name);
    if (cause == causes_.end()) {
      causes_.push_back({idealisation.cause, {}});
      causes_.back().under.resize(conditions_.size());
      cause = causes_.end() - 1;
    }
    cause->under[condition] = std::move(idealisation);
  }

  Limit limit_of(std::initializer_list<const Cause*> together) const {
    Limit limit;
    for (const Cause* one : together) limit.cause += (limit.cause.empty() ? "" : " and ") + one->name;
    if (limit.cause.empty()) limit.cause = "none";
    Candidate candidate;
    candidate.units.resize(static_cast<std::size_t>(units_.count));
    try {
      for (std::size_t condition = 0; condition < conditions_.size(); ++condition) {
        const std::string refusal = add_results(together, condition, limit, candidate.units);
        if (!refusal.empty()) return {limit.cause, std::nullopt, refusal};
      }
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::bad_input) throw;
      return {limit.cause, std::nullopt, failure.what()};
    }
    limit.estimate = estimate_of(aim_, candidate, units_.count);
    limit.rate = limit.estimate.rate;
    if (has_named_claims(study_)) name_claims(limit);
    return limit;
  }

  void name_claims(Limit& limit) const {
    const ClaimPlace worst = place_of_claim(study_, limit.estimate.worst);
    limit.goal = goal_name(study_, worst);
    limit.condition = condition_name(study_, worst);
    limit.rates.emplace();
    for (std::size_t claim = 0; claim < aim_.claims.size(); ++claim) {
      const ClaimPlace place = place_of_claim(study_, claim);
      const std::optional<std::string> goal = goal_name(study_, place);
      const std::optional<std::string> condition = condition_name(study_, place);
      limit.rates->emplace_back(
          fmt::format("{}{}{}", goal.value_or(""), goal && condition ? ", " : "", condition.value_or("")),
          limit.estimate.rates[claim]);
    }
  }

  /// Adds what the units do under a condition without these causes. Returns why it cannot be simulated, or
  /// nothing.
  std::string add_results(std::initializer_list<const Cause*> together, std::size_t condition, Limit& limit,
                          std::vector<UnitResult>& units) const {
    study::PointEdit at(conditions_[condition], units_.point);
    std::vector<const Idealisation*> switched_off;
    for (const Cause* one : together) {
      if (one->under[condition]) switched_off.push_back(&*one->under[condition]);
    }
    for (const Idealisation* one : switched_off) {
      one->edit(at);
      if (limit.note.empty()) limit.note = one->note;
    }
    for (const Idealisation* one : switched_off) {
      if (!one->refusal.empty()) return one->refusal;
    }
    if (std::string refusal = rules::refusal_of(at); !switched_off.empty() && !refusal.empty())
      return refusal;
    const Change change = [&](trial::TrialParameters& p) {
      for (const Idealisation* one : switched_off) {
        if (one->change) one->change(p);
      }
    };
    const std::vector<UnitResult> results = results_of(at.study(), units_, units_.count, &change, effort_);
    const std::size_t conditions = conditions_.size();
    for (std::size_t unit = 0; unit < units.size(); ++unit) {
      units[unit].claims.resize(aim_.claims.size());
      units[unit].slid = units[unit].slid || results[unit].slid;
      for (std::size_t goal = 0; goal < results[unit].claims.size(); ++goal)
        units[unit].claims[goal * conditions + condition] = results[unit].claims[goal];
    }
    return "";
  }

  const study::Study& study_;
  Aim aim_;
  trials::Replicates units_;  ///< of each condition
  trials::Effort effort_;
  std::vector<study::Study> conditions_;
  std::vector<Cause> causes_;
};

}  // namespace

bool is_lower(const Limit& a, const Limit& b) {
  if (!a.rate || !b.rate) return b.rate.has_value() && !a.rate;
  return a.estimate.margin < b.estimate.margin;
}

bool misses_nothing(const Limit& limit) {
  return std::ranges::all_of(limit.estimate.rates, [](double rate) { return rate == 1.0; });
}

Estimate estimate_on(const study::Study& study, const trials::Replicates& units, std::int64_t count,
                     const Change* change, const trials::Effort& effort) {
  const Candidate candidate{{}, {}, results_of(study, units, count, change, effort)};
  return estimate_of(aim_of(study), candidate, units.count);
}

std::vector<Limit> limits_of(const study::Study& study, const trials::Replicates& units,
                             const trials::Effort& effort) {
  return PointLimits(study, units, effort).limits();
}

}  // namespace zerocount::tuning
