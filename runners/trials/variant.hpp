#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/study.hpp"

/// Studies that differ from a given one in some values.
namespace zerocount::trials {

/// Seed for random numbers that are independent of those of the study with the seed `seed`. It is below 2⁵²,
/// so that every program reads it exactly.
/// @param purpose text that distinguishes seeds; each purpose has a different seed
std::uint64_t fresh_seed(std::uint64_t seed, std::string_view purpose);

/// Study with these overrides ("key=value") applied after its own.
/// @throws Failure (bad_input) as parse_study
study::Study variant_of(const study::Study& study, const std::vector<std::string>& overrides);

/// Study restricted to one of its settings (conditions), to one of its ages, or to both. It has the same
/// machines and draws. Without setting and age it is the study itself.
/// @throws Failure (bad_input) with the existing settings and ages
study::Study restricted_to(const study::Study& study, const std::optional<std::string>& setting,
                           const std::optional<double>& age);

/// Reason why the parameters of a study cannot have these values together; empty if they can.
/// @param parameters dotted paths; no setting may override them
/// @param values [parameter] value in the unit of the manifest
std::string refusal_of_values(const study::Study& study, std::span<const std::string> parameters,
                              std::span<const double> values);

/// Copy of a study with one design point in which some parameters have these values. The random numbers and
/// the text of the manifest stay the same. Nothing if the values are not allowed together.
/// @param parameters dotted paths; no setting may override them
/// @param values [parameter] value in the unit of the manifest
std::optional<study::Study> with_values(const study::Study& study, std::span<const std::string> parameters,
                                        std::span<const double> values);

/// Independent repetitions of a study at one design point. A replicate is a machine with `trials_each` trials
/// or, if no trials share a machine, a draw with a machine of its own. Each replicate has equally many trials
/// in each setting (condition at an age).
struct Replicates {
  std::int64_t count{0};  ///< Number of replicates (machines, or draws with a machine of their own).
  /// Number of trials of a replicate, in all settings (conditions at ages) together.
  std::int64_t trials_each{1};
  std::int64_t point{0};  ///< Index of the design point.

  std::int64_t trials() const { return count * trials_each; }
};

/// Replicates of an existing study at a design point: its machines or, without machines, its draws.
/// @param point index of the design point
Replicates replicates_of(const study::Study& study, std::int64_t point);

/// Number, in the study, of the i-th trial (0 … trials_each − 1) of a replicate. With C settings (conditions
/// at ages), it runs under setting i mod C.
std::int64_t trial_of_replicate(const study::Study& study, const Replicates& replicates,
                                std::int64_t replicate, std::int64_t i);

/// Smallest number of replicates that is at least `count` and puts equally many in each world (one draw of
/// the values that all machines share and nobody knows).
std::int64_t in_equal_worlds(const study::Study& study, std::int64_t count);

/// Overrides ("key=value") that turn a study into one with this number of replicates and trials. Its draws
/// are independent, and no trace is retained.
std::vector<std::string> overrides_for(const study::Study& study, const Replicates& replicates);

}  // namespace zerocount::trials
