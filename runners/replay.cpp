#include "runners/replay.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "results/layout/layout.hpp"

namespace zerocount {
namespace {

bool same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

}  // namespace

std::vector<std::string> differences(const std::vector<MoveOutcome>& recorded,
                                     const std::vector<MoveOutcome>& replayed) {
  if (recorded.size() != replayed.size()) {
    return {fmt::format("{} moves recorded, {} replayed", recorded.size(), replayed.size())};
  }
  std::vector<std::string> lines;
  for (std::size_t move = 0; move < recorded.size(); ++move) {
    for (const RecordField<MoveOutcome>& field : outcome_fields()) {
      const auto compare = [&](auto member) {
        const auto before = static_cast<double>(recorded[move].*member);
        const auto now = static_cast<double>(replayed[move].*member);
        const bool real = std::is_same_v<decltype(member), double MoveOutcome::*>;
        if (real ? same(before, now) : before == now) return;
        lines.push_back(
            fmt::format("move {}: {}: recorded {}, replayed {}", move, field.column.name, before, now));
      };
      std::visit(compare, field.member);
    }
  }
  return lines;
}

}  // namespace zerocount
