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

/// Seed of random numbers that the study with this seed does not use, below 2⁵² so that every program reads
/// it exactly. @param purpose another one gives other numbers
std::uint64_t fresh_seed(std::uint64_t seed, std::string_view purpose);

/// The study with these overrides ("key=value") after its own.
/// @throws Failure (bad_input) as parse_study
study::Study variant_of(const study::Study& study, const std::vector<std::string>& overrides);

/// The study under one of its conditions, or at one of its ages, or both, as a study of its own with the same
/// machines and draws. Without either it is the study itself.
/// @throws Failure (bad_input) with the conditions and ages that there are
study::Study restricted_to(const study::Study& study, const std::optional<std::string>& condition,
                           const std::optional<double>& age);

/// Why these values together are not allowed; empty if they are. @param parameters as with_values()
std::string refusal_of_values(const study::Study& study, std::span<const std::string> parameters,
                              std::span<const double> values);

/// A study of one design point with these values of some of its numbers, in the units of its manifest. All
/// random numbers stay, and so does the text of its manifest. Nothing where such values together are not
/// allowed.
/// @param parameters dotted paths, none of which a condition overrides. @param values [parameter]
std::optional<study::Study> with_values(const study::Study& study, std::span<const std::string> parameters,
                                        std::span<const double> values);

/// Replicates of a study: machines with `trials_each` trials or, where no trials share a machine, trials that
/// have a machine each. With conditions each bears all of them equally often.
struct Replicates {
  std::int64_t count{0};
  std::int64_t trials_each{1};  ///< under all conditions together
  std::int64_t point{0};        ///< design point

  std::int64_t trials() const { return count * trials_each; }
};

/// Those of a study that is given: its machines, or its draws.
Replicates replicates_of(const study::Study& study, std::int64_t point);

/// The trial of the study that is trial i (0 … trials_each − 1) of a replicate: it runs under condition i mod
/// C.
std::int64_t trial_of_replicate(const study::Study& study, const Replicates& replicates,
                                std::int64_t replicate, std::int64_t i);

/// So many replicates or a few more, as many in each world.
std::int64_t in_equal_worlds(const study::Study& study, std::int64_t count);

/// Overrides that make a study of these replicates: independent draws, nothing retained.
std::vector<std::string> overrides_for(const study::Study& study, const Replicates& replicates);

}  // namespace zerocount::trials
