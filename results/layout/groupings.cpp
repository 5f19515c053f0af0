#include "results/layout/groupings.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace zerocount::layout {

std::span<const Grouping> groupings() {
  using enum study::Grouping;
  using study::traits_of;
  static constexpr std::array<Grouping, 4> all{
      {{traits_of(machine), "index of the machine", "of the machine", true},
       {traits_of(world), "index of the world", "in the world"},
       {traits_of(condition), "index of the condition", "under the condition", false, true},
       {traits_of(age), "age of the machines", "at the age", false, false, true}}};
  return all;
}

const Grouping& grouping_named(std::string_view name) {
  return *std::ranges::find(groupings(), name, &Grouping::name);
}

Column group_scale(const Grouping& grouping, const std::string& unit) {
  return {std::string(grouping.name), unit, std::string(grouping.meaning),
          grouping.has_values ? hdf5::Element::float64 : hdf5::Element::int64};
}

Table group_table(const Grouping& grouping, const std::vector<study::InputColumn>& inputs,
                  const std::string& unit) {
  Table table{std::string(grouping.name), group_scale(grouping, unit), {}, input_columns(inputs)};
  if (grouping.has_labels)
    table.columns.push_back({"name", "1", fmt::format("name of the {}", grouping.name), hdf5::Element::text});
  return table;
}

Table group_count_table(const Grouping& grouping, bool has_goal, std::span<const PointColumn> statistics,
                        const std::string& unit) {
  Table table{std::string(grouping.name), point_scale(), group_scale(grouping, unit), {}};
  const auto add_count = [&](const char* name, std::string_view which) {
    table.columns.push_back({name, "1", fmt::format("trials {} at the point {}", grouping.trials_of, which),
                             hdf5::Element::int64});
  };
  add_count("success", "that succeeded, in all their moves");
  add_count("trials", "that were judged, 0 in an open loop");
  if (has_goal) add_count("goal_met", "all of whose moves meet the goal");
  for (const PointColumn& statistic : statistics)
    table.columns.push_back({statistic.name, statistic.unit, statistic.long_name, hdf5::Element::float64});
  return table;
}

}  // namespace zerocount::layout
