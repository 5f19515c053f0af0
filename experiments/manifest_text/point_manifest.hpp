#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/study/study_fwd.hpp"

namespace zerocount::manifest_text {

/// What a manifest of one design point has otherwise than its study.
struct PointChanges {
  std::string condition{};  ///< whose overrides the sections get, in place of `conditions`; empty: none
  /// (dotted path of a parameter, number): in place of what the manifest gives.
  std::vector<std::pair<std::string, double>> values{};
  /// (key at the root, YAML): in place of what the manifest gives.
  std::vector<std::pair<std::string, std::string>> keys{};
  std::vector<std::string> removed{};  ///< keys at the root, or "section.key"
  /// From which the study's manifest names its files; empty: the files that it names are not known.
  std::filesystem::path folder{};
};

/// A manifest of one design point of a study, without its sweep and what refers to it, in flow style. The
/// overrides of the study are part of it. Comments are lost.
/// @throws Failure (bad_input) if a value has no place in it, or if it names a file that is not known
std::string manifest_of_point(const study::Study& study, std::int64_t point, const PointChanges& changes);

/// The override "conditions={…}" that leaves one of the study's conditions.
std::string only_condition(const study::Study& study, const std::string& condition);

}  // namespace zerocount::manifest_text
