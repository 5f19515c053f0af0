#include "experiments/yaml/problems.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/text/text.hpp"

namespace zerocount::yaml {

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

constexpr std::size_t longest = 80;

}  // namespace

bool is_near(std::string_view name, std::string_view candidate) {
  return name.size() <= longest &&
         3 * edit_distance(name, candidate) <= std::max(name.size(), candidate.size());
}

std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates) {
  if (name.size() > longest || candidates.empty()) return {};
  const auto nearest = std::min_element(
      candidates.begin(), candidates.end(),
      [&](const auto& a, const auto& b) { return edit_distance(name, a) < edit_distance(name, b); });
  return *nearest;
}

std::string place_text(const Place& place) {
  if (place.line == 0) return std::string(place.source);
  return fmt::format("{}:{}:{}", place.source, place.line, place.column);
}

std::string at_place(const Place& place, std::string_view path, std::string_view text) {
  return fmt::format("{}: {}: {}", place_text(place), path, text);
}

void Problems::add(const Place& place, std::string_view path, std::string_view what,
                   std::string_view expected) {
  entries_.push_back({place, at_place(place, path, fmt::format("{}; expected {}", what, expected))});
}

void Problems::add_missing(const Place& place, std::string_view path, std::string_view expected) {
  add_missing(place, path, "the key is missing", expected);
}

void Problems::add_missing(const Place& place, std::string_view path, std::string_view what,
                           std::string_view expected) {
  add(place, path, what, expected);
  entries_.back().is_missing = true;
}

void Problems::raise_if_any() const {
  if (empty()) return;
  std::vector<Entry> sorted = entries_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    // Overrides (line 0) after the file, and missing keys last.
    const auto key = [](const Entry& e) {
      return std::tuple(e.is_missing, e.place.line == 0, e.place.line, e.place.column);
    };
    return key(a) < key(b);
  });
  std::string message;
  std::string_view last;
  for (const Entry& entry : sorted) {
    if (entry.text == last) continue;  // an alias can report the same place twice
    if (!message.empty()) message += '\n';
    message += entry.text;
    last = entry.text;
  }
  throw Failure(ExitCode::bad_input, text::printable_lines(message));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string shown = "'";
  for (const char c : text.substr(0, longest)) {
    shown += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  // Removes an incomplete UTF-8 sequence at the cut.
  if (text.size() > longest) {
    while (!shown.empty() && (static_cast<unsigned char>(shown.back()) & 0xC0) == 0x80) shown.pop_back();
    if (static_cast<unsigned char>(shown.back()) >= 0xC0) shown.pop_back();
    shown += "…";
  }
  return shown + "'";
}

}  // namespace zerocount::yaml
