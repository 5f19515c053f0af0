#include "experiments/study.hpp"

#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "core/failure.hpp"
#include "experiments/designs/sha256.hpp"
#include "experiments/language/manifest.hpp"
#include "experiments/language/overrides.hpp"
#include "experiments/parameters/earlier_defaults.hpp"

namespace zerocount {
namespace {

[[noreturn]] void refuse_size(std::string_view source) {
  throw Failure(ExitCode::bad_input,
                fmt::format("{}:1:1: manifest: the file is too large; expected at most {} bytes", source,
                            largest_manifest));
}

// At most one byte more than a manifest may have, so that a huge or endless file is refused at once.
std::string read_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: there is no such file; expected a manifest", path.string()));
  }
  if (std::filesystem::is_directory(status)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: this is a directory; expected a manifest", path.string()));
  }
  std::ifstream file(path, std::ios::binary);
  std::string text(largest_manifest + 1, '\0');
  if (file) file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.is_open() || file.bad()) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: the manifest cannot be read: {}", path.string(), std::strerror(errno)));
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

// Text and overrides as one text; neither can contain the separator.
std::string joined(const std::string& text, const std::vector<std::string>& overrides) {
  std::string all = text;
  for (const std::string& override_text : overrides) {
    all += '\0';
    all += override_text;
  }
  return all;
}

}  // namespace

Study load_study(const std::filesystem::path& manifest, const std::vector<std::string>& overrides) {
  return parse_study(read_file(manifest), manifest.string(), overrides);
}

Study parse_study(std::string text, std::string_view source, const std::vector<std::string>& overrides) {
  return parse_study(std::move(text), source, overrides, newest_version);
}

Study parse_study(std::string text, std::string_view source, const std::vector<std::string>& overrides,
                  std::int64_t version) {
  if (text.size() > largest_manifest) refuse_size(source);
  Problems problems;
  YamlPointer root = parse_yaml(text, source, false, problems);
  if (!root && problems.empty()) {
    problems.add({source, 1, 1}, "manifest", "the manifest is empty",
                 "the keys zerocount, name, seed, trials, command");
  }
  if (!root) problems.raise_if_any();

  std::deque<std::string> override_sources;
  root = apply_overrides(root, overrides, override_sources, problems);
  Study study = read_manifest(*root, version, problems);
  problems.raise_if_any();

  study.manifest_sha256 = sha256_hex(text);
  study.study_sha256 = sha256_hex(joined(text, overrides));
  study.manifest_text = std::move(text);
  study.overrides = overrides;
  return study;
}

}  // namespace zerocount
