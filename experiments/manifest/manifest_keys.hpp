#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::manifest {

/// A key that is not a parameter: it cannot be drawn or swept.
struct GeneralKey {
  std::string_view name;  ///< dotted path
  std::string_view meaning;
  bool required{false};
};

/// All general keys, in the recommended order of a manifest.
std::span<const GeneralKey> general_keys();

/// The general key with this dotted path, or null.
const GeneralKey* find_general_key(std::string_view path);

/// The section that is required.
constexpr std::string_view required_section = "command";

/// The keys of `command` that define the moves: a study has exactly one of them.
inline constexpr std::array<std::string_view, 3> command_forms{"targets", "torque", "sequence"};

/// The keys allowed in the map with this dotted path (empty: the top level): parameters, general keys and
/// maps that contain them. In the order of the table of parameters; at the top level general keys come first.
std::vector<std::string> keys_below(std::string_view path);

/// Whether the dotted path leads to a map of further keys: "controller", "controller.coarse".
bool is_section(std::string_view path);

/// Whether the dotted path is `section` or lies below it.
bool is_within(std::string_view path, std::string_view section);

/// The values of the key `keep`, in the order of the enumeration Kept.
inline constexpr std::array<std::string_view, 3> kept_labels{"trials", "failures", "statistics"};

/// The values of the key `design`, in the order of the enumeration Design.
inline constexpr std::array<std::string_view, 4> design_labels{"monte_carlo", "latin_hypercube", "sobol",
                                                               "saltelli"};

/// The values of the key `command.sequence.approach`, in the order of the enumeration SequenceApproach.
inline constexpr std::array<std::string_view, 3> approach_labels{"bidirectional", "positive", "negative"};

}  // namespace zerocount::manifest
