#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::study {

/// Consecutive rows that a study adds to its table of parameters, such as one row for each value of a list.
struct RowGroup {
  std::size_t row{0};    ///< row of the table that the group follows in columns and listings
  std::size_t first{0};  ///< index of the first row in the study's table
  std::size_t count{0};  ///< number of rows in the group
};

/// The parameters of one study: the rows of the table of parameters, followed by the rows that depend on its
/// manifest. The number of a row is the slot of its values in the plan. The slots of rows that stand for
/// others, such as the row of a list, are unused.
struct StudyTable {
  std::vector<parameters::Parameter> rows{parameters::parameter_table().begin(),
                                          parameters::parameter_table().end()};
  std::vector<RowGroup> groups{};
  /// Strings to which the rows of the groups refer. Copies of a table share them.
  std::shared_ptr<std::deque<std::string>> names{std::make_shared<std::deque<std::string>>()};
};

/// Changes the unit of target positions in the study's table from counts to that of command.units: si (rad,
/// or m). Must be called before rows are added.
void use_si_positions(StudyTable& table);

/// Adds one row to the study's table for each of the `count` values of a list.
/// @param row row of the list
RowGroup add_list(StudyTable& table, std::size_t row, std::size_t count);

/// Adds the table rows of element `index` of a list of maps, one for each key of the element's form.
/// @return the rows in the order of the form's keys
RowGroup add_element(StudyTable& table, const parameters::ElementList& list, std::size_t index,
                     const parameters::ElementForm& form);

/// Adds the rows of the parameters of the user's controller, which must outlive the table.
RowGroup add_plugin(StudyTable& table, const plugin::PluginDescription& plugin);

/// Suffix of the name of the rate at which a value changes with age: "friction.k1.aging".
inline constexpr std::string_view suffix_of_rate = ".aging";

/// The row of the rate at which the value of `row` changes with age, "friction.k1.aging". The row is added if
/// it does not exist yet.
std::size_t rate_row(StudyTable& table, std::size_t row);

/// The table rows with the values of a list; empty if the study does not have the list.
/// @param row row of the list
std::optional<RowGroup> find_list(const StudyTable& table, std::size_t row);

/// All slots (rows of the study's table that hold a value of a trial), in the order of columns. This is the
/// order of the table of parameters; the values of a list stand at the position of the list's row, and the
/// values of elements at the position of their first key.
std::vector<std::size_t> slots_in_table_order(const StudyTable& table);

/// The slots (rows of the study's table) that a dotted path in a sweep names: one slot, or all slots of a
/// list for "command.targets".
struct SlotRange {
  std::size_t first{0};
  std::size_t count{1};
  bool list{false};  ///< the path names a list: a swept value is a list with one entry per slot
};
std::optional<SlotRange> find_slots(std::string_view path, const StudyTable& table);

/// The table row of the list that the path names ("command.targets"), or one of whose values it names
/// ("command.targets.0"), even if the study does not have the list. Empty if there is no such list.
std::optional<std::size_t> find_list_row(std::string_view path);

}  // namespace zerocount::study
