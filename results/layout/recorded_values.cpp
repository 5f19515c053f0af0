#include "results/layout/recorded_values.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/earlier_defaults.hpp"

namespace zerocount::layout {
namespace {

/// Whether the manifest gives the parameter a value, or one to every point of a grid.
bool gives(const manifest_text::ManifestValues& values, std::string_view parameter) {
  return std::any_of(values.begin(), values.end(), [&](const auto& entry) {
    return keys::is_within(entry.first, parameter) ||
           keys::is_within(entry.first, fmt::format("sweep.grid.{}", parameter));
  });
}

void write_default(manifest_text::ManifestValues& values, const parameters::Parameter& parameter,
                   std::int64_t version) {
  if (gives(values, parameter.name)) return;
  values[std::string(parameter.name)] =
      parameters::number_text(parameter, parameters::default_value_in(parameter, version));
}

}  // namespace

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

void write_changed_defaults(manifest_text::ManifestValues& baseline, std::int64_t baseline_version,
                            manifest_text::ManifestValues& current, std::int64_t current_version) {
  for (const parameters::EarlierDefault& earlier : parameters::earlier_defaults()) {
    const parameters::Parameter& parameter =
        parameters::parameter_table()[parameters::find_parameter(earlier.name).value()];
    if (parameters::default_value_in(parameter, baseline_version) ==
        parameters::default_value_in(parameter, current_version))
      continue;
    write_default(baseline, parameter, baseline_version);
    write_default(current, parameter, current_version);
  }
}

std::vector<manifest_text::ManifestDifference> study_differences(const std::filesystem::path& path,
                                                                 const FileHeader& header,
                                                                 const study::Study& study) {
  // Equal hashes mean equal values; the manifests of thousands of shards need not be read.
  if (header.study_sha256 == study.study_sha256 && header.version == format_version) return {};
  manifest_text::ManifestValues there = manifest_values(header, path.string());
  manifest_text::ManifestValues here =
      manifest_values(make_header(study, FileKind::study, all_rows(study), {}), study.name);
  write_changed_defaults(there, header.version, here, format_version);
  return manifest_text::manifest_differences(there, here);
}

}  // namespace zerocount::layout
