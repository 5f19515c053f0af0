#include "analysis/theory/goal_of_trial.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/loop/encoder.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::theory {

double GoalOfTrial::count() const {
  return feeds_back_coarse() ? loop::coarse_resolution(trial.encoder) : loop::fine_resolution(trial.encoder);
}

double GoalOfTrial::width() const {
  return goal.tolerance ? 2.0 * *goal.tolerance : (2.0 * static_cast<double>(goal.band) + 1.0) * count();
}

double GoalOfTrial::samples_within() const {
  const double from = std::floor(goal.within * trial.controller.sample_rate);
  return std::max(static_cast<double>(trial::samples_of_move(trial, 0)) - from, 1.0);
}

std::string GoalOfTrial::unit(const char* rotary) const {
  return parameters::unit_on(study.units.axis, rotary);
}

std::string GoalOfTrial::length(double value) const {
  return fmt::format("{:.3g} {}", value, unit("rad"));
}

std::string GoalOfTrial::torque(double value) const {
  return fmt::format("{:.3g} {}", value, unit("N m"));
}

std::string GoalOfTrial::band_text() const {
  return goal.tolerance ? "a tolerance of " + length(*goal.tolerance)
                        : fmt::format("a band of {} count{}", goal.band, goal.band == 1 ? "" : "s");
}

double MoveOfTrial::distance() const {
  return std::abs(to - from);
}

double MoveOfTrial::within() const {
  return std::min(of.goal.within, of.trial.command.hold);
}

std::vector<MoveOfTrial> moves_of(const GoalOfTrial& of) {
  constexpr std::size_t max_moves = 20;
  const trial::CommandParameters& command = of.trial.command;
  std::vector<MoveOfTrial> moves;
  if (command.profile.shape == loop::ReferenceShape::sine) return moves;
  double before = 0.0;
  for (std::size_t i = 0; i < command.targets.size() && moves.size() < max_moves; ++i) {
    const double target = command.exact_targets.empty() ? static_cast<double>(command.targets[i]) *
                                                              loop::fine_resolution(of.trial.encoder)
                                                        : command.exact_targets[i];
    const bool is_asked =
        of.goal.on.empty() || std::ranges::binary_search(of.goal.on, static_cast<std::int64_t>(i));
    if (is_asked && target != before) moves.push_back({of, i, before, target});
    before = target;
  }
  return moves;
}

}  // namespace zerocount::theory
