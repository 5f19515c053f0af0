#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/summary/summary.hpp"

/// Names of design points and swept parameters for people.
namespace zerocount::summary {

/// The swept parameters with different values at different points, or with a distribution; without "case".
std::vector<const study::SweepAxis*> varying_parameters(std::span<const study::SweepAxis> axes);

/// The end of the dotted path of the axis that no other swept parameter has: "ki", or "coarse.kp" beside a
/// "kp".
std::string short_name(std::span<const study::SweepAxis> axes, const study::SweepAxis& axis);

/// [point] its label as tables show it: the paths in the labels of a grid are shortened to their ends, as in
/// "kp=400 ki=8e4".
std::vector<std::string> short_labels(std::vector<std::string> labels,
                                      std::span<const study::SweepAxis> axes);

/// [point] its number and short label: "3 (kp=400 ki=8e4)". Only the label where it does not name swept
/// values, as that of a case.
std::vector<std::string> point_names(const StudySummary& summary);

}  // namespace zerocount::summary
