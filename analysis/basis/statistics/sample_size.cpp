#include "analysis/basis/statistics/sample_size.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/special_functions/beta.hpp>
#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/machine_statistics.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::statistics {
namespace {

constexpr std::int64_t max_planned_trials = 1'000'000'000'000;
constexpr std::int64_t max_failures = 1'000'000'000;
constexpr std::int64_t max_machines = 1'000'000'000;

void require_halfwidth(double halfwidth) {
  if (halfwidth > 0.0 && halfwidth < 0.5) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("a half-width of {}; expected a number between 0 and 0.5", halfwidth));
}

/// The smallest number from `low` up to `limit` for which `holds` is true; `holds` must change only once,
/// from false to true.
/// @throws Failure (bad_input) with the text `refusal` if there is none
template <typename Predicate>
std::int64_t least(std::int64_t low, std::int64_t limit, const std::string& refusal, const Predicate& holds) {
  const std::int64_t found = numerics::first_where_by_doubling(low, limit + 1, holds);
  if (found > limit) throw Failure(ExitCode::bad_input, refusal);
  return found;
}

std::string too_many_trials(const char* what) {
  return fmt::format("{} would need more than {} trials", what, max_planned_trials);
}

/// Half the length of the Clopper–Pearson interval if n·rate of n trials succeed, as a continuous function of
/// n.
double halfwidth_of(double n, double rate, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  const double successes = n * rate;
  return 0.5 * (upper_bound_on_p(successes, n, tail) - lower_bound_on_p(successes, n, tail));
}

/// Expected sums over machines as clusters, if the machines' success probabilities have the mean `rate` and
/// the standard deviation `machine_sd`.
/// @param trials number of trials of each machine
ClusterSums expected_sums(double rate, double machine_sd, double machines, double trials) {
  const double of_trials = rate * (1.0 - rate) - machine_sd * machine_sd;
  const double variance =
      trials * trials * machine_sd * machine_sd + trials * of_trials;  // of a machine's successes
  const double n = machines * trials;
  ClusterSums sums;
  sums.clusters = std::llround(machines);
  sums.events = std::llround(n);
  sums.hits = std::llround(n * rate);
  const double p = static_cast<double>(sums.hits) / static_cast<double>(sums.events);
  sums.events_squared = machines * trials * trials;
  sums.hits_by_events = static_cast<double>(sums.hits) * trials;
  sums.hits_squared = (machines - 1.0) * variance + machines * trials * trials * p * p;
  return sums;
}

double halfwidth_of(double rate, double machine_sd, std::int64_t machines, std::int64_t trials,
                    double confidence) {
  const ClusterSums sums =
      expected_sums(rate, machine_sd, static_cast<double>(machines), static_cast<double>(trials));
  return clustered_proportion(sums, confidence).korn_graubard.half_width();
}

}  // namespace

std::int64_t trials_for_claim(double success, double confidence, std::int64_t failures) {
  require_open_unit("success rate", success);
  require_confidence(confidence);
  if (failures < 0)
    throw Failure(ExitCode::bad_input, fmt::format("{} failures; expected 0 or more", failures));
  return least(failures + 1, max_planned_trials, too_many_trials("the claim"), [&](std::int64_t trials) {
    return chance_of_claim(trials, failures, success) <= 1.0 - confidence;
  });
}

double chance_of_claim(std::int64_t trials, std::int64_t failures, double true_success) {
  if (failures >= trials) return 1.0;
  // P(B ≤ r): the (r + 1)-th smallest of n uniform numbers is larger than 1 − success.
  return boost::math::ibeta(static_cast<double>(trials - failures), static_cast<double>(failures) + 1.0,
                            true_success);
}

ClaimPlan plan_with_power(double success, double confidence, double true_success, double power) {
  require_open_unit("success rate", success);
  require_open_unit("true success rate", true_success);
  require_open_unit("power", power);
  if (!(true_success > success)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("a true success rate of {} does not exceed the {} that is claimed; no number of "
                    "trials would show it",
                    true_success, success));
  }
  const std::int64_t failures =
      least(0, max_failures, too_many_trials("the power"), [&](std::int64_t allowed) {
        return chance_of_claim(trials_for_claim(success, confidence, allowed), allowed, true_success) >=
               power;
      });
  return {failures, trials_for_claim(success, confidence, failures)};
}

std::int64_t trials_for_halfwidth(double halfwidth, double confidence, double rate) {
  require_halfwidth(halfwidth);
  require_confidence(confidence);
  require_open_unit("success rate", rate);
  return least(1, max_planned_trials, too_many_trials("the half-width"), [&](std::int64_t trials) {
    return halfwidth_of(static_cast<double>(trials), rate, confidence) <= halfwidth;
  });
}

std::int64_t machines_for_halfwidth(double halfwidth, double confidence, double rate, double machine_sd,
                                    std::int64_t trials_per_machine) {
  require_confidence(confidence);
  require_open_unit("success rate", rate);
  require_halfwidth(halfwidth);
  if (!(machine_sd >= 0.0 && machine_sd * machine_sd <= rate * (1.0 - rate))) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("a standard deviation of {} between machines; with a success rate of {} it is from 0 "
                    "to {:.4g}",
                    machine_sd, rate, std::sqrt(rate * (1.0 - rate))));
  }
  const std::string refusal = fmt::format("the half-width would need more than {} machines", max_machines);
  return least(2, max_machines, refusal, [&](std::int64_t machines) {
    return halfwidth_of(rate, machine_sd, machines, trials_per_machine, confidence) <= halfwidth;
  });
}

SequentialCost sequential_cost(double halfwidth, double confidence, double rate, std::int64_t block) {
  constexpr double out_of = 1e9;
  const auto successes = static_cast<std::int64_t>(std::llround(rate * out_of));
  return {rate, trials_for_halfwidth(halfwidth, confidence, rate),
          projected_trials(successes, static_cast<std::int64_t>(out_of), halfwidth, confidence, block,
                           max_planned_trials)};
}

MachinePlan plan_tolerance(double content, double success, double confidence, std::int64_t machines) {
  require_confidence(confidence);
  require_open_unit("proportion of machines", content);
  require_open_unit("success rate", success);
  const std::int64_t fewest = min_machines_for_tolerance(content, confidence);
  if (machines == 0) machines = fewest + (fewest + 1) / 2;
  if (machines < fewest) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{} machines cannot show something of {} of all machines with {} confidence; "
                              "expected {} or more",
                              machines, text::percent(content), text::percent(confidence), fewest));
  }
  const double allowance = tolerance_allowance(machines, content, confidence);
  // Without a failure in m trials the bound is allowance^(1/m).
  return {machines,
          std::max<std::int64_t>(
              1, static_cast<std::int64_t>(std::ceil(std::log(allowance) / std::log(success) - 1e-9)))};
}

}  // namespace zerocount::statistics
