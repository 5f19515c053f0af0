#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/guides/guide_table.hpp"

namespace zerocount::guides {

/// Mass and preload of a linear or rotary guide (bearing). Its friction scales with them.
struct GuideLoad {
  double mass{0.0};     ///< moved mass, kg; for a rotary guide the moment of inertia, kg m^2
  double preload{0.0};  ///< preload, N, normal to the guide, on all carriages together
};

/// Measured values of a friction spring: a secant of the virgin curve, and the breakaway point.
struct MeasuredSpring {
  double breakaway{0.0};  ///< breakaway force, N
  double travel{0.0};     ///< travel from rest up to breakaway, m
  /// Stiffness (force over travel) of a secant from the origin of the virgin curve, N/m.
  double secant_stiffness{0.0};
  double secant_travel{0.0};  ///< travel at which that secant ends, m
};

/// Message that explains why no friction spring has these measured values, with their numbers; empty if a
/// spring has them.
std::string fault_of(const MeasuredSpring& measured);

/// The largest final stiffness (stiffness of the last part of the virgin curve, N/m) that a friction spring
/// with these measured values can have.
double highest_final_stiffness(const MeasuredSpring& measured);

/// The default mass and preload of a guide, used if the user gives none.
GuideLoad usual_load(const Guide& guide);

/// The ranges of the friction parameters of an axis on this guide. With the load W = preload + mass·9.81
/// m/s², and x~ for the geometric centre of the range of x:
///
///     friction.breakaway  F = friction coefficient·W + constant resistance
///     friction.k1         (1 - early part~)·F~ / travel
///     friction.k2         2·early part·F~ / softening length~
///     friction.beta       1 / softening length
///     friction.lambda     F~ⁿ / (creep part·travel~)
///     plant.presliding_damping   2·damping ratio·sqrt((k1~ + k2~)·mass)
///
/// At the centres the virgin curve (core/friction/equations.md) reaches the breakaway force after the travel,
/// if the travel is many softening lengths: k1·travel + k2/(2·beta) = F. The other parameters are numbers of
/// the guide. A computed number counts as published if all numbers from which it is computed are published.
///
/// With a measured spring, friction.measured stands in place of k1, k2, beta and breakaway, with a final
/// stiffness from 0.1 to 0.9 of highest_final_stiffness(), and F~, travel~, k1~ and k2~ are those of the
/// measured spring.
/// @param measured measured spring; only for a guide whose friction grows with the load (has_load)
std::vector<GuideNumber> guide_parameters(const Guide& guide, const GuideLoad& load,
                                          const std::optional<MeasuredSpring>& measured = {});

/// Geometric mean of the two ends of a range; 0 if its low end is 0.
double centre(const GuideNumber& number);

/// Lowest and highest value of a parameter over all guides of this kind of axis with their usual loads; empty
/// if no guide has the parameter.
std::optional<std::pair<double, double>> range_over_guides(parameters::AxisKind axis,
                                                           std::string_view parameter);

/// Properties that the user may state about the axis for which a new study's manifest is written; the
/// defaults are those of the guide.
struct GuideAxis {
  GuideLoad load;
  double resolution{1e-8};  ///< encoder resolution, m per count; used for a linear axis
  /// Measured friction spring, which replaces that of the guide; empty: the guide's.
  std::optional<MeasuredSpring> spring{};
};

/// A manifest of an axis on this guide. Each machine draws its friction from the ranges of the guide. A
/// comment states the origin of every number of the friction. The rest of the loop follows from k1 and the
/// mass m:
///
///     kp = m·w², w = 2π·sample_rate / 100       the frequency of m on kp alone
///     kd = 1.4·m·w                              damping 0.7 of m on kp alone
///     ki = (c + kd)·(k1 + kp) / (4·m)           a quarter of criterion (6), with the lowest k1 and c
///
/// A linear axis has a converter up to 2·breakaway + m·1 m/s², with codes of at most k1·resolution/2
/// (practical issue 4 of the paper asks for less than k1·resolution) and 12 to 24 bits.
std::string guide_manifest(const Guide& guide, const GuideAxis& axis);

}  // namespace zerocount::guides
