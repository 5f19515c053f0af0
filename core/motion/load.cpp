#include "core/motion/load.hpp"

#include "core/motion/taylor_step.hpp"
#include "core/numerics/series_recurrences.hpp"

namespace zerocount::motion {

void start_series(LoadSeries& series, const Load& load, double heading) {
  series.twist[0] = load.twist;
  series.omega[0] = load.omega;
  series.plain = is_plain(load);
  series.side = side_of_gap(load.parameters, load.twist, heading);
  if (load.friction != nullptr) load.friction->start(load);
  if (!load.error.empty()) series.error.emplace(load.error, load.rotor_theta);
  if (varies(load.disturbance))
    series.disturbance.emplace(
        VaryingTorque{load.disturbance, load.time, load_theta(load, load.rotor_theta)});
}

double expand(LoadSeries& s, const Load& load, const numerics::Series& rotor_omega, std::size_t k) {
  const LoadParameters& p = load.parameters;
  double driving = rotor_omega[k];
  if (s.error) {
    s.error->expand(rotor_omega, k);
    s.transmission[k] = s.error->slope(k) + (k == 0 ? 1.0 : 0.0);
    driving = numerics::product_coefficient(s.transmission.data(), rotor_omega.data(), k);
  }
  const double relative = driving - s.omega[k];
  s.twist[k + 1] = relative * numerics::reciprocal[k + 1];
  double torque = 0.0;
  if (p.gap == 0.0 || s.side != 0) {
    const double stretch = k == 0 ? s.twist[0] - 0.5 * p.gap * s.side : s.twist[k];
    torque = p.stiffness * stretch + p.damping * relative;
  }
  double on_load = torque;
  if (!s.plain) {
    on_load -= p.damping_to_ground * s.omega[k];
    if (k == 0) on_load += load.disturbance.torque;
    if (s.disturbance) on_load += s.disturbance->expand(s.omega, k);
    if (load.friction != nullptr) on_load = load.friction->expand(s.omega, on_load, k);
  }
  s.omega[k + 1] = on_load / p.inertia * numerics::reciprocal[k + 1];
  if (!s.error) return torque;
  s.torque[k] = torque;
  return numerics::product_coefficient(s.transmission.data(), s.torque.data(), k);
}

double heading_from_edge(const LoadSeries& series, const LoadParameters& load) {
  if (load.gap == 0.0 || std::abs(series.twist[0]) != 0.5 * load.gap) return 0.0;
  for (std::size_t k = 1; k <= numerics::series_order; ++k)
    if (series.twist[k] != 0.0) return series.twist[k];
  return 0.0;
}

std::optional<EdgeOfGap> next_edge(const LoadSeries& series, const LoadParameters& load, double step) {
  if (load.gap == 0.0) return std::nullopt;
  std::optional<EdgeOfGap> first;
  for (const int side : {1, -1}) {
    if (series.side == -side) continue;
    const double edge = 0.5 * load.gap * side;
    numerics::Series beyond = series.twist;
    beyond[0] -= edge;
    if (std::abs(beyond[0]) > numerics::excursion_bound(beyond, step)) continue;
    const std::optional<double> time = next_sign_change(beyond, step);
    if (time && (!first || *time < first->time)) first = {*time, edge};
  }
  return first;
}

}  // namespace zerocount::motion
