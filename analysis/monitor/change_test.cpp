#include "analysis/monitor/change_test.hpp"

namespace zerocount::monitor {
namespace {

std::vector<RankedBag> bags_of(std::vector<std::vector<double>> baseline) {
  std::vector<RankedBag> bags;
  for (std::vector<double>& values : baseline) bags.emplace_back(std::move(values));
  return bags;
}

std::int64_t size_of(const std::vector<RankedBag>& bags) {
  std::int64_t size = 0;
  for (const RankedBag& bag : bags) size += bag.size();
  return size;
}

}  // namespace

ChangeTest::ChangeTest(std::vector<double> baseline, const random::RandomKey& ties)
    : ChangeTest(std::vector<std::vector<double>>{std::move(baseline)}, ties) {}

ChangeTest::ChangeTest(std::vector<std::vector<double>> baseline, const random::RandomKey& ties)
    : bags_(bags_of(std::move(baseline))),
      martingale_(size_of(bags_)),
      ties_(ties),
      history_(static_cast<std::uint64_t>(size_of(bags_))) {}

double ChangeTest::update(double value, std::size_t of_class) {
  RankedBag& bag = bags_[of_class];
  const RankedBag::Place place = bag.place_of(value);
  const double u = random::open_uniform(random::random_bits({ties_, 0}, history_, random::Draw::trial));
  const double p = (static_cast<double>(place.above) + u * static_cast<double>(place.equal + 1)) /
                   static_cast<double>(bag.size() + 1);
  const auto ranks =
      static_cast<std::uint64_t>(place.above) + (static_cast<std::uint64_t>(place.equal) << 32U);
  history_ = random::random_bits({ties_, 1}, history_ ^ ranks, random::Draw::trial);
  bag.insert(value);
  martingale_.update(p);
  return p;
}

}  // namespace zerocount::monitor
