#include "runners/tuning/ages/lost_ages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/numerics/roots.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/search/proof_runner.hpp"

namespace zerocount::tuning {
namespace {

constexpr double precision_of_age = 1.1;  // of an age
constexpr double decade = 10.0;
constexpr int max_decades = 6;  // beyond the last age of the study
constexpr int max_steps = 6;    // between two ages

/// An age to try between two ages, to three significant digits: their geometric mean, or a tenth of the older
/// age if the younger is 0. Ages are in the unit of the study.
double age_between(double younger, double older) {
  return to_three_digits(younger == 0.0 ? older / decade : numerics::geometric_mean(younger, older));
}

/// Function that tells from the verdict at an age whether a claim still holds there: by its rate, by its
/// lower bound or by its upper bound (LostClaim).
using Holds = std::function<bool(const AgeVerdict&)>;

class LifeOfClaims {
 public:
  LifeOfClaims(const study::Study& study, const trials::Replicates& machines, trials::Effort effort)
      : study_(study),
        machines_(machines),
        seed_(trials::fresh_seed(study.seed, "tuning, ages")),
        effort_(std::move(effort)) {}

  LostAges found() {
    run_study_ages();
    run_decades();
    const std::size_t claims = tried_.front().claims.size();
    for (std::size_t claim = 0; claim < claims; ++claim) {
      for (const Holds& holds : senses_of(claim)) refine(holds);
    }
    LostAges all;
    for (std::size_t claim = 0; claim < claims; ++claim) all.claims.push_back(lost_claim(claim));
    all.tried = std::move(tried_);
    all.refusal = std::move(refusal_);
    all.machines = machines_.count;
    return all;
  }

 private:
  study::Study at_age(double age) const {
    std::vector<std::string> overrides{fmt::format("ages.at=[{}]", age), fmt::format("seed={}", seed_)};
    for (std::string& one : trials::overrides_for(study_, machines_)) overrides.push_back(std::move(one));
    return trials::variant_of(study_, overrides);
  }

  /// Error message that says why the study cannot be simulated at this age; empty if it can.
  std::string refusal_at(double age) const {
    try {
      at_age(age);
      return "";
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::bad_input) throw;
      const std::string message = failure.what();
      return message.substr(0, message.find('\n'));
    }
  }

  void run(double age) {
    const auto place = std::ranges::lower_bound(tried_, age, {}, &AgeVerdict::age);
    if (place != tried_.end() && place->age == age) return;
    const study::Study study = at_age(age);
    const auto results = results_of(study, machines_, machines_.count, nullptr, effort_);
    tried_.insert(place, {age, judged(study, machines_, results).verdict.claims});
  }

  void run_study_ages() {
    const std::vector<double>& ages = study_.settings.ages.at;
    for (std::size_t i = 0; i < ages.size(); ++i) {
      run(ages[i]);
      if (i + 1 < ages.size()) {
        const double between = age_between(ages[i], ages[i + 1]);
        if (between > ages[i] && between < ages[i + 1]) run(between);
      }
    }
  }

  bool all_are_missed() const {
    return std::ranges::all_of(tried_.back().claims, [](const goal::ClaimVerdict& claim) {
      return claim.status == goal::Status::missed;
    });
  }

  void run_decades() {
    const double last = study_.settings.ages.at.back();
    double age = last > 0.0 ? last : 1.0;
    for (int i = 0; i < max_decades && !all_are_missed(); ++i) {
      const double younger = age;
      age = to_three_digits(decade * age);
      refusal_ = refusal_at(age);
      if (!refusal_.empty()) {
        run(oldest_allowed(younger, age));
        return;
      }
      run(age);
    }
  }

  /// Oldest age at which the study can be simulated, within 2 % and to three significant digits.
  /// @param allowed an age at which it can be simulated
  /// @param refused an older age at which it cannot
  double oldest_allowed(double allowed, double refused) const {
    constexpr double narrow = 1.02;
    const auto is_allowed = [this](double age) { return refusal_at(age).empty(); };
    return numerics::bisect(
               {allowed, refused}, is_allowed,
               [](const numerics::Bracket& ages) { return ages.fails <= narrow * ages.holds; },
               [](double a, double b) { return to_three_digits(numerics::geometric_mean(a, b)); })
        .holds;
  }

  std::array<Holds, 3> senses_of(std::size_t claim) const {
    const study::Goal& goal = study_.goals[tried_.front().claims[claim].goal];
    return {[=, &goal](const AgeVerdict& at) {
              return goal::judged_rate(goal, at.claims[claim]).value >= study::demanded_proportion(goal);
            },
            [=](const AgeVerdict& at) { return at.claims[claim].status == goal::Status::met; },
            [=](const AgeVerdict& at) { return at.claims[claim].status != goal::Status::missed; }};
  }

  /// Simulates ages between the last age at which `holds` is true and the next simulated age, until the two
  /// neighbouring ages differ by at most 10 %.
  void refine(const Holds& holds) {
    int steps = 0;
    for (int from_zero = 0; steps < max_steps && from_zero < max_decades;) {
      const auto lost = std::ranges::find_if_not(tried_, holds);
      if (lost == tried_.begin() || lost == tried_.end()) return;
      const double younger = std::prev(lost)->age;
      const double middle = age_between(younger, lost->age);
      if (lost->age <= precision_of_age * younger || middle <= younger || middle >= lost->age) return;
      run(middle);
      ++(younger == 0.0 ? from_zero : steps);
    }
  }

  LostClaim lost_claim(std::size_t claim) const {
    const auto [seems_met, is_met, may_be_met] = senses_of(claim);
    const goal::ClaimVerdict& first = tried_.front().claims[claim];
    LostClaim life{{first.goal, first.setting}};
    if (const auto lost = std::ranges::find_if_not(tried_, seems_met); lost != tried_.end())
      life.lost = lost->age;
    if (const auto unsure = std::ranges::find_if_not(tried_, is_met); unsure != tried_.begin())
      life.met_until = std::prev(unsure)->age;
    if (const auto missed = std::ranges::find_if_not(tried_, may_be_met); missed != tried_.end())
      life.missed_from = missed->age;
    return life;
  }

  const study::Study& study_;
  trials::Replicates machines_;
  std::uint64_t seed_;
  trials::Effort effort_;
  std::vector<AgeVerdict> tried_;  ///< Verdicts on the ages simulated so far, in ascending order of age.
  std::string refusal_;
};

}  // namespace

std::string text_of(const study::Study& study, const ClaimPlace& claim) {
  std::string text;
  if (study.goals.size() > 1) text = fmt::format(" '{}'", study.goals[claim.goal].name);
  return text +
         study::setting_phrase(study::without_ages(study.settings), static_cast<std::int64_t>(claim.setting));
}

std::int64_t trials_at_one_age(const study::Study& study, std::int64_t trials_each) {
  return trials_each / std::ssize(study.settings.ages.at);
}

LostAges lost_ages(const study::Study& study, const trials::Replicates& machines, trials::Effort effort) {
  return LifeOfClaims(study, machines, std::move(effort)).found();
}

std::int64_t points_of_lost_ages(const study::Study& study) {
  constexpr std::int64_t of_claim = 14;
  return 2 * std::ssize(study.settings.ages.at) + max_decades +
         of_claim * std::ssize(study.goals) * study::without_ages(study.settings).total();
}

}  // namespace zerocount::tuning
