#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace zerocount::parameters {

/// The phases of the control, whose parameters have the same names in two sections of a manifest.
enum class Phase : std::uint8_t {
  fine,   ///< the only one where no point has a coarse phase: `controller`
  coarse  ///< `controller.coarse`
};

/// A text as an argument of a template.
template <std::size_t size>
struct Literal {
  char text[size]{};
  constexpr Literal(const char (&literal)[size]) {
    for (std::size_t i = 0; i < size; ++i) text[i] = literal[i];
  }
};

template <Phase phase, Literal name>
constexpr auto phase_path_text = [] {
  constexpr std::string_view section = phase == Phase::fine ? "controller." : "controller.coarse.";
  constexpr std::string_view last(name.text);
  std::array<char, section.size() + last.size()> text{};
  for (std::size_t i = 0; i < text.size(); ++i)
    text[i] = i < section.size() ? section[i] : last[i - section.size()];
  return text;
}();

/// The dotted path of a parameter of a phase: phase_path<Phase::coarse, "kp"> is "controller.coarse.kp".
template <Phase phase, Literal name>
constexpr std::string_view phase_path{phase_path_text<phase, name>.data(),
                                      phase_path_text<phase, name>.size()};

}  // namespace zerocount::parameters
