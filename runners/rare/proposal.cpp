#include "runners/rare/proposal.hpp"

#include <algorithm>
#include <utility>

namespace zerocount::rare {
namespace {

/// Density over that of the trials' own distribution, of the pinned values.
double density_of_pinned(const TrialSpace& space, const Proposal& proposal, std::span<const double> z) {
  double density = 0.0;
  for (const PinnedValue& one : proposal.values) {
    if (randomness::value_at(space.discrete[one.draw], z) == one.value)
      density += one.weight / one.probability;
  }
  return density;
}

/// The element in whose part of the cumulative weights `place` lies.
template <class Weighted>
const Weighted& chosen_by(const std::vector<Weighted>& all, double place) {
  std::size_t chosen = 0;
  for (; chosen + 1 < all.size(); ++chosen) {
    place -= all[chosen].weight;
    if (place < 0.0) break;
  }
  return all[chosen];
}

}  // namespace

TrialSpace trial_space(std::size_t coordinates, std::vector<randomness::DiscreteDraw> discrete) {
  TrialSpace space{coordinates, std::move(discrete)};
  for (const randomness::DiscreteDraw& draw : space.discrete) {
    if (!draw.ordered && draw.direction.size() == 1) space.unordered.push_back(draw.direction.front().first);
  }
  std::ranges::sort(space.unordered);
  return space;
}

std::vector<PinnedValue> pinned_values(const TrialSpace& space, std::size_t draw) {
  const randomness::DiscreteDraw& drawn = space.discrete[draw];
  std::vector<PinnedValue> values;
  for (std::int64_t value = 0; value < drawn.values(); ++value) values.push_back({draw, value});
  for (std::int64_t row = 0; row < drawn.rows; ++row)
    values[static_cast<std::size_t>(randomness::value_of_row(drawn, row))].rows.push_back(row);
  for (PinnedValue& one : values)
    one.probability = static_cast<double>(one.rows.size()) / static_cast<double>(drawn.rows);
  return values;
}

std::vector<double> proposal_coordinates(const TrialSpace& space, std::span<const double> z) {
  std::vector<double> part;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!std::ranges::binary_search(space.unordered, i)) part.push_back(z[i]);
  }
  return part;
}

bool is_pinned(const TrialSpace& space, const Proposal& proposal, std::span<const double> z) {
  return density_of_pinned(space, proposal, z) > 0.0;
}

double likelihood_ratio(const TrialSpace& space, const Proposal& proposal, std::span<const double> z) {
  double learned = proposal.pinned * density_of_pinned(space, proposal, z);
  if (!proposal.components.empty())
    learned += (1.0 - proposal.pinned) * density_ratio(proposal.components, proposal_coordinates(space, z));
  return 1.0 / (proposal.natural + (1.0 - proposal.natural) * learned);
}

double max_ratio_of_pinned(const Proposal& proposal) {
  double ratio = 0.0;
  for (const PinnedValue& one : proposal.values)
    ratio = std::max(ratio, 1.0 / (proposal.natural + (1.0 - proposal.natural) * proposal.pinned *
                                                          one.weight / one.probability));
  return ratio;
}

DrawnPoint draw(const TrialSpace& space, const Proposal& proposal, NumberSource& numbers) {
  const double choice = numbers.uniform();
  if (choice < proposal.natural || proposal.is_natural()) return {numbers.normals(space.coordinates), true};
  const double place = (choice - proposal.natural) / (1.0 - proposal.natural);
  if (place < proposal.pinned || proposal.components.empty())
    return {draw_pinned(space, chosen_by(proposal.values, place / proposal.pinned), numbers)};
  const NormalComponent& component =
      chosen_by(proposal.components, (place - proposal.pinned) / (1.0 - proposal.pinned));
  const std::vector<double> changed = draw(component, numbers);
  std::vector<double> z;
  std::size_t next = 0;
  for (std::size_t i = 0; i < space.coordinates; ++i)
    z.push_back(std::ranges::binary_search(space.unordered, i) ? numbers.normal() : changed[next++]);
  return {std::move(z)};
}

std::vector<double> draw_pinned(const TrialSpace& space, const PinnedValue& pinned, NumberSource& numbers) {
  std::vector<double> z = numbers.normals(space.coordinates);
  const auto row = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(pinned.rows.size()));
  randomness::move_to_row(space.discrete[pinned.draw], pinned.rows[std::min(row, pinned.rows.size() - 1)],
                          numbers.uniform(), z);
  return z;
}

}  // namespace zerocount::rare
