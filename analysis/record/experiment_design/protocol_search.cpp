#include "analysis/record/experiment_design/protocol_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::experiment_design {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// [property of the shape] Index of the property's value among the values that the search tries.
using GridPoint = std::vector<std::size_t>;

ProtocolShape shape_at(const GridPoint& point) {
  ProtocolShape shape;
  for (std::size_t axis = 0; axis < point.size(); ++axis)
    shape.*shape_axes()[axis].property = shape_axes()[axis].values[point[axis]];
  return shape;
}

/// The grid point of the default ProtocolShape.
GridPoint first_point() {
  const ProtocolShape shape;
  GridPoint point;
  for (const ShapeAxis& axis : shape_axes()) {
    const auto found = std::ranges::find(axis.values, shape.*axis.property);
    point.push_back(static_cast<std::size_t>(found - axis.values.begin()));
  }
  return point;
}

/// Reason why a simulated record is not safe (it slides, or travels too far); empty if it is safe.
std::string danger_in(const SearchProblem& problem, const SimulatedRecord& record) {
  if (record.slid) return "a machine breaks away";
  if (record.travel <= problem.max_travel) return "";
  const std::string unit = parameters::unit_on(problem.frame.axis, "rad");
  return fmt::format("a machine travels {:.3g} {} from its start, but only {:.3g} {} are allowed",
                     record.travel, unit, problem.max_travel, unit);
}

class ProtocolSearch {
 public:
  ProtocolSearch(const SearchProblem& problem, const SearchSettings& settings)
      : problem_(problem), settings_(settings) {}

  SearchResult run() {
    start();
    while (improve_once()) {
    }
    result_.protocols = protocols_;
    return result_;
  }

 private:
  /// Starts the search from the usual protocol, with its torque levels lowered until it is safe on all
  /// machines.
  void start() {
    best_ = first_point();
    best_spread_ = spread_at(best_);
    while (best_spread_ == infinite && (best_[0] > 0 || best_[1] > 0)) {
      for (const std::size_t level : {0, 1}) best_[level] -= best_[level] > 0 ? 1 : 0;
      best_spread_ = spread_at(best_);
    }
    if (best_spread_ == infinite)
      throw Failure(
          ExitCode::bad_input,
          fmt::format("no {} from {:.3g} to {:.3g} {} gives a safe record for identify: {}",
                      parameters::text_on(problem_.frame.axis, "$torque"),
                      shape_axes()[0].values.front() * problem_.frame.max_torque, problem_.frame.max_torque,
                      parameters::unit_on(problem_.frame.axis, "N m"), danger_));
    result_.improvements.push_back({shape_at(best_), best_spread_});
  }

  /// Tries to change each property of the shape by one step, up or down, and keeps each change that is
  /// better.
  /// @returns whether any change was better.
  bool improve_once() {
    bool improved = false;
    for (std::size_t axis = 0; axis < best_.size(); ++axis) {
      for (const std::ptrdiff_t step : {1, -1}) {
        bool moved = false;
        while (try_change(axis, step)) moved = true;
        improved = improved || moved;
        if (moved) break;
        if (ended_) return false;
      }
    }
    result_.converged = !improved;
    return improved;
  }

  bool try_change(std::size_t axis, std::ptrdiff_t step) {
    const auto place = static_cast<std::ptrdiff_t>(best_[axis]) + step;
    if (place < 0 || place >= static_cast<std::ptrdiff_t>(shape_axes()[axis].values.size())) return false;
    GridPoint point = best_;
    point[axis] = static_cast<std::size_t>(place);
    if (known_.contains(point)) return false;  // it was not better
    if (protocols_ >= settings_.max_protocols || (settings_.go_on && !settings_.go_on(protocols_))) {
      ended_ = true;
      return false;
    }
    const double spread = spread_at(point);
    constexpr double min_gain = 1e-3;  // of a logarithm
    if (!(spread < best_spread_ - min_gain)) return false;
    best_ = point;
    best_spread_ = spread;
    result_.improvements.push_back({shape_at(best_), best_spread_});
    return true;
  }

  double spread_at(const GridPoint& point) {
    const auto [entry, is_new] = known_.try_emplace(point, infinite);
    if (!is_new) return entry->second;
    ++protocols_;
    const TorqueProtocol protocol =
        sampled_protocol(segments_of(shape_at(point), problem_.frame), problem_.frame);
    const double spread = mean_spread(protocol);
    // The dangers of all machines take longer, and only matter where the criterion is better.
    if (spread >= best_spread_) return spread;
    const Safety safety = safety_of(problem_, protocol);
    danger_ = safety.danger;
    if (danger_.empty()) entry->second = spread;
    return entry->second;
  }

  /// Criterion of a protocol, smaller is better: mean of log_spread() over the judging machines; infinite if
  /// `identify` would refuse the record of one of them.
  double mean_spread(const TorqueProtocol& protocol) {
    const std::size_t count = std::min(problem_.judging, problem_.machines.size());
    std::vector<double> spreads(count, infinite);
    std::vector<std::string> refusals(count);
    parallel::for_each_index(count, [&](std::size_t i) {
      const Machine& machine = problem_.machines[i];
      const SimulatedRecord record = simulate(machine, protocol);
      refusals[i] = danger_in(problem_, record);
      if (!refusals[i].empty()) return;
      try {
        spreads[i] = log_spread(machine, protocol, record);
      } catch (const Failure& refusal) {
        refusals[i] = refusal.what();
      }
    });
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!refusals[i].empty()) danger_ = refusals[i];
      sum += std::isfinite(spreads[i]) ? spreads[i] : infinite;
    }
    return sum / static_cast<double>(count);
  }

  const SearchProblem& problem_;
  const SearchSettings& settings_;
  std::map<GridPoint, double> known_;
  GridPoint best_;
  double best_spread_{infinite};
  int protocols_{0};
  bool ended_{false};
  std::string danger_;
  SearchResult result_;
};

}  // namespace

Safety safety_of(const SearchProblem& problem, const TorqueProtocol& protocol) {
  std::vector<Safety> safeties(problem.machines.size());
  parallel::for_each_index(safeties.size(), [&](std::size_t i) {
    const SimulatedRecord record = simulate(problem.machines[i], protocol);
    safeties[i] = {danger_in(problem, record), record.travel};
  });
  Safety all;
  for (const Safety& one : safeties) {
    if (all.danger.empty()) all.danger = one.danger;
    all.travel = std::max(all.travel, one.travel);
  }
  return all;
}

SearchResult search_protocol(const SearchProblem& problem, const SearchSettings& settings) {
  return ProtocolSearch(problem, settings).run();
}

}  // namespace zerocount::experiment_design
