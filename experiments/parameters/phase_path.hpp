#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace zerocount::parameters {

/// The phases of the control, whose parameters have the same names in two sections of a manifest.
enum class Phase : std::uint8_t {
  fine,   ///< fine phase: section `controller`; the only phase if no design point has a coarse phase
  coarse  ///< coarse phase: section `controller.coarse`
};

/// A string literal as a type that can be a template argument.
template <std::size_t size>
struct Literal {
  char text[size]{};
  constexpr Literal(const char (&literal)[size]) {
    for (std::size_t i = 0; i < size; ++i) text[i] = literal[i];
  }
};

/// The concatenation of two texts, with a zero at its end.
template <Literal first, Literal last>
constexpr auto join_texts() {
  std::array<char, sizeof(first.text) + sizeof(last.text) - 1> text{};
  std::size_t end = 0;
  for (std::size_t i = 0; first.text[i] != '\0'; ++i) text[end++] = first.text[i];
  for (std::size_t i = 0; last.text[i] != '\0'; ++i) text[end++] = last.text[i];
  return text;
}

/// Storage of a concatenation. A static member has one address in the whole program.
template <Literal first, Literal last>
struct JoinedText {
  static constexpr auto text = join_texts<first, last>();
};

/// Concatenation of two texts: joined<"encoder", ".fine"> is "encoder.fine".
template <Literal first, Literal last>
inline constexpr std::string_view joined{JoinedText<first, last>::text.data()};

/// The dotted path of a parameter of a phase: phase_path<Phase::coarse, "kp"> is "controller.coarse.kp".
template <Phase phase, Literal name>
inline constexpr std::string_view phase_path =
    phase == Phase::fine ? joined<"controller.", name> : joined<"controller.coarse.", name>;

}  // namespace zerocount::parameters
