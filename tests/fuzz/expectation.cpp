#include "tests/fuzz/expectation.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "core/failure/failure.hpp"
#include "core/text/text.hpp"

namespace zerocount::fuzz {
namespace {

[[noreturn]] void report(const std::string& reason, std::string_view text) {
  std::fprintf(stderr, "FINDING: %s: '%.*s'\n", reason.c_str(), static_cast<int>(text.size()), text.data());
  std::abort();
}

}  // namespace

void require_text(std::string_view text) {
  if (text.empty()) report("an empty text", text);
  if (text::printable_lines(text) != text)
    report("a text with control characters or that is not UTF-8", text);
}

void require_clear_refusal(const std::function<void()>& subject) {
  try {
    subject();
  } catch (const Failure& failure) {
    if (std::string_view(failure.what()).empty()) report("an empty message", "");
    if (failure.code() != ExitCode::bad_input && failure.code() != ExitCode::bad_data)
      report("exit code " + std::to_string(static_cast<int>(failure.code())), failure.what());
  } catch (const std::exception& error) {
    report("an exception that is no Failure", error.what());
  }
}

}  // namespace zerocount::fuzz
