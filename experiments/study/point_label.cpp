#include "experiments/study/point_label.hpp"

#include <algorithm>
#include <vector>

#include "core/text/text.hpp"

namespace zerocount::study {
namespace {

/// The words of a design point's label ("controller.kp=400"), without the commas between them.
std::vector<std::string_view> split_words(std::string_view label) {
  std::vector<std::string_view> words;
  for (std::size_t at = label.find_first_not_of(' '); at != std::string_view::npos;
       at = label.find_first_not_of(' ', at)) {
    std::string_view word = label.substr(at, label.find(' ', at) - at);
    at += word.size();
    if (word.ends_with(',')) word.remove_suffix(1);
    words.push_back(word);
  }
  return words;
}

/// Whether `text` is the label, in which the paths of keys may be shortened to their ends: "ki=8e4" for
/// "controller.ki=8e4".
bool shortens(std::string_view text, std::string_view label) {
  return std::ranges::equal(split_words(text), split_words(label),
                            [](std::string_view end, std::string_view word) {
                              const bool names_value = end.find('=') != std::string_view::npos;
                              return word == end || (names_value && word.ends_with("." + std::string(end)) &&
                                                     word.size() - end.size() < word.find('='));
                            });
}

/// The index of the only design point whose label can be shortened to this text; empty if there is none or
/// several.
std::optional<std::int64_t> point_with_short_label(std::string_view text,
                                                   std::span<const std::string> labels) {
  std::optional<std::int64_t> found;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!shortens(text, labels[i])) continue;
    if (found) return std::nullopt;
    found = static_cast<std::int64_t>(i);
  }
  return found;
}

std::optional<std::int64_t> point_with_number(std::string_view text, std::span<const std::string> labels) {
  const auto number = text::parse_number<std::int64_t>(text);
  return number && *number >= 0 && *number < std::ssize(labels) ? number : std::nullopt;
}

/// The index of the design point that a text like "3 (kp=400 ki=8e4)" names by number and label; empty if
/// they do not belong to the same point.
std::optional<std::int64_t> point_with_both(std::string_view text, std::span<const std::string> labels) {
  const std::size_t bracket = text.find(" (");
  if (bracket == std::string_view::npos || !text.ends_with(')')) return std::nullopt;
  const auto number = point_with_number(text.substr(0, bracket), labels);
  const std::string_view label = text.substr(bracket + 2, text.size() - bracket - 3);
  const bool fits = number && shortens(label, labels[static_cast<std::size_t>(*number)]);
  return fits ? number : std::nullopt;
}

}  // namespace

std::optional<std::int64_t> point_named(std::string_view text, std::span<const std::string> labels) {
  if (const auto point = point_with_number(text, labels)) return point;
  const auto found = std::ranges::find(labels, text);
  if (found != labels.end()) return found - labels.begin();
  if (const auto point = point_with_short_label(text, labels)) return point;
  return point_with_both(text, labels);
}

}  // namespace zerocount::study
