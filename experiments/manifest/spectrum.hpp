#pragma once

#include <memory>

#include "core/trial/disturbance.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::manifest {

/// Whether an element of disturbance.vibration is {spectrum: [[frequency, density], …], lines: 100}.
bool is_spectrum(const yaml::Field& element);

/// Reads such an element; null after errors, which it reports.
std::shared_ptr<const trial::SpectrumParameters> read_spectrum(const yaml::Field& element,
                                                               yaml::Problems& problems);

}  // namespace zerocount::manifest
