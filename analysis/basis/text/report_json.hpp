#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace zerocount::text {

inline constexpr int one_line = -1;  ///< Indent of json_text() for JSON on one line.

/// A JSON object as text, ending with a line break. Bytes that are not UTF-8 are replaced.
inline std::string json_text(const nlohmann::ordered_json& json, int indent = 2) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace zerocount::text
