#pragma once

#include "results/layout/fields.hpp"
#include "results/layout/layout.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {

/// Expects that two lists of records are equal in every bit of every field, NaN included.
template <class Record>
void expect_equal_records(const std::vector<layout::RecordField<Record>>& fields,
                          const std::vector<Record>& left, const std::vector<Record>& right) {
  ASSERT_EQ(left.size(), right.size());
  const auto columns = [&](const std::vector<Record>& records) {
    return layout::columns_of<Record>(fields, layout::pointers_to(records));
  };
  const auto of_left = columns(left);
  const auto of_right = columns(right);
  for (std::size_t i = 0; i < fields.size(); ++i) EXPECT_EQ(of_left[i], of_right[i]) << fields[i].column.name;
}

}  // namespace zerocount::testing
