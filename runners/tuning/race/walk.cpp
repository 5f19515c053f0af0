#include <algorithm>
#include <utility>

#include "runners/tuning/race/search_space.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::size_t walkers = 24;
constexpr std::int64_t first_places = 96;  // the best of which become walkers
constexpr int most_rounds = 60;
constexpr double walked_part = 0.6;  // of the difference of two others
constexpr double crossover = 0.9;    // probability that a coordinate moves

}  // namespace

std::size_t index_below(std::size_t size, random::NumberSource& numbers) {
  return std::min(static_cast<std::size_t>(numbers.uniform() * static_cast<double>(size)), size - 1);
}

bool Walk::goes_on() const {
  return rounds_ < most_rounds;
}

std::vector<UnitCubePoint> Walk::next(const std::function<UnitCubePoint(std::int64_t)>& first) {
  std::vector<UnitCubePoint> places;
  if (walking_.empty()) {
    for (std::int64_t i = 0; i < first_places; ++i) places.push_back(first(i));
  } else {
    for (const Walker& one : walking_) places.push_back(moved(one));
  }
  for (UnitCubePoint& place : places) {
    for (const std::size_t parameter : face_) place[parameter] = 0.0;
  }
  std::vector<Walker> found = at(std::move(places));
  std::vector<UnitCubePoint> reached;
  for (const Walker& one : found) {
    if (one.shortfall == 0.0) reached.push_back(one.place);
  }
  if (walking_.empty()) {
    std::ranges::stable_sort(found, {}, &Walker::shortfall);
    found.resize(walkers);
    walking_ = std::move(found);
  } else {
    for (std::size_t i = 0; i < walking_.size(); ++i) {
      if (found[i].shortfall <= walking_[i].shortfall) walking_[i] = std::move(found[i]);
    }
  }
  ++rounds_;
  return reached;
}

std::vector<Walk::Walker> Walk::at(std::vector<UnitCubePoint> places) const {
  const std::vector<double> shortfalls = shortfalls_(places);
  std::vector<Walker> walking;
  for (std::size_t i = 0; i < places.size(); ++i) walking.push_back({std::move(places[i]), shortfalls[i]});
  return walking;
}

UnitCubePoint Walk::moved(const Walker& walker) {
  const UnitCubePoint& base = walking_[index_below(walking_.size(), numbers_)].place;
  const UnitCubePoint& from = walking_[index_below(walking_.size(), numbers_)].place;
  const UnitCubePoint& to = walking_[index_below(walking_.size(), numbers_)].place;
  const std::size_t always = index_below(base.size(), numbers_);
  UnitCubePoint place = walker.place;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (i != always && numbers_.uniform() >= crossover) continue;
    place[i] = std::clamp(base[i] + walked_part * (to[i] - from[i]), 0.0, 1.0);
  }
  return place;
}

}  // namespace zerocount::tuning
