#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/numerics/interval.hpp"

namespace zerocount::keys {

struct Reading;  // see values.hpp

/// A key that is not a parameter: it cannot be drawn or swept. One row says all there is to know of a regular
/// key; the parser (key_reading.hpp), the JSON Schema and `zerocount parameters` are derived from the rows.
struct GeneralKey {
  enum class Form : std::uint8_t {
    own,  ///< has its own reader, and its own schema in json_schema.cpp
    text,
    boolean,
    label,
    whole_number,
    real,
    map  ///< of `keys`
  };

  std::string_view name;       ///< dotted path; last part of it for a key of a map
  std::string_view meaning{};  ///< empty for a key of a map, which that of the map explains
  std::string_view
      if_missing{};  ///< what a manifest without a required key lacks; empty: the key is optional
  Form form{Form::own};
  numerics::Interval range{};                  ///< of a number; of a whole number closed
  std::span<const std::string_view> labels{};  ///< of a label, in the order of its enumeration
  std::string_view none{};                     ///< word in place of the number or of all numbers of the map
  /// Words in place of a map, and what each stores.
  std::vector<std::pair<std::string_view, void (*)(Reading&)>> presets{};
  std::string_view example{};      ///< of a map, for messages
  std::vector<GeneralKey> keys{};  ///< of a map
  /// Stores the value in the study: a number, the index of a label, 0 or 1, or nothing for the word `none`.
  /// Empty if code does that.
  std::function<void(Reading&, std::optional<double>)> set{};
  std::function<std::optional<double>(Reading&)> get{};  ///< the value that `set` stores
  std::function<std::string&(Reading&)> text{};          ///< where a text is stored

  bool required() const { return !if_missing.empty(); }
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

/// Newest manifest version that this program supports: the value of the key `zerocount`.
constexpr std::int64_t manifest_version = 1;

/// Maximum number of trials of a study.
constexpr std::int64_t max_study_trials = std::int64_t{1} << 53;

/// Maximum error band, counts: that of a target.
constexpr std::int64_t max_band = 1'000'000'000'000;

/// The values of the key `keep`, in the order of the enumeration Retention.
inline constexpr std::array<std::string_view, 3> retention_labels{"trials", "failures", "statistics"};

/// The values of the key `design`, in the order of the enumeration Design.
inline constexpr std::array<std::string_view, 4> design_labels{"monte_carlo", "latin_hypercube", "sobol",
                                                               "saltelli"};

/// The values of the key `command.sequence.approach`, in the order of the enumeration SequenceApproach.
inline constexpr std::array<std::string_view, 3> approach_labels{"bidirectional", "positive", "negative"};

}  // namespace zerocount::keys
