#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount {

/// A key that is no parameter: it cannot be drawn or swept.
struct GeneralKey {
  std::string_view name;  ///< dotted path
  std::string_view meaning;
  bool required{false};
};

/// In the order in which a manifest is best written.
std::span<const GeneralKey> general_keys();

/// The general key with this dotted path, or null.
const GeneralKey* find_general_key(std::string_view path);

/// The section that is required.
constexpr std::string_view required_section = "command";

/// The keys of `command` of which a study has exactly one: three ways to say what the moves go to.
std::span<const std::string_view> command_forms();

/// The keys that may stand in the map with this dotted path, at the top where it is empty: names of
/// parameters, of general keys, and of the maps that these are in. General keys first at the top, and
/// otherwise in the order of the table of parameters.
std::vector<std::string> keys_below(std::string_view path);

/// Whether the dotted path leads to a map of further keys: "controller", "controller.coarse".
bool is_section(std::string_view path);

/// Whether the dotted path is `section`, or of something in it.
bool is_within(std::string_view path, std::string_view section);

/// The words of the key `design`, in the order of the enumeration Design.
std::span<const std::string_view> design_labels();

/// The words of the key `command.sequence.approach`, in the order of the enumeration SequenceApproach.
std::span<const std::string_view> approach_labels();

}  // namespace zerocount
