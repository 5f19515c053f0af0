#include "runners/tuning/worst_machines/machine_box.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/distributions.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/study/measured_machines.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::tuning {
namespace {

constexpr double tail = 0.0005;  // beyond each end of the box

/// The study with independent draws, as many as are wanted. Its profiles stay.
study::Study searched_study(const study::Study& study, const std::vector<study::MachineInput>& inputs) {
  study::Study searched = study;
  if (are_correlated(inputs, *study.plan)) {
    auto plan = std::make_shared<study::StudyPlan>(*study.plan);
    plan->copula.reset();
    searched.plan = std::move(plan);
    searched.correlations.clear();
  }
  searched.design = study::Design::monte_carlo;
  return searched;
}

}  // namespace

double quantile_at(double place) {
  return tail + (1.0 - 2.0 * tail) * place;
}

double place_at(double quantile) {
  return std::clamp((quantile - tail) / (1.0 - 2.0 * tail), 0.0, 1.0);
}

bool are_correlated(const std::vector<study::MachineInput>& inputs, const study::StudyPlan& plan) {
  return std::ranges::any_of(inputs, [&](const study::MachineInput& input) {
    return plan.copula &&
           std::ranges::find(plan.copula->slots, input.slots.front()) != plan.copula->slots.end();
  });
}

MachineBox::MachineBox(study::Study study, std::int64_t point)
    : given_(std::move(study)),
      point_(point),
      inputs_(study::machine_inputs(given_, point)),
      searched_(searched_study(given_, inputs_)) {
  if (inputs_.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: it draws nothing that differs between machines; expected distributions, "
                              "such as friction.k1: {{lognormal: {{median: 110, cv: 0.1}}}}",
                              given_.name));
  const auto values = study::values_at(*given_.plan, static_cast<std::size_t>(point_));
  for (std::size_t slot = 0; slot < values.size(); ++slot) {
    if (values[slot]->kind != study::Value::Kind::profile) continue;
    profiles_.emplace_back(slot, values[slot]);
    has_profile_per_rig_ |= values[slot]->level == study::DrawLevel::rig;
  }
}

BoxPoint MachineBox::machine_of(std::int64_t unit) const {
  return {given_.rigs > 0 ? unit : 0, study::drawn_quantiles(given_, point_, unit, inputs_)};
}

/// Of the likely machines Σ z² as a part of its limit; of the others 0.
double MachineBox::excess_of(const BoxPoint& point, MachineRegion region) const {
  double square = 0.0;
  int scores = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (region == MachineRegion::box || is_row(i)) continue;
    const double z = numerics::normal_quantile(point.quantiles[i]);
    square += z * z;
    ++scores;
  }
  return scores == 0 ? 0.0 : square / statistics::chi_squared_quantile(scores, 1.0 - 2.0 * tail);
}

void MachineBox::approach_median(BoxPoint& point, double divisor) const {
  for (std::size_t i = 0; i < point.quantiles.size(); ++i) {
    if (is_row(i)) continue;
    double& one = point.quantiles[i];
    one = numerics::normal_probability(numerics::normal_quantile(one) / divisor);
  }
}

BoxPoint MachineBox::inside(BoxPoint point, MachineRegion region) const {
  for (double& one : point.quantiles) one = std::clamp(one, tail, 1.0 - tail);
  if (const double excess = excess_of(point, region); excess > 1.0) approach_median(point, std::sqrt(excess));
  // Measured values at the ends of their ranges may be those of no machine.
  const auto is_machine = [&] {
    return study::is_machine(searched_, point_, point.rig, draws_of(point, given_.trials));
  };
  constexpr int max_steps = 100;
  for (int step = 0; step < max_steps && !is_machine(); ++step) approach_median(point, 1.1);
  return point;
}

bool MachineBox::is_likely(const BoxPoint& point) const {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < point.quantiles.size(); ++i) {
    const double one = point.quantiles[i];
    if (!is_row(i) && (one < tail - rounding || one > 1.0 - tail + rounding)) return false;
  }
  return excess_of(point, MachineRegion::likely) <= 1.0 + rounding;
}

study::GivenDraws MachineBox::draws_of(const BoxPoint& point, std::int64_t number) const {
  study::GivenDraws given;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    for (const std::uint32_t slot : inputs_[i].slots) given.uniforms[slot] = point.quantiles[i];
  }
  given.number = number;
  given.rotor = point.rig;
  return given;
}

trial::TrialParameters MachineBox::trial_of(const BoxPoint& point, std::int64_t number) const {
  return study::study_trial(searched_, point_, point.rig, draws_of(point, number)).parameters;
}

}  // namespace zerocount::tuning
