#pragma once

#include <filesystem>
#include <optional>

namespace zerocount::parallel {

/// Number of processors that this process may use: those that it may run on, or fewer if its control group
/// (such as a container's) gets less processor time.
int processors();

/// Processor time per second that a process may use, by the quotas of its control group and of the groups
/// above it. Nothing without a quota. Both versions of control groups are supported.
/// @param group_list /proc/self/cgroup, a line for each hierarchy: "ID:CONTROLLERS:PATH"
/// @param mount_point mount point of the hierarchies. Groups that are not visible below it, as from inside a
/// container, are ignored.
std::optional<double> processor_quota(const std::filesystem::path& group_list,
                                      const std::filesystem::path& mount_point);

}  // namespace zerocount::parallel
