#include "experiments/parameters/study_units.hpp"

#include <array>
#include <cctype>

#include <boost/algorithm/string/replace.hpp>

namespace zerocount::parameters {
namespace {

struct Rewording {
  std::string_view rotary;
  std::string_view linear;
};

// Longest first, because the first match is used.
constexpr std::array<Rewording, 5> unit_parts{
    {{"arcsec", "µm"}, {"kg m^2", "kg"}, {"(N m)^n", "N^n"}, {"N m", "N"}, {"rad", "m"}}};

constexpr std::array<Rewording, 10> terms{{{"moment of inertia J of the rotor", "moving mass J"},
                                           {"Along the rotor", "Along the travel"},
                                           {"along the rotor", "along the travel"},
                                           {"on the rotor", "on the travel"},
                                           {"rotor angle", "position"},
                                           {"a revolution", "the travel"},
                                           {"rotor", "slide"},
                                           {"angle", "position"},
                                           {"torques", "forces"},
                                           {"torque", "force"}}};

bool is_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// Whether the text from `first` to `last` is a whole word, outside any dotted path.
bool is_word(std::string_view text, std::size_t first, std::size_t last) {
  const bool begins = first == 0 || (!is_letter(text[first - 1]) && text[first - 1] != '.');
  const bool path_goes_on = last + 1 < text.size() && text[last] == '.' && is_letter(text[last + 1]);
  return begins && (last == text.size() || (!is_letter(text[last]) && !path_goes_on));
}

void replace_term(std::string& text, const Rewording& term) {
  for (std::size_t at = text.find(term.rotary); at != std::string::npos; at = text.find(term.rotary, at)) {
    if (is_word(text, at, at + term.rotary.size())) {
      text.replace(at, term.rotary.size(), term.linear);
      at += term.linear.size();
    } else {
      at += term.rotary.size();
    }
  }
}

}  // namespace

std::string unit_on(AxisKind axis, std::string_view rotary) {
  std::string unit(rotary);
  if (axis == AxisKind::rotary) return unit;
  for (const Rewording& part : unit_parts) boost::algorithm::replace_all(unit, part.rotary, part.linear);
  return unit;
}

std::string text_on(AxisKind axis, std::string_view rotary) {
  std::string text(rotary);
  if (axis == AxisKind::rotary) return text;
  for (const Rewording& term : terms) replace_term(text, term);
  return text;
}

}  // namespace zerocount::parameters
