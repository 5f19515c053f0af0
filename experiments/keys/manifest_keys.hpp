#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/shapes/shape.hpp"

namespace zerocount::keys {

/// All keys of a manifest that are not parameters of a trial, such as `goal`, in the recommended order of a
/// manifest. If a shape has no setter, the reader of the key's section takes the value.
std::span<const shapes::Shape> general_keys();

/// The key that is not a parameter, with this dotted path, or null.
const shapes::Shape* find_general_key(std::string_view path);

/// The shape (allowed form of the value) of a key that is not a parameter, such as "goal" or "tune.free". The
/// key must exist.
const shapes::Shape& shape_of(std::string_view path);

/// The shape (allowed form) of an element of a list of vibrations that is given as a spectrum: {spectrum:
/// [[frequency, density], …], lines: 100}, or a file in place of the list.
const shapes::Shape& spectrum_shape();

/// The only required section of a manifest.
constexpr std::string_view required_section = "command";

/// The keys of `command` that define the moves: a study has exactly one of them.
inline constexpr std::array<std::string_view, 4> command_forms{"targets", "reference", "torque", "sequence"};

/// The keys allowed in the map with this dotted path (empty: the top level): parameters, general keys and
/// maps that contain them. In the order of the table of parameters; at the top level general keys come first.
std::vector<std::string> keys_below(std::string_view path);

/// Whether the dotted path leads to a map of further keys, such as "controller" or "controller.coarse".
bool is_section(std::string_view path);

/// Whether the dotted path is `section` or lies below it.
bool is_within(std::string_view path, std::string_view section);

/// Newest manifest version that this program supports: the value of the key `zerocount`.
constexpr std::int64_t manifest_version = 1;

/// Maximum number of trials of a study, all design points together.
constexpr std::int64_t max_study_trials = std::int64_t{1} << 53;

/// Maximum error band of a goal or measure, counts; equal to the maximum of a target.
constexpr std::int64_t max_band = 1'000'000'000'000;

/// Maximum number of rows of a recorded torque or reference in a table or list.
constexpr std::size_t max_record_rows = 100'000;

/// The values of the key `keep` (which trials a results file keeps), in the order of the enumeration
/// Retention.
inline constexpr std::array<std::string_view, 3> retention_labels{"trials", "failures", "statistics"};

/// The values of the key `design` (how the random numbers of the trials are spread), in the order of the
/// enumeration Design.
inline constexpr std::array<std::string_view, 4> design_labels{"monte_carlo", "latin_hypercube", "sobol",
                                                               "saltelli"};

/// The values of the key `command.sequence.approach`, in the order of the enumeration SequenceApproach.
inline constexpr std::array<std::string_view, 3> approach_labels{"bidirectional", "positive", "negative"};

}  // namespace zerocount::keys
