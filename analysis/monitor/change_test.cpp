#include "analysis/monitor/change_test.hpp"

namespace zerocount::monitor {

ChangeTest::ChangeTest(std::vector<double> baseline, const random::RandomKey& ties)
    : bag_(std::move(baseline)),
      martingale_(bag_.size()),
      ties_(ties),
      history_(static_cast<std::uint64_t>(bag_.size())) {}

double ChangeTest::update(double value) {
  const RankedBag::Place place = bag_.place_of(value);
  const double u = random::open_uniform(random::random_bits({ties_, 0}, history_, random::Draw::trial));
  const double p = (static_cast<double>(place.above) + u * static_cast<double>(place.equal + 1)) /
                   static_cast<double>(bag_.size() + 1);
  const auto ranks =
      static_cast<std::uint64_t>(place.above) + (static_cast<std::uint64_t>(place.equal) << 32U);
  history_ = random::random_bits({ties_, 1}, history_ ^ ranks, random::Draw::trial);
  bag_.insert(value);
  martingale_.update(p);
  return p;
}

}  // namespace zerocount::monitor
