#include "results/layout/build_info.hpp"

#include <chrono>
#include <fstream>

#include <fmt/chrono.h>

#include "zerocount_git_commit.hpp"

namespace zerocount {
namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

}  // namespace

Provenance current_provenance() {
  return {ZEROCOUNT_VERSION, ZEROCOUNT_GIT_COMMIT, ZEROCOUNT_COMPILER, cpu_model(), utc_now()};
}

}  // namespace zerocount
