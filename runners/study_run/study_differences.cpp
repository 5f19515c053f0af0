#include "runners/study_run/study_differences.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/comparison/manifest_differences.hpp"
#include "runners/study_run/stopping_run.hpp"

namespace zerocount {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_differences_listed = 5;

std::string described(const ManifestDifference& difference) {
  if (difference.baseline.empty())
    return fmt::format("{} is {} here, and not given there", difference.key, difference.current);
  if (difference.current.empty())
    return fmt::format("{} is {} there, and not given here", difference.key, difference.baseline);
  return fmt::format("{} is {} there and {} here", difference.key, difference.baseline, difference.current);
}

}  // namespace

std::vector<ManifestDifference> study_differences(const fs::path& path, FileHeader header,
                                                  const Study& study) {
  if (study.stop && !header.overrides.empty() && header.overrides.back().starts_with(decided_key))
    header.overrides.pop_back();
  ManifestValues there = manifest_values(header, path.string());
  ManifestValues here = manifest_values(make_header(study, FileKind::study, all_rows(study), {}), study.name);
  write_changed_defaults(there, header.version, here, format_version);
  return manifest_differences(there, here);
}

std::string differences_text(const std::vector<ManifestDifference>& differences) {
  std::string text;
  for (std::size_t i = 0; i < std::min(differences.size(), max_differences_listed); ++i)
    text += (i > 0 ? ", " : "") + described(differences[i]);
  if (differences.size() > max_differences_listed)
    text += fmt::format(", and {} more", differences.size() - max_differences_listed);
  return text;
}

}  // namespace zerocount
