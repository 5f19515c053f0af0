#pragma once

#include <span>
#include <string_view>

#include "core/text/text.hpp"

/// The manifests in the folder experiments/manifests, which are part of the program.
namespace zerocount::manifests {

/// All shipped manifests, in the order of their names ("paper-gains.yaml").
std::span<const text::EmbeddedFile> shipped_manifests();

/// The manifest `name`, with or without ".yaml".
/// @throws Failure (bad_input) with the existing names, if there is no such manifest
const text::EmbeddedFile& shipped_manifest(std::string_view name);

}  // namespace zerocount::manifests
