#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "results/layout/fields.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::testing {

/// Equal in every bit of every field, NaN included.
template <class Record>
void expect_equal_records(const std::vector<layout::RecordField<Record>>& fields,
                          const std::vector<Record>& left, const std::vector<Record>& right) {
  ASSERT_EQ(left.size(), right.size());
  for (const layout::RecordField<Record>& field : fields) {
    EXPECT_EQ(layout::gather(field, std::span<const Record>(left)),
              layout::gather(field, std::span<const Record>(right)))
        << field.column.name;
  }
}

}  // namespace zerocount::testing
