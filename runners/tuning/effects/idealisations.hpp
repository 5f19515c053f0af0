#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_edit.hpp"
#include "experiments/study/point_limits.hpp"
#include "runners/tuning/effects/effects.hpp"

/// Effects of idealisations_of(), grouped by subject, and their common functions. Each effect switches off
/// one cause of failures.
namespace zerocount::tuning {

inline constexpr const char* not_tuned_again = "same gains, not tuned again";

/// A design point whose causes of failures are sought.
struct IdealisedPoint {
  const study::PointEdit& at;
  std::vector<rules::EffectRule> rules;
  /// Why neither the encoder nor the sample rate can be changed in this study; empty if they can.
  std::string fixed_rate_and_counts{};
};

/// Whether a parameter with this range over all trials differs from `value` in some trial.
inline bool can_differ_from(double value, const study::ParameterRange& range) {
  return range.low != value || range.high != value;
}

/// Whether a dotted path names something inside a section.
inline bool is_within(std::string_view name, std::string_view section) {
  return name.starts_with(section) && name.substr(section.size()).starts_with('.');
}

/// Calls `visit` for each parameter that has a value at the point.
/// @param visit gets the index of the value (slot) and the description of the parameter (row)
void visit_values(const study::PointEdit& at,
                  const std::function<void(std::size_t slot, const parameters::Parameter& row)>& visit);

/// Whether the parameter is a gain of the sampled control law, whose value depends on the encoder resolution
/// and the sample rate.
bool is_sampled_gain(const study::PointEdit& at, const parameters::Parameter& row);

/// Whether the parameter has an effect in trials of the point; false, for example, for parameters of another
/// friction model.
bool acts(const IdealisedPoint& point, std::string_view name);

/// Name of an effect with the phase of the control to which the parameter belongs: "no dead band of the error
/// in the coarse phase".
std::string name_in_phase(std::string_view effect, std::string_view parameter);

/// The encoders (coarse, fine) that close the loop in any control phase of any trial of the point.
struct LoopEncoders {
  bool fine{false};
  bool coarse{false};
};
LoopEncoders encoders_of(const study::PointEdit& at);

/// Adds the effect of a finer encoder to `all`, or one effect for each mass that has an encoder of its own.
void add_finer_encoders(const IdealisedPoint& point, const study::Study& study, std::vector<Effect>& all);

/// Adds to `all` the effect of twice the sample rate.
void add_faster_sampling(const IdealisedPoint& point, std::vector<Effect>& all);

/// Adds to `all` the effects of the control law and its reference: filters, the integral under friction,
/// feed-forward, and the duration of the profile.
void add_control_effects(const IdealisedPoint& point, std::vector<Effect>& all);

/// Adds to `all` the effect of a rigid axis, or of a stiffer coupling if one mass cannot represent both.
void add_rigid_axis(const IdealisedPoint& point, std::vector<Effect>& all);

/// Adds to `all` the effects that remove a constant disturbance, each ripple, each spectrum, and all
/// disturbances together.
/// @param all already contains the disturbances that are parameters with an ideal value
void add_disturbances(const IdealisedPoint& point, std::vector<Effect>& all);

}  // namespace zerocount::tuning
