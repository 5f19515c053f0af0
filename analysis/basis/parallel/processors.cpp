#include "analysis/basis/parallel/processors.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include <oneapi/tbb/info.h>

#include "core/text/text.hpp"

namespace zerocount::parallel {
namespace {

namespace fs = std::filesystem;

/// Number of processors that a quota of processor time allows: quota/period, both in the same unit. Nothing
/// if either is not a positive number; the quotas "max" and -1 mean that there is no quota.
std::optional<double> ratio(const std::string& quota, const std::string& period) {
  const auto time = text::parse_number<double>(quota);
  const auto of = text::parse_number<double>(period);
  if (!time || !of || !(*time > 0.0) || !(*of > 0.0)) return std::nullopt;
  return *time / *of;
}

/// The first two words of a file; empty where there is none.
std::pair<std::string, std::string> two_words(const fs::path& path) {
  std::ifstream file(path);
  std::pair<std::string, std::string> words;
  file >> words.first >> words.second;
  return words;
}

/// Processor time per second of real time that one control group (Linux cgroup) allows; nothing without a
/// quota. The files of versions 1 and 2 are tried: a folder has those of one version only.
std::optional<double> quota_of_group(const fs::path& folder) {
  const auto [quota, period] = two_words(folder / "cpu.max");
  if (!quota.empty()) return ratio(quota, period);
  return ratio(two_words(folder / "cpu.cfs_quota_us").first, two_words(folder / "cpu.cfs_period_us").first);
}

bool has_word(std::string_view list, std::string_view word) {
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    if (list.substr(at, end - at) == word) return true;
    at = end + 1;
  }
  return false;
}

}  // namespace

std::optional<double> processor_quota(const fs::path& group_list, const fs::path& mount_point) {
  std::optional<double> lowest;
  std::ifstream lines(group_list);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (!controllers.empty() && !has_word(controllers, "cpu")) continue;
    // Version 2 has one hierarchy, without a name; version 1 has a folder for each, often with a short link.
    fs::path root = mount_point;
    if (!controllers.empty()) root /= fs::exists(mount_point / controllers) ? controllers : "cpu";
    fs::path group = root;
    const auto take = [&] {
      const std::optional<double> quota = quota_of_group(group);
      if (quota) lowest = std::min(lowest.value_or(*quota), *quota);
    };
    take();
    for (const fs::path& part : fs::path(line.substr(second + 1)).relative_path()) {
      group /= part;
      take();
    }
  }
  return lowest;
}

int processors() {
  const int all = oneapi::tbb::info::default_concurrency();
  const std::optional<double> quota = processor_quota("/proc/self/cgroup", "/sys/fs/cgroup");
  if (!quota || *quota >= all) return all;
  return std::max(1, static_cast<int>(std::ceil(*quota)));
}

}  // namespace zerocount::parallel
