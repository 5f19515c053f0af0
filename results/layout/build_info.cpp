#include <chrono>
#include <fstream>
#include <string_view>

#include <fmt/chrono.h>

#include "results/layout/header.hpp"
#include "zerocount_git_commit.hpp"

namespace zerocount::layout {
namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

constexpr std::string_view dirty_mark = "-dirty";

std::string_view commit_of(const Provenance& provenance) {
  std::string_view commit = provenance.git_commit;
  if (is_dirty(provenance)) commit.remove_suffix(dirty_mark.size());
  return commit;
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

}  // namespace

bool is_dirty(const Provenance& provenance) {
  return provenance.git_commit.ends_with(dirty_mark);
}

bool same_build(const Provenance& one, const Provenance& other) {
  return one.zerocount_version == other.zerocount_version && commit_of(one) == commit_of(other);
}

Provenance current_provenance() {
  return {ZEROCOUNT_VERSION, ZEROCOUNT_GIT_COMMIT, ZEROCOUNT_COMPILER, cpu_model(), utc_now()};
}

}  // namespace zerocount::layout
