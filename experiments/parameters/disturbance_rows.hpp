#pragma once

#include "experiments/parameters/element_lists.hpp"

namespace zerocount::parameters {

ElementList ripple_list();     ///< disturbance.ripple
ElementList vibration_list();  ///< disturbance.vibration

}  // namespace zerocount::parameters
