#pragma once

#include <string>

#include "experiments/study.hpp"

namespace zerocount {

/// The five keys that a manifest must have, on five lines, and `more` after them.
std::string minimal_manifest(const std::string& more = "");

/// A manifest that uses every section, distributions, a profile and a sweep.
std::string full_manifest();

/// parse_study of the text under the name "m.yaml".
Study study_of(const std::string& text, const std::vector<std::string>& overrides = {});

/// Index of the input column with this name.
std::size_t column_of(const Study& study, const std::string& name);

}  // namespace zerocount
