#pragma once

#include <filesystem>

namespace zerocount::plugins {

/// From now on, a crash of the process prints a message that names this library before the process ends by
/// its signal as before. For programs whose only foreign code is a user's controller. Of several libraries
/// the last one is named.
void name_in_crashes(const std::filesystem::path& library);

}  // namespace zerocount::plugins
