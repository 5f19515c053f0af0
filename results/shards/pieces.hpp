#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace zerocount::shards {

/// Part `number` of `count` of a study whose parts are run by an array job.
struct Part {
  std::filesystem::path path;  ///< Path OUTPUT.parts/part-007-of-128.h5, whether the file exists or not
  std::int64_t number{1};      ///< Number of this part of the study, 1 to `count`
  std::int64_t count{1};       ///< Number of parts into which the study is divided
};

/// The folder that holds the parts of the results file `output` in an array job: OUTPUT.parts.
std::filesystem::path parts_directory(const std::filesystem::path& output);

/// The part of a study to which a file or a folder of shards belongs, by its name; empty if the name is not
/// the name of a part.
std::optional<Part> part_named(const std::filesystem::path& path);

/// The parts of `output` that an array job has begun, because a file or a folder of shards exists for them,
/// in order of their numbers.
/// @throws Failure (machine_failed) if a directory cannot be read.
std::vector<Part> begun_parts(const std::filesystem::path& output);

/// The files with the finished trials of a results file `output` that is not complete yet: its shards or, in
/// order of rows, its finished parts and the shards of its unfinished parts. Empty if there are none. A file
/// may vanish afterwards, because it is joined to others.
/// @throws Failure (machine_failed) if a directory cannot be read.
std::vector<std::filesystem::path> finished_pieces(const std::filesystem::path& output);

/// Whether a run that makes `output` has begun and not yet ended in a results file: its folder of shards or
/// of parts exists.
bool has_begun(const std::filesystem::path& output);

}  // namespace zerocount::shards
