#pragma once

#include <string>

namespace zerocount::text {

/// `word` for a POSIX shell: as it is, or in single quotes.
std::string shell_word(const std::string& word);

/// The path as a word of a command. No option begins like it: "-x.yaml" is "./-x.yaml".
std::string shell_path(const std::string& path);

}  // namespace zerocount::text
