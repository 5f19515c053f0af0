#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "results/layout/layout.hpp"

namespace zerocount {

/// The type that stands in a column's buffer for a member of type Value (see Element).
template <class Value>
using Stored = std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t,
                                  std::conditional_t<std::is_enum_v<Value>, std::int8_t, Value>>;

/// One column of `records` as the bytes of its elements.
template <class Record>
std::vector<std::byte> gather(const RecordField<Record>& field, std::span<const Record> records) {
  std::vector<std::byte> bytes(records.size() * size_of(field.column.element));
  std::visit(
      [&]<class Value>(Value Record::*member) {
        std::byte* to = bytes.data();
        for (const Record& record : records) {
          const auto stored = static_cast<Stored<Value>>(record.*member);
          std::memcpy(to, &stored, sizeof stored);
          to += sizeof stored;
        }
      },
      field.member);
  return bytes;
}

/// The reverse of gather.
template <class Record>
void scatter(const RecordField<Record>& field, std::span<const std::byte> bytes, std::span<Record> records) {
  std::visit(
      [&]<class Value>(Value Record::*member) {
        const std::byte* from = bytes.data();
        for (Record& record : records) {
          Stored<Value> stored{};
          std::memcpy(&stored, from, sizeof stored);
          record.*member = static_cast<Value>(stored);
          from += sizeof stored;
        }
      },
      field.member);
}

}  // namespace zerocount
