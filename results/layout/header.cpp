#include "results/layout/header.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "core/hash/sha256.hpp"
#include "core/text/text.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/hdf5/foreign_file.hpp"
#include "results/layout/point_sums.hpp"
#include "results/layout/recorded_values.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::layout {
namespace {

struct Format {
  std::string_view name;
  FileKind kind;
};
constexpr std::array<Format, 3> formats{{{"zerocount-study", FileKind::study},
                                         {"zerocount-statistics", FileKind::study},  // without all trials
                                         {"zerocount-rare", FileKind::rare}}};

std::string_view format_name(const FileHeader& header) {
  if (header.kind == FileKind::rare) return formats[2].name;
  return formats[has_sums(header.retention) ? 1 : 0].name;
}

std::string_view retention_label(study::Retention retention) {
  return keys::retention_labels[static_cast<std::size_t>(retention)];
}

/// Returns `text` if it can be stored in the file. Rejects a text with a zero byte, because it would silently
/// be cut there.
const std::string& storable(const hdf5::File& file, const std::string& text) {
  if (text.find('\0') != std::string::npos) file.fail("a text with a zero byte cannot be stored");
  return text;
}

void write_overrides(hdf5::File& file, const std::vector<std::string>& overrides) {
  const bool empty = overrides.empty();
  const hdf5::Size size = overrides.size();
  hdf5::Dataset dataset =
      file.create_dataset("overrides", {hdf5::Element::text, {size}, {empty ? 1 : size}, empty});
  for (const std::string& override_text : overrides) storable(file, override_text);
  dataset.write_texts(overrides);
  dataset.make_scale("overrides");
  dataset.set_text("units", "1");
  dataset.set_text("long_name", "values given on the command line in place of the manifest's");
}

}  // namespace

void write_single_text(hdf5::File& file, const std::string& name, const std::string& text,
                       const std::string& meaning) {
  hdf5::Dataset dataset = file.create_dataset(name, {hdf5::Element::text, {}, {}, false});
  dataset.write_texts(std::vector<std::string>{storable(file, text)});
  dataset.set_text("units", "1");
  dataset.set_text("long_name", meaning);
}

std::optional<std::string> read_single_text(const hdf5::File& file, const std::string& name) {
  if (!file.contains(name)) return std::nullopt;
  const std::vector<std::string> texts = file.open_dataset(name).read_texts();
  if (texts.size() != 1) file.fail(fmt::format("/{} is not a single text", name));
  return texts.front();
}

namespace {

std::optional<plugin::PluginDescription> read_plugin(const hdf5::File& file) {
  const std::optional<std::string> text = read_single_text(file, "controller_plugin");
  if (!text) return std::nullopt;
  std::optional<plugin::PluginDescription> plugin = plugin_from_json(*text);
  if (!plugin) file.fail("the description of its controller cannot be read");
  return plugin;
}

const Format& read_format(const hdf5::File& file) {
  if (!file.has_attribute("format"))
    throw ForeignFile(file.file_name(), "not a results file of zerocount: the attribute 'format' is missing");
  const std::string name = file.text("format");
  const auto format =
      std::find_if(formats.begin(), formats.end(), [&](const Format& known) { return known.name == name; });
  if (format != formats.end()) return *format;
  throw ForeignFile(file.file_name(), fmt::format("its format is '{}'; expected '{}' or another of zerocount",
                                                  name, formats.front().name));
}

study::Retention read_retention(const hdf5::File& file) {
  if (!file.has_attribute("keep")) return study::Retention::trials;
  const std::string name = file.text("keep");
  for (const study::Retention retention : {study::Retention::failures, study::Retention::statistics}) {
    if (name == retention_label(retention)) return retention;
  }
  file.fail(fmt::format("its attribute 'keep' is '{}'; expected '{}' or '{}'", name,
                        retention_label(study::Retention::failures),
                        retention_label(study::Retention::statistics)));
}

void require_version(const hdf5::File& file) {
  const std::int64_t version = file.integer("format_version");
  if (version == format_version) return;
  const std::string writer = file.text("zerocount_version");
  throw ForeignFile(
      file.file_name(),
      fmt::format("zerocount {} wrote it in format version {}, {}", writer, version,
                  version > format_version
                      ? fmt::format("newer than the {} that this program reads; read it with that zerocount "
                                    "or a later one",
                                    format_version)
                      : fmt::format("and this program reads version {}; run its manifest again, or read it "
                                    "with that zerocount",
                                    format_version)));
}

study::Engine read_engine(const hdf5::File& file) {
  const std::string name = file.text("engine");
  for (const study::Engine engine : {study::Engine::batch, study::Engine::reference}) {
    if (name == name_of(engine)) return engine;
  }
  file.fail(fmt::format("its engine is '{}'; expected 'batch' or 'reference'", name));
}

void check_numbers(const hdf5::File& file, const FileHeader& header) {
  if (!has_possible_numbers(header)) {
    file.fail(fmt::format("{} trials from trial {} on cannot belong to {} design points with {} trials each",
                          header.rows.count, header.rows.first, header.points, header.trials));
  }
  const bool all = header.rows.count == header.trials * header.points;
  if (header.complete != (all && header.kind == FileKind::study)) {
    file.fail("the attribute 'complete' contradicts the number of trials");
  }
}

}  // namespace

ForeignFile::ForeignFile(const std::filesystem::path& path, const std::string& what_it_is)
    : Failure(ExitCode::bad_data, text::printable_lines(fmt::format("{}: {}", path.string(), what_it_is))) {}

RareFile::RareFile(const std::filesystem::path& path)
    : ForeignFile(path,
                  "an estimate of 'zerocount rare', which holds no trials of the study; expected a results "
                  "file of 'zerocount run'") {}

bool has_possible_numbers(const FileHeader& header) {
  constexpr std::int64_t max_rows = std::int64_t{1} << 53;
  return header.trials > 0 && header.points > 0 && header.trials <= max_rows / header.points &&
         header.rows.first >= 0 && header.rows.first < max_rows && header.rows.count > 0 &&
         header.rows.count <= max_rows && header.rows.end() <= header.trials * header.points;
}

bool has_trials(study::Retention retention) {
  return retention != study::Retention::statistics;
}

bool has_sums(study::Retention retention) {
  return retention != study::Retention::trials;
}

void require_every_trial(const std::filesystem::path& path, const FileHeader& header) {
  if (!has_sums(header.retention)) return;
  throw ForeignFile(
      path, fmt::format("it was made with keep: {}, and this needs every trial; a run with keep: {} "
                        "has them, and 'zerocount summary' reads this file",
                        retention_label(header.retention), retention_label(study::Retention::trials)));
}

std::string_view name_of(study::Engine engine) {
  return engine == study::Engine::batch ? "batch" : "reference";
}

RowRange all_rows(const study::Study& study) {
  return {0, study::trial_count(study)};
}

FileHeader make_header(const study::Study& study, FileKind kind, RowRange rows, Provenance provenance) {
  return {.kind = kind,
          .retention = study.retention,
          .name = study.name,
          .provenance = std::move(provenance),
          .engine = study.engine,
          .seed = study.seed,
          .trials = study.trials,
          .points = study::point_count(study),
          .rows = rows,
          .complete = kind == FileKind::study && rows == all_rows(study),
          .finished = false,
          .manifest = study.manifest.text,
          .overrides = study.manifest.overrides,
          .manifest_sha256 = study.manifest.sha256,
          .study_sha256 = study.study_sha256,
          .plugin = study.plugin ? std::optional(study.plugin->description) : std::nullopt,
          .samples = study.samples ? std::optional(study.samples->text) : std::nullopt};
}

void write_header(hdf5::File& file, const FileHeader& header) {
  file.set_text("format", std::string(format_name(header)));
  if (has_sums(header.retention) && header.kind != FileKind::rare) {
    file.set_text("keep", std::string(retention_label(header.retention)));
    file.set_text("sums_form", sums_form());
  }
  file.set_integer("format_version", format_version);
  file.set_text("name", storable(file, header.name));
  file.set_text("zerocount_version", header.provenance.zerocount_version);
  file.set_text("git_commit", header.provenance.git_commit);
  file.set_text("compiler", header.provenance.compiler);
  file.set_text("cpu", header.provenance.cpu);
  file.set_text("created", header.provenance.created);
  file.set_text("engine", std::string(name_of(header.engine)));
  file.set_unsigned("seed", header.seed);
  file.set_text("manifest_sha256", header.manifest_sha256);
  file.set_text("study_sha256", header.study_sha256);
  file.set_integer("trials", header.trials);
  file.set_integer("points", header.points);
  file.set_integer("first_trial", header.rows.first);
  file.set_integer("trial_count", header.rows.count);
  file.set_integer("complete", header.complete ? 1 : 0);
  write_single_text(file, "manifest", header.manifest, "exact text of the manifest");
  write_overrides(file, header.overrides);
  if (header.plugin) {
    write_single_text(file, "controller_plugin", plugin_as_json(*header.plugin),
                      "the user's controller, as JSON: name, version, SHA-256, parameters");
  }
  if (header.samples) {
    write_single_text(file, "samples", *header.samples,
                      "exact text of the table of joint draws that the manifest's key samples names");
  }
}

void mark_finished(hdf5::File& file) {
  file.set_integer("finished", 1);
}

namespace {

FileHeader read_any_header(const hdf5::File& file) {
  FileHeader header;
  header.kind = read_format(file).kind;
  header.retention = read_retention(file);
  require_version(file);
  header.name = file.text("name");
  header.provenance = {file.text("zerocount_version"), file.text("git_commit"), file.text("compiler"),
                       file.text("cpu"), file.text("created")};
  header.engine = read_engine(file);
  header.seed = file.unsigned_integer("seed");
  header.manifest_sha256 = file.text("manifest_sha256");
  header.study_sha256 = file.text("study_sha256");
  header.trials = file.integer("trials");
  header.points = file.integer("points");
  header.rows = {file.integer("first_trial"), file.integer("trial_count")};
  header.complete = file.integer("complete") != 0;
  header.finished = file.has_attribute("finished") && file.integer("finished") == 1;
  const std::optional<std::string> manifest = read_single_text(file, "manifest");
  if (!manifest) file.fail("the manifest is missing");
  header.manifest = *manifest;
  header.overrides = file.open_dataset("overrides").read_texts();
  header.plugin = read_plugin(file);
  header.samples = read_single_text(file, "samples");
  check_numbers(file, header);
  if (hash::sha256_hex(header.manifest) != header.manifest_sha256)
    file.fail("the checksum of the manifest is wrong");
  return header;
}

}  // namespace

FileHeader read_header(const hdf5::File& file) {
  FileHeader header = read_any_header(file);
  if (header.kind != FileKind::rare) return header;
  throw RareFile(file.file_name());
}

FileHeader read_rare_header(const hdf5::File& file) {
  FileHeader header = read_any_header(file);
  if (header.kind == FileKind::rare) return header;
  throw ForeignFile(file.file_name(), "no estimate of 'zerocount rare'");
}

bool is_rare(const hdf5::File& file) {
  return read_format(file).kind == FileKind::rare;
}

study::Study recorded_study(const FileHeader& header, const std::filesystem::path& path,
                            std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  if (plugin) require_same_plugin(path, header, plugin.get());
  if (!plugin && header.plugin)
    plugin = std::make_shared<const plugin::ControllerPlugin>(plugin::ControllerPlugin{*header.plugin});
  study::Study study =
      manifest::recorded_study(header.manifest, path.string() + ":/manifest", header.overrides,
                               sections::known_external_inputs(std::move(plugin), header.samples));
  study.engine = header.engine;
  if (study.trials != header.trials || study::point_count(study) != header.points) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: damaged: it has {} design points with {} trials each; its manifest and "
                    "overrides have {} with {}",
                    path.string(), header.points, header.trials, study::point_count(study), study.trials));
  }
  return study;
}

void require_same_plugin(const std::filesystem::path& path, const FileHeader& header,
                         const plugin::ControllerPlugin* plugin) {
  const auto text_of = [](const plugin::PluginDescription* description) {
    return description == nullptr ? std::string("the built-in controller")
                                  : fmt::format("the plugin {} {} with SHA-256 {}", description->name,
                                                description->version, description->sha256);
  };
  const std::string there = text_of(header.plugin ? &*header.plugin : nullptr);
  const std::string here = text_of(plugin != nullptr ? &plugin->description : nullptr);
  if (there == here) return;
  throw ForeignFile(
      path, fmt::format("its trials were run with {}, and this is {}: they are not mixed", there, here));
}

void require_same_study(const std::filesystem::path& path, const FileHeader& header,
                        const study::Study& study) {
  const std::vector<manifest_text::ManifestDifference> differences = study_differences(path, header, study);
  if (!differences.empty())
    throw ForeignFile(path, "is from another study: " + manifest_text::differences_text(differences));
  require_same_plugin(path, header, study.plugin.get());
  if (header.trials != study.trials || header.points != study::point_count(study)) {
    throw ForeignFile(
        path, fmt::format("has {} design points with {} trials each; the study has {} with {}", header.points,
                          header.trials, study::point_count(study), study.trials));
  }
  const Provenance here = current_provenance();
  if (!same_build(header.provenance, here)) {
    throw ForeignFile(
        path,
        fmt::format("its trials were run by zerocount {} (commit {}), and this is {} (commit {}): trials "
                    "of different builds are not mixed; finish with the same build, or start a new output",
                    header.provenance.zerocount_version, header.provenance.git_commit, here.zerocount_version,
                    here.git_commit));
  }
  if (header.engine != study.engine) {
    throw ForeignFile(path,
                      fmt::format("its trials were run by the {} engine, and this is for the {} engine: "
                                  "they are not mixed; give --engine {}, or start a new output",
                                  name_of(header.engine), name_of(study.engine), name_of(header.engine)));
  }
  // The same build gives the same values the same hash.
  if (header.study_sha256 != study.study_sha256)
    throw ForeignFile(path, "is from another study: its SHA-256 differs");
}

std::filesystem::path shards_directory(const std::filesystem::path& output) {
  std::filesystem::path directory = output;
  directory += ".shards";
  return directory;
}

hdf5::File open_results(const std::filesystem::path& path, Checksum checksum) {
  std::error_code ignored;
  if (path == "-") {
    throw Failure(ExitCode::bad_input, "-: a results file cannot be read from standard input; name the file");
  }
  if (!std::filesystem::exists(path, ignored)) {
    const std::filesystem::path shards = shards_directory(path);
    const bool unfinished = std::filesystem::exists(shards, ignored);
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: no such file{}", path.string(),
                              unfinished ? fmt::format("; the run that makes it has not ended ({}): "
                                                       "'zerocount summary' shows what it has finished",
                                                       shards.string())
                                         : ""));
  }
  if (!std::filesystem::is_regular_file(path, ignored)) {
    const char* const kind =
        std::filesystem::is_directory(path, ignored) ? "a directory" : "not a regular file";
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {}; a results file was expected", path.string(), kind));
  }
  if (!storage::FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC)).valid())
    storage::fail_with(path, "read", errno);
  if (!hdf5::is_hdf5(path)) {
    constexpr std::size_t bytes_read = 4096;
    const std::optional<yaml::OtherFormat> other = yaml::other_format(storage::bytes_at(path, 0, bytes_read));
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: not a results file of zerocount: it is not in the HDF5 format{}{}{}{}",
                              path.string(), other ? ", but " : "", other ? other->what : "",
                              other && !other->remedy.empty() ? ", " : "", other ? other->remedy : ""));
  }
  if (checksum == Checksum::not_yet) return hdf5::open_foreign(path);
  storage::require_valid_checksum(path);
  return hdf5::File::open_to_read(path);
}

}  // namespace zerocount::layout
