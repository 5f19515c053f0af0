#pragma once

#include <string>

#include "experiments/parameters/study_units.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {

/// The table of parameters for a terminal: name, unit, default, range, source and meaning of every parameter
/// in these units; then the distributions and the other keys of a manifest.
std::string parameters_as_text(const parameters::StudyUnits& units = {});

/// The tables of parameters_as_text() in Markdown.
std::string parameters_as_markdown(const parameters::StudyUnits& units = {});

/// The parameters of one study: the rows of the table, and a row for each value of the lists in its manifest.
std::string parameters_as_text(const study::Study& study);
std::string parameters_as_markdown(const study::Study& study);

/// The starting values of guides (experiments/guides): the quantities of each with their sources, and the
/// parameters that follow with its usual mass and preload.
std::string guides_as_text();
std::string guides_as_markdown();

}  // namespace zerocount::manifest
