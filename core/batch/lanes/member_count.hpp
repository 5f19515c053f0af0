#pragma once

#include <cstddef>

namespace zerocount::batch {

/// Stands for a value of any member of a structure; used in unevaluated expressions only.
struct AnyMember {
  template <class Member>
  operator Member() const;
};

/// Number of data members of an aggregate without base classes.
///
/// A function that must consider each member of a structure compares it with the number that it was written
/// for in a static_assert. The compiler then asks for a decision when a member is added.
template <class Aggregate, class... Members>
consteval std::size_t member_count() {
  if constexpr (requires { Aggregate{Members{}..., AnyMember{}}; })
    return member_count<Aggregate, Members..., AnyMember>();
  else
    return sizeof...(Members);
}

}  // namespace zerocount::batch
