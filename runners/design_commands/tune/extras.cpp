#include "runners/design_commands/tune/extras.hpp"

namespace zerocount::design_commands {

tuning::Extra margins_extra();
tuning::Extra ages_extra();
tuning::Extra room_extra();
tuning::Extra robustness_extra();
tuning::Extra controls_extra();
tuning::Extra limits_extra();
tuning::Extra maps_extra();

const std::vector<tuning::Extra>& all_extras() {
  static const std::vector<tuning::Extra> extras{
      margins_extra(),     // what more delay loses; of a goal that is missed, what a wider band would change
      ages_extra(),        // at which each claim is lost, of a study with ages
      room_extra(),        // of each free parameter
      robustness_extra(),  // with other seeds, spreads and delays
      controls_extra(),    // others, each at its own best values
      limits_extra(),      // what stands between the values and the goal
      maps_extra()};       // over pairs of free parameters, for a page
  return extras;
}

}  // namespace zerocount::design_commands
