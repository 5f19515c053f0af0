#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount {

/// A top-level key that is no section of parameters.
struct GeneralKey {
  std::string_view name;
  std::string_view meaning;
  bool required{false};
};

/// In the order in which a manifest is best written.
std::span<const GeneralKey> general_keys();

/// The sections of the table of parameters ("plant", "friction", …) in its order; `command` is the one that
/// is required.
std::vector<std::string> section_names();
constexpr std::string_view required_section = "command";

/// The keys of one section: "inertia", …
std::vector<std::string> section_keys(std::string_view section);

/// All keys that may stand at the top.
std::vector<std::string> top_level_keys();

/// The words of the key `design`, in the order of the enumeration Design.
std::span<const std::string_view> design_words();

}  // namespace zerocount
