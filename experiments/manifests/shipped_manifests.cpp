#include "experiments/manifests/shipped_manifests.hpp"

#include <string>

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::manifests {

const text::EmbeddedFile& shipped_manifest(std::string_view name) {
  std::string names;
  for (const text::EmbeddedFile& file : shipped_manifests()) {
    const std::string_view stem = file.name.substr(0, file.name.rfind('.'));
    if (name == file.name || name == stem) return file;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", stem);
  }
  throw Failure(ExitCode::bad_input, fmt::format("unknown manifest '{}'; expected one of {}", name, names));
}

}  // namespace zerocount::manifests
