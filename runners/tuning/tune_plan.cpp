#include "runners/tuning/tune_plan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/search/study_search.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t max_machines = 2048;
constexpr std::int64_t default_search_trials = 500'000;
constexpr double search_part = 0.5;      // of a budget
constexpr double simulating_part = 0.7;  // of the time of a search; the rest examines margins
constexpr double spendable_part = 0.9;   // of the time; the rest starts and ends the proof
constexpr double judgement_part = 0.2;   // of the effort of another control
constexpr std::int64_t max_machines_of_judgement = 1000;
constexpr std::int64_t min_machines_of_judgement = 50;

SearchScope scope_of(const study::Study& study, std::span<const study::FreeParameter> free,
                     std::int64_t machines) {
  return {free.size(), zero_sets(free).size(), machines, study.worlds};
}

std::int64_t min_search_trials(const study::Study& study, std::span<const study::FreeParameter> free) {
  const SearchScope scope = scope_of(study, free, max_machines);
  return first_race_machines(smallest_search(scope), scope.faces) * search_trials_of_machine(study);
}

/// A number of trials as a whole number; the largest std::int64_t if it is infinite or too large.
std::int64_t whole_trials(double trials) {
  constexpr double largest = 1e15;
  return static_cast<std::int64_t>(std::min(trials, largest));
}

}  // namespace

std::int64_t affordable_trials(const trials::Effort& effort, double speed) {
  const double seconds = std::max(effort.seconds_left(), 0.0);
  if (std::isinf(seconds)) return effort.trials_left();
  return std::min(effort.trials_left(), whole_trials(speed * seconds));
}

double measured_speed(const study::Study& study, const trials::Effort& effort) {
  constexpr std::int64_t max_measured_machines = 512;
  constexpr double part_of_time = 0.05, longest_without_limit = 0.5;  // s
  using Clock = std::chrono::steady_clock;
  const trials::Replicates machines{trials::in_equal_worlds(study, max_measured_machines),
                                    search_trials_of_machine(study)};
  const study::Study measured = trials::variant_of(study, trials::overrides_for(study, machines));
  // Without a limit of time its trials do not count, because their number depends on the machine.
  const bool limited = !std::isinf(effort.seconds_left());
  const trials::Effort whole = limited ? effort : trials::Effort(effort.stop());
  const trials::Effort part =
      whole.limited_to({}, limited ? part_of_time * whole.seconds_left() : longest_without_limit);
  double fastest = 0.0;
  for (std::int64_t count = 8; count <= machines.count; count *= 2) {
    const Clock::time_point start = Clock::now();
    // The first ones run to their end: of trials that are cut off nobody knows how many ran.
    const trials::Effort& limit = fastest == 0.0 ? whole : part;
    const bool ended = trials::within(limit, [&] { results_of(measured, machines, count, nullptr, limit); });
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const double speed = static_cast<double>(count * machines.trials_each) / std::max(seconds, 1e-6);
    if (ended || fastest == 0.0) fastest = std::max(fastest, speed);
    if (!ended) break;
  }
  return fastest;
}

SearchSize default_search_size(const study::Study& study) {
  return search_size(scope_of(study, study.tuning->free, max_machines),
                     default_search_trials / search_trials_of_machine(study));
}

double default_search_seconds(const study::Study& study, const trials::Effort& effort) {
  return default_search_trials / (simulating_part * measured_speed(study, effort));
}

SearchPlan plan_search(const study::Study& study, const TuneBudget& budget, const trials::Effort& whole,
                       double speed) {
  const std::vector<study::FreeParameter>& free = study.tuning->free;
  const std::int64_t each = search_trials_of_machine(study);
  const SearchScope scope = scope_of(study, free, max_machines);
  if (!budget.trials && !budget.seconds)
    return {default_search_size(study), whole.limited_to(default_search_trials, {})};
  const std::int64_t search = min_search_trials(study, free);
  const std::int64_t proof = min_proof_trials(study, 1);  // in its first attempt
  const std::int64_t remaining = affordable_trials(whole, spendable_part * speed);
  if (remaining < search + proof) {
    const std::string needs = fmt::format(
        "the smallest search takes {} trials and the smallest proof of this goal {}", search, proof);
    if (budget.trials)
      throw Failure(ExitCode::bad_input,
                    fmt::format("option '--budget': {} trials are not enough: {}; expected at least {}",
                                *budget.trials, needs, search + proof));
    throw Failure(
        ExitCode::inconclusive,
        fmt::format("option '--budget': {:.3g} s are not enough: {}, about {:.3g} s on this machine",
                    *budget.seconds, needs, static_cast<double>(search + proof) / (spendable_part * speed)));
  }
  const auto half = static_cast<std::int64_t>(search_part * static_cast<double>(remaining));
  const std::int64_t trials = std::clamp(half, search, remaining - proof);
  if (budget.trials) return {search_size(scope, trials / each), whole.limited_to(trials, {})};
  const auto simulated = static_cast<std::int64_t>(simulating_part * static_cast<double>(trials));
  return {search_size(scope, simulated / each), whole.limited_to({}, search_part * whole.seconds_left())};
}

SearchPlan plan_other_search(const study::Study& study, std::span<const study::FreeParameter> free,
                             const trials::Effort& effort, double speed) {
  const std::int64_t each = search_trials_of_machine(study);
  const std::int64_t judgement = std::min(
      static_cast<std::int64_t>(judgement_part * static_cast<double>(affordable_trials(effort, speed))),
      max_machines_of_judgement * trials_of_machine(study));
  const std::int64_t trials = affordable_trials(effort, speed) - judgement;
  if (trials < min_search_trials(study, free)) throw trials::Spent{};
  const std::optional<double> seconds = std::isinf(effort.seconds_left())
                                            ? std::nullopt
                                            : std::optional((1.0 - judgement_part) * effort.seconds_left());
  return {search_size(scope_of(study, free, max_machines / 2), trials / each),
          effort.limited_to(trials, seconds)};
}

std::int64_t least_trials_of_other_search(const study::Study& study,
                                          std::span<const study::FreeParameter> free) {
  return whole_trials(
      std::ceil(static_cast<double>(min_search_trials(study, free)) / (1.0 - judgement_part)));
}

RestPlan plan_rest(const study::Study& study, std::int64_t points, std::int64_t trials_of_maps,
                   std::int64_t searches, const trials::Effort& effort, double speed) {
  constexpr std::int64_t most = 1024;
  constexpr std::int64_t least = 32;
  const std::int64_t each = std::max<std::int64_t>(points, 1) * search_trials_of_machine(study);
  const std::int64_t remaining = affordable_trials(effort, speed) - searches;
  if ((remaining - trials_of_maps) / each < least) trials_of_maps = 0;
  return {std::clamp((remaining - trials_of_maps) / each, least, most), trials_of_maps};
}

std::int64_t machines_of_judgement(const study::Study& study, const trials::Effort& effort, double speed) {
  const std::int64_t worlds = std::max<std::int64_t>(study.worlds, 1);
  const std::int64_t most = std::min(trials::in_equal_worlds(study, max_machines_of_judgement),
                                     affordable_trials(effort, speed) / trials_of_machine(study));
  if (most < min_machines_of_judgement) throw trials::Spent{};
  return most / worlds * worlds;
}

}  // namespace zerocount::tuning
