#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace zerocount::text {

/// "1 trial", "2 trials", "0 trials". @param noun in the singular, of which the plural ends in s
std::string counted(std::integral auto count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace zerocount::text
