#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "results/layout/layout.hpp"

namespace zerocount::layout {

/// Type in which a value of type Value is stored in a column: std::uint8_t for bool, std::int8_t for
/// enumerations, otherwise Value itself.
template <class Value>
using Stored = std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t,
                                  std::conditional_t<std::is_enum_v<Value>, std::int8_t, Value>>;

/// Type of the value of a member of a record, or of the result of a function of the record.
template <class Record, class Member>
using ValueOf = std::remove_cvref_t<std::invoke_result_t<Member, const Record&>>;

template <class Value>
constexpr hdf5::Element element_of() {
  if constexpr (std::is_same_v<Value, double>) return hdf5::Element::float64;
  if constexpr (std::is_same_v<Value, std::int64_t>) return hdf5::Element::int64;
  if constexpr (std::is_same_v<Value, int>) return hdf5::Element::int32;
  if constexpr (std::is_same_v<Value, bool>) return hdf5::Element::flag;
  return hdf5::Element::int8;
}

/// Creates the description of one field of a record: its name, unit, meaning and valid values.
/// @param member member of Record or of a base of it, or a function of the record, which gives the value.
template <class Record, class Member>
RecordField<Record> field(const char* name, const char* unit, const char* long_name, Member member,
                          const ValidValues& valid = {}, std::vector<FlagMeaning> flags = {}) {
  using Value = ValueOf<Record, Member>;
  if constexpr (std::is_same_v<Value, bool>) flags = {{0, "no"}, {1, "yes"}};
  const Column column{name, unit, long_name, element_of<Value>(), std::move(flags), {}};
  if constexpr (std::is_member_object_pointer_v<Member>) {
    return {column, static_cast<Value Record::*>(member), valid};
  } else {
    return {column, member, valid};
  }
}

/// The value of a field in a record, as a double, whatever its type in the file.
template <class Record>
double value_of(const RecordField<Record>& field, const Record& record) {
  return std::visit([&](auto member) { return static_cast<double>(std::invoke(member, record)); },
                    field.member);
}

/// Copies the values of one field of all records to `values`, as doubles.
template <class Record>
void values_of(const RecordField<Record>& field, std::span<const Record* const> records,
               std::span<double> values) {
  std::visit(
      [&](auto member) {
        std::ranges::transform(records, values.begin(), [member](const Record* record) {
          return static_cast<double>(std::invoke(member, *record));
        });
      },
      field.member);
}

/// Whether the field's value is a function of the record's other fields. Such a field is written to files,
/// and computed again when a record is read.
template <class Record>
bool is_computed(const RecordField<Record>& field) {
  return std::holds_alternative<double (*)(const Record&)>(field.member);
}

template <class Record>
std::vector<const Record*> pointers_to(const std::vector<Record>& records) {
  std::vector<const Record*> pointers;
  pointers.reserve(records.size());
  for (const Record& record : records) pointers.push_back(&record);
  return pointers;
}

/// Copies the values of one field of all records to `to`, in the bytes of a file column's elements.
template <class Record>
void gather(const RecordField<Record>& field, std::span<const Record* const> records, std::byte* to) {
  std::visit(
      [&](auto member) {
        for (const Record* record : records) {
          const auto stored =
              static_cast<Stored<ValueOf<Record, decltype(member)>>>(std::invoke(member, *record));
          std::memcpy(to, &stored, sizeof stored);
          to += sizeof stored;
        }
      },
      field.member);
}

/// Number of records copied at a time, few enough to stay in the cache while all of their fields are copied.
inline constexpr std::size_t records_at_a_time = 32;

/// Copies the records to columns, [field], each as the bytes of its elements.
template <class Record>
std::vector<std::vector<std::byte>> columns_of(const std::vector<RecordField<Record>>& fields,
                                               std::span<const Record* const> records) {
  std::vector<std::vector<std::byte>> columns;
  columns.reserve(fields.size());
  for (const RecordField<Record>& field : fields)
    columns.emplace_back(records.size() * hdf5::size_of(field.column.element));
  for (std::size_t first = 0; first < records.size(); first += records_at_a_time) {
    const auto some = records.subspan(first, std::min(records_at_a_time, records.size() - first));
    for (std::size_t i = 0; i < fields.size(); ++i)
      gather(fields[i], some, columns[i].data() + first * hdf5::size_of(fields[i].column.element));
  }
  return columns;
}

/// Reads one field of all records from the bytes that gather() wrote. A computed field is not read.
template <class Record>
void scatter(const RecordField<Record>& field, std::span<const std::byte> bytes, std::span<Record> records) {
  std::visit(
      [&](auto member) {
        if constexpr (std::is_member_object_pointer_v<decltype(member)>) {
          using Value = ValueOf<Record, decltype(member)>;
          const std::byte* from = bytes.data();
          for (Record& record : records) {
            Stored<Value> stored{};
            std::memcpy(&stored, from, sizeof stored);
            record.*member = static_cast<Value>(stored);
            from += sizeof stored;
          }
        }
      },
      field.member);
}

/// Reads records from the columns that columns_of() made.
/// @param skipped number of records in the columns before the first of `records`.
template <class Record>
void scatter_all(const std::vector<RecordField<Record>>& fields,
                 const std::vector<std::vector<std::byte>>& columns, std::size_t skipped,
                 std::span<Record> records) {
  for (std::size_t first = 0; first < records.size(); first += records_at_a_time) {
    const std::span<Record> some =
        records.subspan(first, std::min(records_at_a_time, records.size() - first));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const std::size_t size = hdf5::size_of(fields[i].column.element);
      scatter(fields[i], std::span(columns[i]).subspan((skipped + first) * size, some.size() * size), some);
    }
  }
}

}  // namespace zerocount::layout
