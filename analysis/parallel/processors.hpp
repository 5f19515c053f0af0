#pragma once

#include <filesystem>
#include <optional>

namespace zerocount::parallel {

/// Processors that this process may use: those that it may run on, or fewer where its control group, such as
/// that of a container, gets less of their time.
int processors();

/// The processor time per second that a process may use by the quotas of its control group and of those above
/// it; nothing without a quota. Both versions of control groups are known.
/// @param group_list /proc/self/cgroup, a line for each hierarchy: "ID:CONTROLLERS:PATH"
/// @param mount_point of the hierarchies. Groups that are not seen below it, as from inside a container, are
/// passed over.
std::optional<double> processor_quota(const std::filesystem::path& group_list,
                                      const std::filesystem::path& mount_point);

}  // namespace zerocount::parallel
