#include "core/text/unit.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace zerocount::text {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

constexpr std::array units{
    Unit{"s", Dimension::time, 1.0},
    Unit{"ms", Dimension::time, 1e-3},
    Unit{"us", Dimension::time, 1e-6},
    Unit{"ns", Dimension::time, 1e-9},
    Unit{"min", Dimension::time, 60.0},
    Unit{"N m", Dimension::torque, 1.0},
    Unit{"mN m", Dimension::torque, 1e-3},
    Unit{"uN m", Dimension::torque, 1e-6},
    Unit{"N cm", Dimension::torque, 1e-2},
    Unit{"N mm", Dimension::torque, 1e-3},
    Unit{"rad", Dimension::angle, 1.0},
    Unit{"mrad", Dimension::angle, 1e-3},
    Unit{"urad", Dimension::angle, 1e-6},
    Unit{"nrad", Dimension::angle, 1e-9},
    Unit{"deg", Dimension::angle, degree},
    Unit{"mdeg", Dimension::angle, 1e-3 * degree},
    Unit{"arcmin", Dimension::angle, degree / 60.0},
    Unit{"arcsec", Dimension::angle, degree / 3600.0},
    Unit{"rev", Dimension::angle, 2.0 * std::numbers::pi},
    Unit{"N", Dimension::force, 1.0},
    Unit{"mN", Dimension::force, 1e-3},
    Unit{"kN", Dimension::force, 1e3},
    Unit{"m", Dimension::length, 1.0},
    Unit{"mm", Dimension::length, 1e-3},
    Unit{"um", Dimension::length, 1e-6},
    Unit{"nm", Dimension::length, 1e-9},
    Unit{"A", Dimension::current, 1.0},
    Unit{"mA", Dimension::current, 1e-3},
    Unit{"V", Dimension::voltage, 1.0},
    Unit{"mV", Dimension::voltage, 1e-3},
    Unit{"count", Dimension::count, 1.0},
    Unit{"%", Dimension::proportion, 1e-2},
};

/// Other spellings of unit names, without blanks, with the name that each stands for.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> spellings{
    {{"°", "deg"}, {"\"", "arcsec"}, {"'", "arcmin"}, {"1", "count"}, {"sec", "s"}}};

/// Words for an encoder or converter count as a unit, as drives, oscilloscopes and encoders name it; in any
/// case, and with an s or a point at the end.
constexpr std::array<std::string_view, 18> words_of_count{
    "count", "cnt", "ct",    "inc",     "incr",  "increment", "ink",       "inkr",     "inkrement",
    "tick",  "lsb", "pulse", "impulse", "digit", "qc",        "quadcount", "enccount", "encodercount"};

bool is_count(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto known = [&] { return std::ranges::find(words_of_count, text) != words_of_count.end(); };
  if (known()) return true;
  if (!text.ends_with('s')) return false;
  text.pop_back();
  return known();
}

/// The text with each occurrence of `from` replaced by `to`.
std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  for (std::size_t at = text.find(from); at != std::string_view::npos; at = text.find(from)) {
    result.append(text.substr(0, at)).append(to);
    text.remove_prefix(at + from.size());
  }
  return result.append(text);
}

/// The unit name in the form in which names are compared: without blanks and multiplication signs, and with u
/// for both signs of micro.
std::string compared(std::string_view name) {
  std::string text(name);
  for (const std::string_view gone : {" ", "·", "⋅", "*", "."}) text = replaced(text, gone, "");
  for (const std::string_view micro : {"µ", "μ"}) text = replaced(text, micro, "u");
  for (const auto& [other, usual] : spellings) {
    if (text == other) return std::string(usual);
  }
  if (is_count(text)) return "count";
  return text;
}

}  // namespace

std::optional<Unit> unit_named(std::string_view name) {
  const std::string text = compared(name);
  const auto found =
      std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return compared(unit.name) == text; });
  return found == units.end() ? std::nullopt : std::optional(*found);
}

std::string unit_names() {
  std::string text;
  for (const Unit& unit : units) text += (text.empty() ? "" : ", ") + std::string(unit.name);
  return text;
}

}  // namespace zerocount::text
