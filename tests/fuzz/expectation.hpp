#pragma once

#include <functional>
#include <string_view>

namespace zerocount::fuzz {

/// Runs `subject`, which must return, or throw a Failure with exit code bad_input or bad_data and a message
/// that is not empty. Otherwise prints the reason and aborts, which the fuzzer records as a finding. (The
/// program replaces control characters when it prints a message.)
void require_clear_refusal(const std::function<void()>& subject);

/// Aborts unless `text`, a message or output for a user, is not empty, is valid UTF-8 and has no control
/// characters but line feeds and tabs.
void require_text(std::string_view text);

}  // namespace zerocount::fuzz
