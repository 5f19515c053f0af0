#pragma once

#include <functional>

#include <nlohmann/json_fwd.hpp>

#include "core/numerics/interval.hpp"
#include "experiments/shapes/shape.hpp"

/// The JSON Schema of a shape, and the parts from which it is built.
namespace zerocount::shapes {

using Json = nlohmann::ordered_json;

/// JSON Schema of a map that may have these keys only. All keys are optional.
Json object_of(Json properties);
Json object_of(Json properties, Json required);

/// Schema of a list of at least `min_items` items.
Json list_of(Json item, std::size_t min_items);

/// JSON Schema of a number in an interval.
/// @param whole only whole numbers are allowed
Json number_in(const numerics::Interval& range, bool whole = false);

/// JSON Schema of a key with this shape, with the description of the key and its default.
/// @param own returns the schema of a shape in a form of its own
Json schema_of(const Shape& shape, const std::function<Json(const Shape&)>& own);

}  // namespace zerocount::shapes
