#pragma once

#include <string>
#include <vector>

#include "experiments/manifest/companions.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/yaml_tree.hpp"

namespace zerocount::manifest {

/// Overrides that put the tables in place of the files that spectra of disturbance.vibration name, such as
/// "disturbance.vibration.0.spectrum=[[1, 1e-10], [100, 1e-12]]". With them a study is whole without these
/// files. A table has a line "frequency, density" for each point; a first line of names, empty lines and
/// those that begin with # are left out.
std::vector<std::string> spectrum_overrides(const yaml::YamlNode& root, const SamplesReader& read,
                                            yaml::Problems& problems);

}  // namespace zerocount::manifest
