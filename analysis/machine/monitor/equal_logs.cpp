#include "analysis/machine/monitor/equal_logs.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace zerocount::monitor {
namespace {

/// Smallest number of different rows at which equal logs are taken as copies. Ten different rows have 10!
/// orders, so two logs with them are unlikely to agree by chance.
constexpr std::size_t enough_rows = 10;

/// A measure that two logs have in common: its values in each log, with their signs as written there.
struct SharedColumn {
  std::span<const double> one;
  std::span<const double> other;
};

std::span<const double> numbers_of(const Moves::Column& column) {
  return column.written.empty() ? column.values : column.written;
}

std::vector<SharedColumn> shared_columns(const Moves& one, const Moves& other) {
  std::vector<SharedColumn> shared;
  for (const Moves::Column& column : one.columns)
    if (const Moves::Column* const same = other.find(column.measure.name))
      shared.push_back({numbers_of(column), numbers_of(*same)});
  return shared;
}

bool are_equal(double a, double b) {
  constexpr double rounding = 1e-9;  // of the conversion of units
  if (a == b || (std::isnan(a) && std::isnan(b))) return true;
  return std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b)) && std::isfinite(a) &&
         std::isfinite(b);
}

bool begin_equal(std::span<const SharedColumn> columns, std::size_t moves) {
  for (std::size_t move = 0; move < moves; ++move)
    for (const SharedColumn& column : columns)
      if (!are_equal(column.one[move], column.other[move])) return false;
  return true;
}

/// Whether the first `moves` moves have at least enough_rows different rows, in the columns that both logs
/// share.
bool have_many_rows(std::span<const SharedColumn> columns, std::size_t moves) {
  std::set<std::vector<double>> rows;
  for (std::size_t move = 0; move < moves && rows.size() < enough_rows; ++move) {
    std::vector<double> row;
    for (const SharedColumn& column : columns)
      row.push_back(std::isnan(column.one[move]) ? -1.0 : column.one[move]);
    rows.insert(std::move(row));
  }
  return rows.size() >= enough_rows;
}

}  // namespace

std::int64_t equal_moves(const Moves& one, const Moves& other) {
  const std::vector<SharedColumn> shared = shared_columns(one, other);
  const std::int64_t moves = std::min(one.moves, other.moves);
  const auto count = static_cast<std::size_t>(moves);
  if (shared.empty() || !begin_equal(shared, count)) return 0;
  return one.moves == other.moves || have_many_rows(shared, count) ? moves : 0;
}

std::optional<EqualLogs> equal_logs(std::span<const MoveLog> logs) {
  for (std::size_t first = 0; first < logs.size(); ++first) {
    EqualLogs equal{{first}, logs[first].moves, true, true};
    for (std::size_t i = first + 1; i < logs.size(); ++i) {
      const std::int64_t moves = equal_moves(logs[first], logs[i]);
      if (moves == 0) continue;
      equal.logs.push_back(i);
      equal.whole = equal.whole && logs[i].moves == logs[first].moves;
      equal.moves = std::min(equal.moves, moves);
    }
    if (equal.logs.size() == 1) continue;
    equal.few_values = !have_many_rows(shared_columns(logs[first], logs[equal.logs[1]]),
                                       static_cast<std::size_t>(equal.moves));
    return equal;
  }
  return std::nullopt;
}

}  // namespace zerocount::monitor
