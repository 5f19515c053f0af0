#include "runners/trials/turns.hpp"

#include <algorithm>

namespace zerocount::trials {

Turns::Turns(std::span<const layout::RowRange> ranges, std::int64_t trials) {
  std::int64_t last_point = -1;
  for (const layout::RowRange& range : ranges) {
    for (layout::RowRange rows{range.first, 0}; rows.first < range.end(); rows.first = rows.end()) {
      const std::int64_t point = rows.first / trials;
      rows.count = std::min((point + 1) * trials, range.end()) - rows.first;
      if (point != last_point) points_.push_back({trials, {}});
      points_.back().trials_run -= rows.count;
      points_.back().remaining.push_back(rows);
      last_point = point;
    }
  }
  for (std::size_t point = 0; point < points_.size(); ++point) {
    std::reverse(points_[point].remaining.begin(), points_[point].remaining.end());
    waiting_.emplace(points_[point].trials_run, point);
  }
  choose_point();
}

layout::RowRange Turns::upcoming(std::int64_t max_rows) const {
  layout::RowRange rows = points_[*current_].remaining.back();
  rows.count = std::min(rows.count, max_rows);
  bool ends_point = points_[*current_].remaining.size() == 1 && rows == points_[*current_].remaining.back();
  for (auto next = waiting_.begin(); ends_point && next != waiting_.end(); ++next) {
    const std::vector<layout::RowRange>& remaining = points_[next->second].remaining;
    ends_point = remaining.size() == 1 && remaining.back().first == rows.end() &&
                 rows.count + remaining.back().count <= max_rows;
    if (ends_point) rows.count += remaining.back().count;
  }
  return rows;
}

void Turns::take(std::int64_t count) {
  at_new_point_ = false;
  while (count > 0) {
    PointRows& point = points_[*current_];
    layout::RowRange& rows = point.remaining.back();
    const std::int64_t taken = std::min(count, rows.count);
    rows = {rows.first + taken, rows.count - taken};
    point.trials_run += taken;
    count -= taken;
    if (rows.count > 0) continue;
    point.remaining.pop_back();
    at_new_point_ = point.remaining.empty();
    if (at_new_point_) choose_point();
  }
}

void Turns::end_turn() {
  if (!current_) return;
  waiting_.emplace(points_[*current_].trials_run, *current_);
  choose_point();
}

void Turns::choose_point() {
  current_.reset();
  if (waiting_.empty()) return;
  current_ = waiting_.begin()->second;
  waiting_.erase(waiting_.begin());
}

}  // namespace zerocount::trials
