#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runners/command_line/command_line.hpp"

/// Options with numbers or design points as values.
namespace zerocount::command_line {

/// A number strictly between 0 and 1, such as 0.95.
/// @throws Failure (bad_input) for anything else.
std::optional<double> probability_option(const Arguments& arguments, std::string_view option);

/// The number in the text of an option, finite and at least `least`, which may be −∞.
/// @throws Failure (bad_input) for anything else.
double number_from(const Arguments& arguments, std::string_view option, std::string_view text, double least);

/// The number of an option, as number_from() reads it; nothing if the option is missing.
std::optional<double> number_option(const Arguments& arguments, std::string_view option, double least);

/// The budget of a search: trials, or seconds; neither if the option is missing.
struct Budget {
  std::optional<std::int64_t> trials;
  std::optional<double> seconds;  ///< s
};

/// --budget: a number of trials, or a time such as 60s or 5min.
/// @throws Failure (bad_input) for anything else.
Budget budget_option(const Arguments& arguments);

/// The design points of --point, as study::point_named() reads them; empty if the option is missing.
/// @param labels of all points, in their order
/// @throws Failure (bad_input) for anything else.
std::vector<std::int64_t> point_options(const Arguments& arguments, std::span<const std::string> labels);

/// The two design points of `option`, given likewise.
std::optional<std::pair<std::int64_t, std::int64_t>> point_pair_option(const Arguments& arguments,
                                                                       std::string_view option,
                                                                       std::span<const std::string> labels);

/// As point_options, for an option that cannot be repeated.
std::optional<std::int64_t> point_option(const Arguments& arguments, std::span<const std::string> labels);

}  // namespace zerocount::command_line
