#pragma once

#include <functional>

#include <nlohmann/json_fwd.hpp>

#include "core/numerics/interval.hpp"
#include "experiments/shapes/shape.hpp"

/// The JSON Schema of a shape, and the parts of which it is made.
namespace zerocount::shapes {

using Json = nlohmann::ordered_json;

/// A map of these keys only; those of `required`, without it none, must be there.
Json object_of(Json properties);
Json object_of(Json properties, Json required);

/// A list of at least `min_items`.
Json list_of(Json item, std::size_t min_items);

/// A number in an interval.
Json number_in(const numerics::Interval& range, bool whole = false);

/// The schema of a key with this shape, its meaning and what holds without it included.
/// @param own schema of a shape in a form of its own
Json schema_of(const Shape& shape, const std::function<Json(const Shape&)>& own);

}  // namespace zerocount::shapes
