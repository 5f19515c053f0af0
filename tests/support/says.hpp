#pragma once

#include <string_view>

#include <gtest/gtest.h>

namespace zerocount {

/// Whether a text contains all of these parts. If not, the test's failure message shows the text and the
/// missing part.
template <class... Parts>
::testing::AssertionResult says(std::string_view text, const Parts&... parts) {
  std::string_view missing;
  const bool all =
      ((text.find(std::string_view(parts)) != text.npos || (missing = std::string_view(parts), false)) &&
       ...);
  if (all) return ::testing::AssertionSuccess() << text;
  return ::testing::AssertionFailure() << "no '" << missing << "' in\n" << text;
}

}  // namespace zerocount
