#pragma once

#include "core/friction/parameters.hpp"

namespace zerocount::friction {

/// The pre-sliding range x_b (rad): the travel of the virgin curve up to breakaway, ½·f(2·x_b) = Fs (see
/// branch_law in spring.hpp), after which a contact that is loaded slowly from rest slides. It is shorter
/// than Fs/k1, by up to the k2/(2·β·k1) that the spring is stiffer at first. Infinite if k1 = 0 and the curve
/// never reaches Fs.
double presliding_range(const FrictionParameters& friction);

}  // namespace zerocount::friction
