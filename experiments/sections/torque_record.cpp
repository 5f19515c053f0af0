#include "experiments/sections/torque_record.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace zerocount::sections {
namespace {

constexpr const char* list_form =
    "the name of a table, or a list of at least two pairs [time in s, torque], by ascending time from 0 on";

std::optional<std::pair<double, double>> read_pair(const yaml::Field& pair, yaml::Problems& problems) {
  constexpr const char* expected = "a pair [time in s, torque]";
  if (!yaml::check_list(pair, expected, problems)) return std::nullopt;
  if (pair.node->items.size() != 2) {
    problems.add(pair, fmt::format("found a list of {}", pair.node->items.size()), expected);
    return std::nullopt;
  }
  const auto time = yaml::read_real(yaml::item_of(pair, 0), numerics::at_least(0), problems);
  const auto torque = yaml::read_real(yaml::item_of(pair, 1), numerics::all_numbers(), problems);
  if (!time || !torque) return std::nullopt;
  return std::pair{*time, *torque};
}

}  // namespace

std::shared_ptr<const trial::TorqueRecord> read_torque_record(const yaml::Field& list,
                                                              yaml::Problems& problems) {
  if (!yaml::check_list(list, list_form, problems)) return nullptr;
  const std::size_t count = list.node->items.size();
  if (count < 2 || count > max_record_rows) {
    problems.add(list, fmt::format("found a list of {}", count), list_form);
    return nullptr;
  }
  trial::TorqueRecord record;
  for (std::size_t i = 0; i < count; ++i) {
    const yaml::Field pair = yaml::item_of(list, i);
    const auto row = read_pair(pair, problems);
    if (!row) return nullptr;
    if (i == 0 ? row->first != 0.0 : !(row->first > record.time.back())) {
      problems.add(pair, fmt::format("found the time {} s", row->first),
                   i == 0 ? "0" : fmt::format("a time above the one before it, {} s", record.time.back()));
      return nullptr;
    }
    record.time.push_back(row->first);
    record.torque.push_back(row->second);
  }
  return std::make_shared<const trial::TorqueRecord>(std::move(record));
}

}  // namespace zerocount::sections
