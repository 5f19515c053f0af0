#pragma once

namespace zerocount::numerics {

/// ln 2 as a sum. The first term is a multiple of 2⁻⁴², so its multiples up to 2¹⁰ are exact.
inline constexpr double ln2_high = 0x1.62e42fefa3800p-1;
inline constexpr double ln2_low = 0x1.ef35793c76730p-45;

}  // namespace zerocount::numerics
