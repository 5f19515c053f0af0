#include "analysis/monitor/change_test.hpp"

namespace zerocount::monitor {

ChangeTest::ChangeTest(std::vector<double> baseline, const random::RandomStream& ties)
    : bag_(std::move(baseline)), martingale_(bag_.size()), ties_(ties) {}

double ChangeTest::update(double value) {
  const auto number = static_cast<std::uint64_t>(martingale_.values()) + 1;
  const double u = random::open_uniform(random::random_bits(ties_, number, random::Draw::trial));
  const RankedBag::Place place = bag_.place_of(value);
  const double p = (static_cast<double>(place.above) + u * static_cast<double>(place.equal + 1)) /
                   static_cast<double>(bag_.size() + 1);
  bag_.insert(value);
  martingale_.update(p);
  return p;
}

}  // namespace zerocount::monitor
