#include "analysis/monitor/ranked_bag.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace zerocount::monitor {

RankedBag::RankedBag(std::vector<double> values) : size_(std::ssize(values)) {
  if (!std::ranges::is_sorted(values)) std::ranges::sort(values);
  runs_.push_back(std::move(values));
}

RankedBag::Place RankedBag::place_of(double value) const {
  Place place;
  for (const std::vector<double>& run : runs_) {
    const auto [first, last] = std::equal_range(run.begin(), run.end(), value);
    place.above += run.end() - last;
    place.equal += last - first;
  }
  return place;
}

void RankedBag::insert(double value) {
  runs_.push_back({value});
  ++size_;
  // The first run, which may be long, is merged last.
  while (runs_.size() > 1 && runs_.back().size() * 2 > runs_[runs_.size() - 2].size()) {
    std::vector<double> merged;
    merged.reserve(runs_.back().size() + runs_[runs_.size() - 2].size());
    std::ranges::merge(runs_[runs_.size() - 2], runs_.back(), std::back_inserter(merged));
    runs_.pop_back();
    runs_.back() = std::move(merged);
  }
}

}  // namespace zerocount::monitor
