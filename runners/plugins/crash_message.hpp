#pragma once

#include <filesystem>

namespace zerocount::plugins {

/// Installs a handler that prints a message naming this library if the process crashes. The process then ends
/// by its signal as usual. The handler is meant for programs whose only foreign code is a user's controller.
/// After several calls, the last library is named.
void name_in_crashes(const std::filesystem::path& library);

}  // namespace zerocount::plugins
