#include "runners/study_run/study_differences.hpp"

#include "results/layout/recorded_values.hpp"
#include "runners/study_run/stopping_run.hpp"

namespace zerocount::study_run {

namespace fs = std::filesystem;

std::vector<manifest::ManifestDifference> study_differences(const fs::path& path, layout::FileHeader header,
                                                            const study::Study& study) {
  if (study.stop && !header.overrides.empty() && header.overrides.back().starts_with(decided_key))
    header.overrides.pop_back();
  manifest::ManifestValues there = layout::manifest_values(header, path.string());
  manifest::ManifestValues here = layout::manifest_values(
      layout::make_header(study, layout::FileKind::study, layout::all_rows(study), {}), study.name);
  layout::write_changed_defaults(there, header.version, here, layout::format_version);
  return manifest::manifest_differences(there, here);
}

}  // namespace zerocount::study_run
