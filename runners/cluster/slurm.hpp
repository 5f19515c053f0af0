#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// The commands of Slurm: scontrol, squeue and sbatch.
namespace zerocount::cluster {

/// Slurm's default of MaxArraySize: slurm.conf(5).
inline constexpr std::int64_t default_max_array_size = 1001;

/// Maximum number of elements of an array job, and limit of their numbers. 0 if arrays are switched off.
/// @throws Failure (machine_failed) if Slurm is not installed, or with its message.
std::int64_t max_array_size();

/// The numbers of all jobs in the queue; for an array, the number of its first element.
/// @throws Failure (machine_failed) as max_array_size().
std::vector<std::string> queued_jobs();

/// Submits a script. @param after number of the job after whose end it begins; empty: none
/// @returns the number of the job
/// @throws Failure (machine_failed) as max_array_size().
std::string submit(const std::filesystem::path& script, const std::string& after);

}  // namespace zerocount::cluster
