#include "analysis/trials/worlds/derived_quantities.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/friction/presliding/creep.hpp"
#include "core/friction/presliding/spring.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/randomness/random_coordinates.hpp"

namespace zerocount::worlds {
namespace {

using friction::FrictionParameters;

double creep_rate(const FrictionParameters& contact, double torque) {
  return contact.alpha * friction::hardening_limit(contact, torque);
}

double initial_stiffness(const FrictionParameters& contact, double /*torque*/) {
  return contact.k1 + contact.k2;
}

/// Slope of the virgin loading curve σ(x) = ½·f(2x) of a friction contact at the point where it carries
/// `torque` (N m), N m/rad.
double stiffness_at_rest(const FrictionParameters& contact, double torque) {
  const double travel = 2.0 * friction::virgin_elongation(contact, torque);
  return contact.k1 + contact.k2 * numerics::exp(-contact.beta * travel);
}

double presliding_range(const FrictionParameters& contact, double /*torque*/) {
  return friction::presliding_range(contact);
}

constexpr std::array<DerivedQuantity, 5> table{{
    {"creep_extension", "rad", "extension at which creep ends under a $torque of {} $Nm, |$torque|^n/lambda",
     parameter::friction::lambda, friction::has_creep, friction::hardening_limit},
    {"creep_rate", "rad/s", "speed at which creep begins under a $torque of {} $Nm, alpha*|$torque|^n/lambda",
     parameter::friction::alpha, friction::has_creep, creep_rate},
    {"initial_stiffness", "N m/rad", "stiffness after a reversal, k1 + k2", parameter::friction::k1,
     friction::has_spring, initial_stiffness},
    {"stiffness_at_rest", "N m/rad", "slope of the virgin curve at a $torque of {} $Nm",
     parameter::friction::k1, friction::has_spring, stiffness_at_rest},
    {"presliding_range", "rad", "travel of the virgin curve up to breakaway", parameter::friction::breakaway,
     friction::has_spring, presliding_range},
}};

/// [world] Parameters of the median machine of each world (a draw of what all machines share): all that
/// differs between machines has its median.
std::vector<trial::TrialParameters> median_machines(const study::Study& study, std::int64_t point) {
  const std::vector<randomness::RandomCoordinate> coordinates = randomness::random_coordinates(study, point);
  const std::vector<double> medians(coordinates.size(), 0.0);
  study::GivenDraws draws = randomness::draws_at(study, coordinates, medians, 0);
  std::vector<trial::TrialParameters> machines;
  for (std::int64_t world = 0; world < study.worlds; ++world) {
    draws.world = world;
    machines.push_back(study::study_trial(study, point, 0, draws).parameters);
  }
  return machines;
}

/// Torque that contacts carry at rest: root mean square of the holding torque plus the constant disturbance,
/// N m.
double carried_torque(const std::vector<trial::TrialParameters>& machines,
                      const measures::MeasureStatistics& holding_torque) {
  double disturbance = 0.0;
  for (const trial::TrialParameters& machine : machines)
    disturbance += machine.disturbance.torque / static_cast<double>(machines.size());
  const double sd = holding_torque.n > 1 ? holding_torque.sd : 0.0;
  return std::hypot(holding_torque.mean + disturbance, sd);
}

}  // namespace

std::span<const DerivedQuantity> derived_quantities() {
  return table;
}

std::vector<WorldInput> derived_of_worlds(const study::Study& study, std::int64_t point,
                                          const measures::MeasureStatistics& holding_torque) {
  const std::vector<trial::TrialParameters> machines = median_machines(study, point);
  const double torque = carried_torque(machines, holding_torque);
  std::vector<WorldInput> found;
  if (!(torque > 0.0)) return found;
  for (const DerivedQuantity& quantity : table) {
    if (!quantity.exists(machines.front().friction.model)) continue;
    const parameters::AxisKind axis = study.units.axis;
    WorldInput input{std::string(quantity.name), parameters::unit_on(axis, quantity.unit), {}, {}};
    for (const trial::TrialParameters& machine : machines)
      input.values.push_back(
          quantity.value(friction::friction_at(machine.friction, machine.initial.position), torque));
    const auto [least, most] = std::ranges::minmax(input.values);
    if (!std::isfinite(most - least) || !(most > least)) continue;
    input.meaning =
        parameters::text_on(axis, fmt::format(fmt::runtime(quantity.meaning), fmt::format("{:.3g}", torque)));
    found.push_back(std::move(input));
  }
  return found;
}

}  // namespace zerocount::worlds
