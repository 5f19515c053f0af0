#include "core/plant/plant.hpp"

#include <array>
#include <utility>

namespace zerocount {
namespace {

using AnyPlant = FrictionLaws::Variant<PlantWith>;

template <std::size_t law>
AnyPlant plant_with(const PlantParameters& plant, const FrictionAlongRotor& friction, const PlantStart& start,
                    const MotionTolerance& tolerance) {
  return AnyPlant(std::in_place_index<law>, plant, friction, start, tolerance);
}

constexpr auto makers = []<std::size_t... law>(std::index_sequence<law...>) {
  return std::array{&plant_with<law>...};
}
(std::make_index_sequence<std::variant_size_v<AnyPlant>>{});

}  // namespace

Plant::Plant(const PlantParameters& plant, const FrictionAlongRotor& friction, const PlantStart& start,
             const MotionTolerance& tolerance)
    : plant_(makers.at(static_cast<std::size_t>(friction.model))(plant, friction, start, tolerance)),
      has_hook_(has_breakaway(friction.model)) {}

}  // namespace zerocount
