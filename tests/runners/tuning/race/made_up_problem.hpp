#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <unordered_map>
#include <utility>

#include "core/random/random_numbers.hpp"
#include "experiments/study/goal.hpp"
#include "runners/tuning/race/search.hpp"

namespace zerocount::tuning {

/// A tuning problem with a known solution. The parameters are in [0, 1]; their number is the size of
/// `reliable` and `fast`. The success rate falls with the distance from `reliable`; the settling time rises
/// with the distance from `fast`.
struct MadeUpProblem {
  std::uint64_t seed{1};
  double highest_rate{0.99};
  double fall{0.4};  ///< decrease of the success rate per squared distance from `reliable`
  Values reliable{0.3, 0.6};
  Values fast{0.7, 0.4};
  /// Widths of a peak of the rate with heavy tails, used in place of `fall`; empty: `fall` is used.
  Values widths{};
  study::Goal goal{.within = 1.0, .moves = 0.95};
  /// For each machine its random effects on success (luck) and on settling time (slowness).
  mutable std::unordered_map<std::uint64_t, std::pair<double, double>> machines{};

  static double squared_distance(const Values& a, const Values& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
  }
  double rate(const Values& at) const {
    if (widths.empty()) return highest_rate - fall * squared_distance(at, reliable);
    Values distance, centre(at.size(), 0.0);
    for (std::size_t i = 0; i < at.size(); ++i) distance.push_back((at[i] - reliable[i]) / widths[i]);
    return highest_rate / (1.0 + squared_distance(distance, centre));
  }
  double typical_time(const Values& at) const { return 0.01 + squared_distance(at, fast); }

  double uniform(std::uint64_t stream, std::uint64_t machine, const Values& at) const {
    const auto hash = [](double x) { return static_cast<std::uint64_t>(x * 1e9); };
    std::uint64_t place = 0;
    for (const double x : at) place = place * 0x9E3779B97F4A7C15U + hash(x);
    return random::open_uniform(
        random::random_bits({{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(stream)}, 0},
                            machine + (place << 20U), random::Draw::trial));
  }

  double normal(std::uint64_t stream, std::uint64_t machine, const Values& at) const {
    return std::sqrt(-2.0 * std::log(uniform(stream, machine, at))) *
           std::cos(2.0 * std::numbers::pi * uniform(stream + 1, machine, at));
  }

  /// The result of a machine at a point. Half of its luck belongs to the machine and is the same at all
  /// points; the other half belongs to the point.
  MachineResult result(const Values& at, std::uint64_t machine) const {
    auto [known, is_new] = machines.try_emplace(machine);
    if (is_new) {
      const Values everywhere(at.size(), 0.0);
      known->second = {normal(1, machine, everywhere), std::exp(0.3 * normal(5, machine, everywhere))};
    }
    const double luck = std::sqrt(0.5) * (known->second.first + normal(3, machine, at));
    const bool met = 0.5 * std::erfc(luck / std::sqrt(2.0)) < rate(at);
    return {.claims = {{1, met ? 1 : 0, {typical_time(at) * known->second.second}}}};
  }

  SearchProblem problem(std::int64_t machines) const {
    SearchProblem problem;
    for (std::size_t i = 0; i < fast.size(); ++i)
      problem.free.push_back({.name = std::string(1, "xyzwv"[i]), .low = 0.0, .high = 1.0});
    problem.aim = {.claims = {{.moves = goal.moves}}, .quantile = 0.95};
    problem.size =
        search_size({.free = problem.free.size(), .max_machines = machines}, std::int64_t{1} << 40);
    problem.evaluate = [this](std::span<Candidate* const> candidates, std::int64_t to) {
      for (Candidate* one : candidates) {
        while (std::ssize(one->machines) < to)
          one->machines.push_back(result(one->values, one->machines.size()));
      }
    };
    problem.admissible = [](std::span<const Candidate> candidates) {
      return std::vector<bool>(candidates.size(), true);
    };
    problem.verified = [](const Candidate&) { return true; };
    return problem;
  }
};

}  // namespace zerocount::tuning
