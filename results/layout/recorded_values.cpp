#include "results/layout/recorded_values.hpp"

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::layout {

manifest_text::ManifestValues manifest_values(const FileHeader& header, const std::string& source) {
  manifest_text::ManifestValues values;
  try {
    values = manifest_text::values_of(header.manifest, source + ":/manifest", header.overrides);
  } catch (const Failure& failure) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: its manifest cannot be read: {}", source, failure.what()));
  }
  if (header.samples) values["samples, SHA-256 of the table"] = hash::sha256_hex(*header.samples);
  return values;
}

std::vector<manifest_text::ManifestDifference> study_differences(const std::filesystem::path& path,
                                                                 const FileHeader& header,
                                                                 const study::Study& study) {
  // Equal hashes mean equal values; the manifests of thousands of shards need not be read.
  if (header.study_sha256 == study.study_sha256) return {};
  manifest_text::ManifestValues there = manifest_values(header, path.string());
  manifest_text::ManifestValues here =
      manifest_values(make_header(study, FileKind::study, all_rows(study), {}), study.name);
  return manifest_text::manifest_differences(there, here);
}

}  // namespace zerocount::layout
