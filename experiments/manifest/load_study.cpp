#include "experiments/manifest/load_study.hpp"

#include <deque>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/manifest/manifest.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/text_file.hpp"

namespace zerocount::manifest {
namespace {

[[noreturn]] void refuse_size(std::string_view source) {
  throw Failure(ExitCode::bad_input,
                fmt::format("{}:1:1: manifest: the file is too large; expected at most {} bytes", source,
                            yaml::max_manifest_size));
}

// All that determines the trials as one text. Comments and the notation of values are not part of it.
std::string joined(const yaml::YamlNode& root, const study::Study& study) {
  std::string all = manifest_text::identity_text(manifest_text::values_of(root));
  if (study.plugin) all += '\0' + study.plugin->description.sha256;
  if (study.samples) all += '\0' + hash::sha256_hex(study.samples->text);
  return all;
}

/// The tree `root`, in which the contents of a table have replaced its file name, changed so that problems in
/// these contents are reported at the place of the file name.
/// @param before tree with the file name
yaml::YamlPointer with_place_of_name(const yaml::YamlPointer& root, const yaml::YamlNode& before,
                                     std::string_view path, yaml::Problems& problems) {
  const yaml::YamlNode* const name = manifest_text::node_at(before, path);
  const yaml::YamlNode* const contents = manifest_text::node_at(*root, path);
  if (name == nullptr || contents == nullptr) return root;
  auto placed = std::make_shared<yaml::YamlNode>(*contents);
  placed->place = name->place;
  const yaml::YamlPointer changed =
      manifest_text::with_value(root, path, std::move(placed), name->place, problems);
  return changed ? changed : root;
}

/// Refuses overrides of the command line that have no effect on the study. For new studies only, because
/// results files made with such overrides must stay readable.
void require_effect(const study::Study& study, std::string_view source) {
  yaml::Problems problems;
  std::deque<std::string> sources;
  const yaml::YamlPointer written = yaml::parse_yaml(study.manifest.text, source, false, problems);
  const yaml::YamlPointer root =
      manifest_text::apply_overrides(written, study.manifest.overrides, sources, problems);
  manifest_text::report_swept_overrides(*root, study.manifest.overrides, sources, problems);
  problems.raise_if_any();
}

study::Study read_study(std::string text, std::string_view source,
                        const std::vector<std::string>& given_overrides,
                        const sections::ExternalInputs& external, bool recorded) {
  if (text.size() > yaml::max_manifest_size) refuse_size(source);
  yaml::Problems problems;
  yaml::YamlPointer root = yaml::parse_yaml(text, source, false, problems);
  if (!root && problems.empty()) {
    problems.add({source, 1, 1}, "manifest", "the manifest is empty",
                 "the keys zerocount, name, seed, trials, command");
  }
  if (!root) problems.raise_if_any();

  std::deque<std::string> override_sources;
  root = manifest_text::apply_overrides(root, given_overrides, override_sources, problems);
  std::vector<std::string> overrides = given_overrides;
  std::vector<std::string> warnings;
  if (root) {
    const std::vector<std::string> tables =
        sections::table_overrides(*root, external.samples, problems, warnings);
    const yaml::YamlPointer named = root;
    root = manifest_text::apply_overrides(root, tables, override_sources, problems);
    for (const char* const record : {"command.torque.file", "command.reference.file"})
      root = with_place_of_name(root, *named, record, problems);
    overrides.insert(overrides.end(), tables.begin(), tables.end());
  }
  const yaml::YamlPointer written = root;
  std::optional<sections::SamplesTable> samples;
  sections::insert_samples(root, external.samples, samples, problems);
  study::Study study = read_manifest(*root, recorded, external, samples ? &*samples : nullptr, problems);
  problems.raise_if_any();

  if (!recorded) study.warnings.insert(study.warnings.begin(), warnings.begin(), warnings.end());
  study.manifest.sha256 = hash::sha256_hex(text);
  study.study_sha256 = hash::sha256_hex(joined(*written, study));
  study.manifest.text = std::move(text);
  study.manifest.overrides = std::move(overrides);
  return study;
}

}  // namespace

study::Study load_study(const std::filesystem::path& manifest, const std::vector<std::string>& overrides,
                        const sections::ExternalInputs& external) {
  const std::string source = yaml::name_of_text(manifest);
  std::string text = yaml::read_text(manifest, yaml::max_manifest_size, "a manifest");
  return new_study(std::move(text), source, overrides, external);
}

study::Study new_study(std::string text, std::string_view source, const std::vector<std::string>& overrides,
                       const sections::ExternalInputs& external) {
  study::Study study = parse_study(std::move(text), source, overrides, external);
  require_effect(study, source);
  return study;
}

study::Study parse_study(std::string text, std::string_view source, const std::vector<std::string>& overrides,
                         const sections::ExternalInputs& external) {
  return read_study(std::move(text), source, overrides, external, false);
}

study::Study recorded_study(std::string text, std::string_view source,
                            const std::vector<std::string>& overrides,
                            const sections::ExternalInputs& external) {
  return read_study(std::move(text), source, overrides, external, true);
}

}  // namespace zerocount::manifest
