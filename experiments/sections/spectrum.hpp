#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/trial/disturbance.hpp"
#include "experiments/sections/companions.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::sections {

/// Whether an element of disturbance.vibration or disturbance.load.vibration is {spectrum: [[frequency,
/// density], …], lines: 100}.
bool is_spectrum(const yaml::Field& element);

/// Reads such an element; null after errors, which it reports.
std::shared_ptr<const trial::SpectrumParameters> read_spectrum(const yaml::Field& element,
                                                               yaml::Problems& problems);

/// Overrides that put the tables in place of the files that their spectra name, such as
/// "disturbance.vibration.0.spectrum=[[1, 1e-10], [100, 1e-12]]". With them a study is whole without these
/// files. A table has a line "frequency, density" for each point; a first line of names, empty lines and
/// those that begin with # are left out.
std::vector<std::string> spectrum_overrides(const yaml::YamlNode& root, const SamplesReader& read,
                                            yaml::Problems& problems);

}  // namespace zerocount::sections
