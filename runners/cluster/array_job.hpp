#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// A study that an array job of Slurm runs: its trials in parts, which are results files of their own, and a
/// job that merges them.
namespace zerocount::cluster {

/// Parts and elements of an array job. Element e (0 … elements − 1) runs the parts e + 1, e + 1 + elements, …
struct ArrayJob {
  std::int64_t parts{1};
  std::int64_t elements{1};  ///< at most Slurm's MaxArraySize, which limits the index too
};

/// @param max_array_size of the cluster
ArrayJob array_job(std::int64_t parts, std::int64_t max_array_size);

/// The elements that run these parts, in ascending order without repetition.
std::vector<std::int64_t> elements_of(const ArrayJob& job, std::span<const std::int64_t> parts);

/// Ascending numbers in the format of Slurm: "0-3,7".
std::string index_list(std::span<const std::int64_t> indices);

}  // namespace zerocount::cluster
