#include "analysis/record/sliding_identification/sliding_identification.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include <fmt/format.h>

#include "analysis/record/sliding_identification/missing_torque.hpp"
#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr double least_used = 0.25;      // of the travel
constexpr double max_unexplained = 0.1;  // of the torque; the records of a real machine leave 0.035

bool moves_along(std::span<const SlidingRecord> records, double direction) {
  return std::ranges::any_of(records, [&](const SlidingRecord& record) {
    return std::ranges::any_of(record.strokes,
                               [&](const Window& stroke) { return stroke.direction == direction; });
  });
}

double torque_rms(std::span<const SlidingRecord> records) {
  double squares = 0.0;
  std::size_t samples = 0;
  for (const SlidingRecord& record : records) {
    for (const Window& stroke : record.strokes) {
      samples += samples_of(stroke);
      for (std::size_t k = stroke.first; k <= stroke.last; ++k)
        squares += record.torque[k].now * record.torque[k].now;
    }
  }
  return std::sqrt(squares / static_cast<double>(samples));
}

/// The Stribeck velocity (rad/s or m/s) that explains most of the residuals, among 12 velocities in equal
/// ratios between the slowest velocity and half of the fastest. Nothing if none explains more than chance
/// does with independent residuals.
std::optional<double> visible_stribeck_velocity(std::span<const SlidingRecord> records,
                                                const SlidingFit& without) {
  double slowest = records.front().min_velocity;
  double fastest = 0.0;
  for (const SlidingRecord& record : records) {
    slowest = std::min(slowest, record.min_velocity);
    fastest = std::max(fastest, record.max_velocity);
  }
  const double ratio = std::max(0.5 * fastest / slowest, 1.0);
  constexpr int candidates = 12;
  double best = min_excess_ratio * min_excess_ratio * without.misfit * without.misfit;
  std::optional<double> found;
  for (int i = 0; i < candidates; ++i) {
    const double velocity = slowest * std::pow(ratio, (i + 0.5) / candidates);
    const double gain = stribeck_gain(without, velocity);
    if (!(gain > best)) continue;
    best = gain;
    found = velocity;
  }
  return found;
}

FreeParameters parameters_without_stribeck(std::span<const SlidingRecord> records,
                                           const std::vector<PositionWave>& waves) {
  FreeParameters free{};
  free[log_inertia] = free[coulomb_level] = free[viscous_damping] = true;
  free[offset_torque] = moves_along(records, 1.0) && moves_along(records, -1.0);
  for (std::size_t i = 0; i < waves.size(); ++i) {
    free[position_amplitudes + 2 * i] = true;
    free[position_amplitudes + 2 * i + 1] = waves[i].periods != 0.0;
  }
  return free;
}

/// The fit, with a Stribeck curve if `with_stribeck` is true and the records show one.
SlidingFit best_fit(std::span<const SlidingRecord> records, const std::vector<PositionWave>& waves,
                    bool with_stribeck) {
  FreeParameters free = parameters_without_stribeck(records, waves);
  SlidingFit without = fit_sliding(records, starting_point(records, free[offset_torque]), free, waves);
  const std::optional<double> velocity =
      with_stribeck ? visible_stribeck_velocity(records, without) : std::nullopt;
  if (!velocity) return without;
  free[stribeck_excess] = free[log_stribeck_velocity] = true;
  SlidingPoint start = without.point;
  start[stribeck_excess] = 0.1 * std::abs(start[coulomb_level]);
  start[log_stribeck_velocity] = std::log(*velocity);
  try {
    SlidingFit fit = fit_sliding(records, start, free, waves);
    const SlidingPoint error = fit.covariance.diagonal().cwiseSqrt();
    // A level below 0 makes up for another force that the law lacks.
    const bool shown = (!free[offset_torque] || fit.point[coulomb_level] > 0.0) &&
                       fit.point[stribeck_excess] >= min_excess_ratio * error[stribeck_excess] &&
                       error[log_stribeck_velocity] < 0.5 * fit::max_half_width(true);
    return shown ? fit : without;
  } catch (const Failure&) {
    return without;
  }
}

/// The fit with the longest windows (simulated pieces of the records) in which the law explains the motion to
/// within a step of the readings.
SlidingFit fit_in_windows(std::vector<SlidingRecord>& records, const std::vector<PositionWave>& waves,
                          bool with_stribeck) {
  set_position_waves(records, waves);
  for (SlidingRecord& record : records) cut_windows(record, max_window_samples);
  SlidingFit fit = best_fit(records, waves, with_stribeck);
  for (std::size_t samples = max_window_samples / 4; fit.misfit > 1.0 && samples >= min_window_samples;
       samples /= 4) {
    for (SlidingRecord& record : records) cut_windows(record, samples);
    fit = best_fit(records, waves, with_stribeck);
  }
  return fit;
}

/// The fit with only those position-dependent torques (waves) that are significant. The others are removed
/// one by one, the least visible first.
SlidingFit fit_of_shown(std::vector<SlidingRecord>& records, std::vector<PositionWave> waves,
                        bool with_stribeck) {
  for (;;) {
    SlidingFit fit = fit_in_windows(records, waves, with_stribeck);
    std::vector<double> visibility;
    for (std::size_t i = 0; i < waves.size(); ++i) visibility.push_back(visibility_of(fit, i));
    const auto least = std::ranges::min_element(visibility);
    if (least == visibility.end() || *least >= 1.0) return fit;
    waves.erase(waves.begin() + (least - visibility.begin()));
  }
}

/// The fit with one more position-dependent torque (wave), if the records show one: the wave that the
/// residuals show best, or else the usual wave, which another may have hidden.
std::optional<SlidingFit> with_another_wave(std::vector<SlidingRecord>& records, const SlidingFit& fit,
                                            bool with_stribeck) {
  if (fit.waves.size() == max_position_waves) return std::nullopt;
  std::vector<PositionWave> to_try = usual_waves(records.front());
  if (const auto strongest = strongest_wave(fit)) to_try.insert(to_try.begin(), *strongest);
  for (const PositionWave& wave : to_try) {
    if (std::ranges::find(fit.waves, wave.periods, &PositionWave::periods) != fit.waves.end()) continue;
    std::vector<PositionWave> waves = fit.waves;
    waves.push_back(wave);
    set_position_waves(records, waves);
    bool shown = false;
    try {
      const FreeParameters free = parameters_without_stribeck(records, waves);
      shown = visibility_of(fit_sliding(records, fit.point, free, waves), waves.size() - 1) >= 1.0;
    } catch (const Failure&) {
      shown = false;  // no motion with it fits
    }
    set_position_waves(records, fit.waves);
    if (!shown) continue;
    std::ranges::sort(waves, {}, &PositionWave::periods);
    return fit_of_shown(records, waves, with_stribeck);
  }
  return std::nullopt;
}

/// The fit with the position-dependent torques that the records show. The usual one (gravity or slope) is in
/// from the start, since nothing else fits where it is missing, then others one after the other. A Stribeck
/// curve comes last, because it would follow what is missing. A wave that stood for another, or for the
/// curve, goes when that is found.
SlidingFit fit_with_position(std::vector<SlidingRecord>& records) {
  SlidingFit fit = fit_of_shown(records, usual_waves(records.front()), false);
  constexpr int rounds = 2 * max_position_waves;
  for (const bool with_stribeck : {false, true}) {
    if (with_stribeck) fit = fit_of_shown(records, fit.waves, true);
    for (int round = 0; round < rounds; ++round) {
      std::optional<SlidingFit> more = with_another_wave(records, fit, with_stribeck);
      if (!more) break;
      const bool settled =
          std::ranges::equal(more->waves, fit.waves, {}, &PositionWave::periods, &PositionWave::periods);
      fit = *std::move(more);
      if (settled) break;
    }
  }
  return fit;
}

/// Whether a torque with two periods per revolution, in place of gravity with one, explains the records as
/// well.
bool looks_like_two_periods(std::vector<SlidingRecord>& records, const SlidingFit& fit) {
  std::vector<PositionWave> waves = fit.waves;
  const auto gravity = std::ranges::find(waves, 1.0, &PositionWave::periods);
  if (gravity == waves.end() || std::ranges::find(waves, 2.0, &PositionWave::periods) != waves.end())
    return false;
  *gravity = {2.0, 2.0 * gravity->wave_number};
  set_position_waves(records, waves);
  constexpr double as_well = 1.05;
  bool alike = false;
  try {
    alike = fit_sliding(records, fit.point, fit.free, waves).misfit < as_well * fit.misfit;
  } catch (const Failure&) {
    alike = false;  // no motion with two periods fits
  }
  set_position_waves(records, fit.waves);
  return alike;
}

void set_correlation(const SlidingFit& fit, SlidingIdentification& result) {
  std::vector<std::string> names{"inertia", "coulomb_level", "sliding_damping",
                                 "offset",  "excess",        "stribeck_velocity"};
  for (const PositionWave& wave : fit.waves)
    for (const char* part : {".sine", ".cosine"}) names.push_back(name_of(wave) + part);
  const SlidingPoint error = fit.covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    if (!fit.free[static_cast<std::size_t>(i)]) continue;
    result.correlated.push_back(names[static_cast<std::size_t>(i)]);
    std::vector<double>& row = result.correlation.emplace_back();
    for (Eigen::Index j = 0; j < error.size(); ++j) {
      if (fit.free[static_cast<std::size_t>(j)]) row.push_back(fit.covariance(i, j) / (error[i] * error[j]));
    }
  }
}

/// Whether the windows had to be shortened below the usual length, because forces that the law lacks add up
/// in them.
bool is_cut(const SlidingIdentification& identification) {
  return std::ranges::any_of(identification.records, [](const SlidingRecord& record) {
    return record.window_samples < max_window_samples;
  });
}

/// Proportion of the variance of the unexplained torque that a division of the windows into ten classes
/// predicts by chance alone: three standard deviations above 0.
double predicted_by_chance(const SlidingIdentification& identification) {
  double windows = 0.0;
  for (const SlidingRecord& record : identification.records)
    windows += static_cast<double>(record.windows.size());
  return 3.0 * std::sqrt(20.0) / windows;
}

/// Smallest proportion of the unexplained torque that the position must predict to matter: a tenth. If the
/// readings alone may cause the unexplained torque, it is at least what chance predicts.
double least_explained(const SlidingIdentification& identification) {
  constexpr double tolerated = 0.1;
  constexpr double of_readings = 0.6;  // steps; independent errors of readings leave 0.3 to 0.5
  if (is_cut(identification) || identification.misfit > of_readings) return tolerated;
  return std::max(tolerated, predicted_by_chance(identification));
}

/// The quantity (position, speed, …) that predicts most of the unexplained torque. Null unless it predicts at
/// least half of its variance and more than chance does.
const RepeatingForce* main_part(const SlidingIdentification& identification) {
  constexpr double most_of_it = 0.5;
  const auto most = std::ranges::max_element(identification.forces, {}, &RepeatingForce::predicted);
  return most != identification.forces.end() &&
                 most->predicted >= std::max(most_of_it, predicted_by_chance(identification))
             ? &*most
             : nullptr;
}

/// Names of the position-dependent torques that the fit has tried, as text.
std::string tried_text(const SlidingIdentification& identification) {
  if (identification.waves.size() == max_position_waves)
    return fmt::format("{} torques that depend on it are found, and more is not tried", max_position_waves);
  if (identification.axis == parameters::AxisKind::rotary)
    return "tried are gravity and other torques that act a whole number of times in a revolution";
  return identification.records.front().pitch > 0.0
             ? "tried are forces that are proportional to it or act a whole number of times in a pitch"
             : "tried is a force proportional to it; --pitch tries those that repeat with a pitch";
}

std::string advice_on_lag(double lag, double delay) {
  const double better = std::round(delay + lag);
  if (better == delay || better < 0.0) return "record torque and position of the same instant";
  return fmt::format("--delay {:.0f} says so, or record torque and position of the same instant", better);
}

/// Advice for the user on how to avoid the missing torque, depending on its cause.
/// @param delay delay of the torque assumed so far, samples
std::string advice_on(const MissingTorque& torque, double delay) {
  switch (torque.cause) {
    case TorqueCause::lag:
      return advice_on_lag(torque.coefficient, delay);
    case TorqueCause::speed:
      return "a record of a narrower range of speeds has less of it (--exclude)";
    case TorqueCause::direction:
      return "the two directions need laws of their own";
    case TorqueCause::load:
      return "a record with less acceleration and gravity has less of it";
    case TorqueCause::position:
      return "a record of a part of the travel has less of it (--exclude)";
    case TorqueCause::time:
      return "record the axis when it is warm, or identify parts of the record (--exclude)";
  }
  return "";
}

/// Text on the torque beyond the law that the residuals show best, and on others of another cause that
/// explain nearly as much.
std::string missing_text(const SlidingIdentification& identification) {
  const MissingTorque& best = identification.missing.front();
  std::string others;
  for (const MissingTorque& one : identification.missing) {
    constexpr double nearly = 0.5;
    if (one.cause == best.cause || one.explained < nearly * best.explained) continue;
    if (others.find(one.name) == std::string::npos) others += (others.empty() ? "" : ", ") + one.name;
  }
  const std::string what =
      best.cause == TorqueCause::lag
          ? fmt::format("the motion follows the {} by {:.1f} samples {} than the record says, which explains",
                        parameters::text_on(identification.axis, "$torque"), std::abs(best.coefficient),
                        best.coefficient > 0.0 ? "later" : "earlier")
          : fmt::format("the law lacks {}, which explains", best.name);
  return fmt::format("{} {:.0f} % of the squares of the residuals{}, so the intervals may not hold; {}", what,
                     100.0 * best.explained, others.empty() ? "" : " (nearly as well: " + others + ")",
                     advice_on(best, identification.records.front().delay));
}

std::string second_mass_text(const SecondMass& mass) {
  const double percent = 100.0 * mass.explained;
  constexpr const char* advice = "so the intervals may not hold; moves with less jerk excite it less";
  if (mass.frequency > 0.0)
    return fmt::format(
        "a second mass behind a spring, with a resonance near {} Hz, explains {:.0f} % of the "
        "squares that one mass leaves, {}",
        mass.frequency < 10.0 ? fmt::format("{:.2g}", mass.frequency) : fmt::format("{:.0f}", mass.frequency),
        percent, advice);
  return fmt::format(
      "what one mass leaves follows the torque as with a second mass behind a spring, or with a "
      "delay: that explains {:.0f} % of its squares, {}",
      percent, advice);
}

/// Whether the fit is clean enough to search for a second mass: other forces that the law lacks would look
/// like one, and a second mass looks like a lag of the torque.
bool may_have_second_mass(const SlidingIdentification& identification) {
  return identification.missing.empty()
             ? reason_of_distrust(identification).empty() || identification.one_direction ||
                   main_part(identification) != nullptr
             : identification.missing.front().cause == TorqueCause::lag;
}

/// Whether the second mass is reported, rather than a lag of the torque that would explain the same
/// residuals: a window of the usual length contains a period of its resonance.
bool is_better(const SecondMass& mass, const SlidingIdentification& identification) {
  const std::vector<double>& time = identification.records.front().time;
  const double rate = static_cast<double>(time.size() - 1) / time.back();
  return identification.missing.empty() || mass.frequency * static_cast<double>(max_window_samples) > rate;
}

void refuse_unexplained(const SlidingIdentification& result) {
  if (result.unexplained_torque <= max_unexplained * result.torque) return;
  const SlidingRecord& record = result.records.front();
  fit::refuse(
      record.axis, record.name,
      fmt::format("inertia and sliding friction do not explain the motion: they leave {:.3g} of {:.3g} "
                  "$Nm (root mean square). Are the units right, is there another mass or a spring, was "
                  "the torque limited, does the axis move long before it slides? --exclude leaves parts "
                  "out.",
                  result.unexplained_torque, result.torque));
}

}  // namespace

std::string reason_of_distrust(const SlidingIdentification& identification) {
  if (std::ranges::none_of(identification.parameters, fit::is_estimated))
    return "no parameter is identifiable from these records";
  if (const double used = used_proportion(identification.records); used < least_used)
    return fmt::format(
        "only {:.0f} % of the travel is in strokes that are long enough for a fit; sample faster, or move "
        "farther "
        "between stops and reversals",
        100.0 * used);
  const std::string left =
      fmt::format("{:.3g} {} (of {:.3g}) that the law leaves unexplained", identification.unexplained_torque,
                  parameters::unit_on(identification.axis, "N m"), identification.torque);
  const auto position = std::ranges::find(identification.forces, "position", &RepeatingForce::with);
  const bool with_position =
      position != identification.forces.end() && position->predicted >= least_explained(identification);
  const bool in_position =
      !identification.missing.empty() && identification.missing.front().cause == TorqueCause::position;
  if (with_position && (identification.missing.empty() || in_position))
    return fmt::format("the position explains {:.0f} % of the {}; {}", 100.0 * position->predicted, left,
                       tried_text(identification));
  if (identification.second_mass) return second_mass_text(*identification.second_mass);
  if (!identification.missing.empty()) return missing_text(identification);
  if (!identification.impossible.empty()) return identification.impossible;
  if (const RepeatingForce* force = main_part(identification))
    return fmt::format("{} predicts {:.0f} % of the {}", force->with, 100.0 * force->predicted, left);
  if (identification.one_direction)
    return fmt::format(
        "the motion has one direction, in which an offset of the {} cannot be distinguished from the Coulomb "
        "friction; record strokes in the other direction, too",
        parameters::text_on(identification.axis, "$torque"));
  return "";
}

SlidingIdentification identify_sliding(std::vector<SlidingRecord> records) {
  const SlidingFit fit = fit_with_position(records);
  SlidingIdentification result;
  result.axis = records.front().axis;
  result.parameters = estimates_of(fit, result.axis);
  result.waves = fit.waves;
  result.could_be_two_periods = looks_like_two_periods(records, fit);
  result.misfit = fit.misfit;
  result.unexplained_torque = fit.unexplained_torque;
  result.torque = torque_rms(records);
  result.impossible = impossible_parameter(fit, result.axis);
  result.one_direction = !fit.free[offset_torque];
  for (MissingTorque& one : tried_torques(fit))
    if (one.visibility >= 1.0) result.missing.push_back(std::move(one));
  set_correlation(fit, result);
  result.runs = free_runs(fit);
  result.forces = repeating_forces(fit);
  result.reversal = reversal_friction(fit);
  result.records = std::move(records);
  if (may_have_second_mass(result)) result.second_mass = visible_second_mass(fit, result.records);
  if (result.second_mass && !is_better(*result.second_mass, result)) result.second_mass.reset();
  refuse_unexplained(result);
  result.fragment = sliding_fragment(result);
  return result;
}

}  // namespace zerocount::sliding_identification
