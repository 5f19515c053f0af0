#pragma once

#include <regex>

#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {

/// Expects `action` to throw Failure with this code and a message that contains `words`.
inline void expect_failure(ExitCode code, const std::string& words, const std::function<void()>& action) {
  try {
    action();
    ADD_FAILURE() << "no failure; expected one with '" << words << "'";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), code) << failure.what();
    EXPECT_NE(std::string(failure.what()).find(words), std::string::npos) << failure.what();
    const std::regex random_name("zerocount-[A-Za-z0-9]{6}");  // of a temporary folder
    EXPECT_EQ(std::regex_replace(failure.what(), random_name, "").find("H5"), std::string::npos)
        << "text of the library: " << failure.what();
  }
}

}  // namespace zerocount::testing
