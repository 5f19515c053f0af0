#pragma once

#include <cstdint>

#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::design_commands {

/// A study, and the point of it that is asked for.
struct ExaminedPoint {
  study::Study study;  ///< under `--condition` and at `--age` alone
  std::int64_t point{0};
  study::Study whole;  ///< with all conditions and ages

  /// The number in the whole study of a trial of `study`.
  std::int64_t trial_in_whole(std::int64_t trial) const;
};

/// `--point`, or the only point of the study.
/// @throws Failure (bad_input) if it has several points and none is named
std::int64_t named_point(const command_line::Arguments& arguments, const study::Study& study);

/// The point of `MANIFEST|FILE` with `--set`, `--point`, `--condition` and `--age`.
/// @throws Failure (bad_input) without targets, or as named_point() and trials::restricted_to()
ExaminedPoint point_to_examine(const command_line::Arguments& arguments);

/// `--set`, of commands with a manifest.
command_line::OptionSpec set_option();

/// `--condition` and `--age` of point_to_examine().
command_line::OptionSpec condition_option();
command_line::OptionSpec age_option();

/// `--point` of named_point().
command_line::OptionSpec named_point_option();

/// @throws Failure (interrupted) where `work` throws Interrupted
template <class Work>
auto unless_interrupted(const Work& work) {
  try {
    return work();
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was written");
  }
}

}  // namespace zerocount::design_commands
