#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/friction/profile.hpp"
#include "experiments/designs/random.hpp"
#include "experiments/designs/sobol.hpp"
#include "experiments/distributions/distribution.hpp"

namespace zerocount {

// The compiled form of a manifest. A slot is a place for one value of a trial: slot s below the number of
// rows is row s of the table of parameters (that of a per_move row is unused), and slot rows + i is the
// target of move i.

/// What a manifest says of one slot.
struct Value {
  enum class Kind : std::uint8_t { number, distribution, profile };
  Kind kind{Kind::number};
  std::uint32_t index{0};  ///< into the plan's distributions or profiles
  double number{0.0};      ///< where kind is number
};

/// A value that one option of an axis gives to a slot.
struct Assignment {
  std::uint32_t slot{0};
  Value value;
};

/// One factor of the product of design points. Flat, because an axis may have a million options: the
/// assignments of option o are assignments[first[o]] … assignments[first[o + 1] − 1].
struct PlanAxis {
  std::vector<std::uint32_t> first{0};
  std::vector<Assignment> assignments;
};

inline std::size_t option_count(const PlanAxis& axis) {
  return axis.first.size() - 1;
}

/// The random numbers of one slot.
struct SlotRandomness {
  RandomKey key{};
  SobolDirections directions{};  ///< used by the design `sobol`
};

struct StudyPlan {
  std::size_t moves{1};
  std::vector<Value> base;     ///< [slot], where no axis says otherwise
  std::vector<PlanAxis> axes;  ///< the last changes fastest from point to point, and wins over the others
  std::vector<Distribution> distributions;
  std::vector<std::shared_ptr<const Profile>> profiles;
  std::vector<SlotRandomness> randomness;  ///< [slot]
  std::vector<std::uint32_t> input_slots;  ///< [input column]
};

/// Which option of `axis` the design point takes.
std::size_t option_at(const StudyPlan& plan, std::size_t axis, std::size_t point);

/// The value of one slot at a design point.
const Value* value_at_point(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// The values of all slots at a design point.
std::vector<const Value*> values_at(const StudyPlan& plan, std::size_t point);

}  // namespace zerocount
