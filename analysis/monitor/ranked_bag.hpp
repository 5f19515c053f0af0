#pragma once

#include <cstdint>
#include <vector>

namespace zerocount::monitor {

/// A growing multiset of values, none of them NaN, in which new values are ranked. Insertion takes amortised
/// logarithmic time: the values lie in sorted runs, each at least twice as long as the next.
class RankedBag {
 public:
  explicit RankedBag(std::vector<double> values);

  struct Place {
    std::int64_t above{0};  ///< values that are larger
    std::int64_t equal{0};
  };
  Place place_of(double value) const;
  void insert(double value);
  std::int64_t size() const { return size_; }

 private:
  std::vector<std::vector<double>> runs_;
  std::int64_t size_{0};
};

}  // namespace zerocount::monitor
