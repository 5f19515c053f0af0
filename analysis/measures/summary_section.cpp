#include "analysis/measures/summary_section.hpp"

namespace zerocount::measures {

std::string text_of(const SummarySection& section, std::span<const std::int64_t> points) {
  std::string tables;
  for (const text::PointTable& table : section.tables) {
    const std::string text = text::aligned_table(table, points);
    if (!text.empty()) tables += (tables.empty() ? "" : "\n") + text;
  }
  if (tables.empty()) return {};
  return (section.title.empty() ? "" : section.title + "\n\n") + tables +
         (section.note.empty() ? "" : "\n" + section.note);
}

}  // namespace zerocount::measures
