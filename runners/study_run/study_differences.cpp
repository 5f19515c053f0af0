#include "runners/study_run/study_differences.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/comparison/manifest_differences.hpp"
#include "runners/study_run/stopping_run.hpp"

namespace zerocount::study_run {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_differences_listed = 5;

std::string described(const comparison::ManifestDifference& difference) {
  if (difference.baseline.empty())
    return fmt::format("{} is {} here, and not given there", difference.key, difference.current);
  if (difference.current.empty())
    return fmt::format("{} is {} there, and not given here", difference.key, difference.baseline);
  return fmt::format("{} is {} there and {} here", difference.key, difference.baseline, difference.current);
}

}  // namespace

std::vector<comparison::ManifestDifference> study_differences(const fs::path& path, layout::FileHeader header,
                                                              const study::Study& study) {
  if (study.stop && !header.overrides.empty() && header.overrides.back().starts_with(decided_key))
    header.overrides.pop_back();
  comparison::ManifestValues there = comparison::manifest_values(header, path.string());
  comparison::ManifestValues here = comparison::manifest_values(
      layout::make_header(study, layout::FileKind::study, layout::all_rows(study), {}), study.name);
  comparison::write_changed_defaults(there, header.version, here, layout::format_version);
  return comparison::manifest_differences(there, here);
}

std::string differences_text(const std::vector<comparison::ManifestDifference>& differences) {
  std::string text;
  for (std::size_t i = 0; i < std::min(differences.size(), max_differences_listed); ++i)
    text += (i > 0 ? ", " : "") + described(differences[i]);
  if (differences.size() > max_differences_listed)
    text += fmt::format(", and {} more", differences.size() - max_differences_listed);
  return text;
}

}  // namespace zerocount::study_run
