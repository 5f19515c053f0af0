#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::keys {

/// The key beside a distribution or profile that specifies how often it is drawn.
constexpr std::string_view per_key = "per";

/// Its values, in the order of the enumeration DrawLevel.
inline constexpr std::array<std::string_view, 5> draw_level_labels{"study", "world", "rig", "trial",
                                                                   "contact"};

/// Those that a profile may have.
inline constexpr std::array<std::string_view, 2> draw_level_labels_of_profiles{"study", "rig"};

/// The groups of trials that a study has.
struct TrialGroups {
  bool rigs{false};
  bool worlds{false};
  bool ages{false};
};

/// Kind of draw: a single value, or a profile along the rotor.
enum class Drawn {
  value,
  profile,
  interval  ///< a value without a distribution
};

/// Default of `per`. With rigs, parameters of the machine are drawn for every rig and others for every trial.
/// Without rigs, values are drawn for every trial and profiles once for the study. Intervals are drawn for
/// every world.
study::DrawLevel usual_level(const parameters::Parameter& parameter, Drawn drawn, const TrialGroups& groups);

/// The value of the key `per` in `field`. Reports an unknown value or one that the parameter does not allow,
/// and returns nothing then.
std::optional<study::DrawLevel> read_draw_level(const yaml::Field& field,
                                                const parameters::Parameter& parameter, Drawn drawn,
                                                const TrialGroups& groups, yaml::Problems& problems);

}  // namespace zerocount::keys
