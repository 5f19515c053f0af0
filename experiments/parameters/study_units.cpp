#include "experiments/parameters/study_units.hpp"

#include <array>
#include <span>

#include <boost/algorithm/string/replace.hpp>

namespace zerocount::parameters {
namespace {

struct Words {
  std::string_view text;                 // a unit, or a placeholder
  std::array<std::string_view, 2> on{};  // [AxisKind]
};

// Longest first, because each is replaced wherever it occurs.
constexpr std::array<Words, 7> unit_parts{{{"arcsec", {"arcsec", "µm"}},
                                           {"kg m^2", {"kg m^2", "kg"}},
                                           {"(N m)^n", {"(N m)^n", "N^n"}},
                                           {"(N m)^2", {"(N m)^2", "N^2"}},
                                           {"/(N m)", {"/(N m)", "/N"}},
                                           {"N m", {"N m", "N"}},
                                           {"rad", {"rad", "m"}}}};

constexpr std::array<Words, 9> placeholders{{{"$inertia", {"moment of inertia", "mass"}},
                                             {"$rotor_angle", {"rotor angle", "position"}},
                                             {"$rotor", {"rotor", "slide"}},
                                             {"$rad", {"rad", "m"}},
                                             {"$Nm", {"N m", "N"}},
                                             {"$track", {"rotor", "travel"}},
                                             {"$angle", {"angle", "position"}},
                                             {"$torque", {"torque", "force"}},
                                             {"$Torque", {"Torque", "Force"}}}};

std::string replaced(std::span<const Words> all, AxisKind axis, std::string_view text) {
  std::string result(text);
  for (const Words& words : all)
    boost::algorithm::replace_all(result, words.text, words.on[static_cast<std::size_t>(axis)]);
  return result;
}

}  // namespace

std::string unit_on(AxisKind axis, std::string_view rotary) {
  return replaced(unit_parts, axis, rotary);
}

std::string text_on(AxisKind axis, std::string_view text) {
  return replaced(placeholders, axis, text);
}

}  // namespace zerocount::parameters
