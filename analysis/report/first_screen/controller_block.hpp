#pragma once

#include "analysis/report/first_screen/axis_diagram.hpp"
#include "analysis/report/first_screen/point_values.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::report {

/// The blocks of the controller that are on, with their gains. @param p of a trial of the point
DiagramBlock controller_block(const PointValues& values, const trial::TrialParameters& p);

}  // namespace zerocount::report
