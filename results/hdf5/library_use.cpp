#include "results/hdf5/library_use.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

namespace zerocount::hdf5 {
namespace {

std::atomic<std::thread::id> user{};  // of the library of this process

}  // namespace

LibraryUse::LibraryUse() {
  const std::thread::id self = std::this_thread::get_id();
  std::thread::id before{};
  is_outermost_ = user.compare_exchange_strong(before, self);
  if (!is_outermost_ && before != self) throw std::logic_error("two threads call the HDF5 library at a time");
}

LibraryUse::~LibraryUse() {
  if (is_outermost_) user.store(std::thread::id());
}

}  // namespace zerocount::hdf5
