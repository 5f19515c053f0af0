#include <atomic>
#include <stdexcept>
#include <thread>

#include <hdf5.h>

#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

std::atomic<std::thread::id> user{};  // of the library of this process

/// Turns off the HDF5 library's messages on stderr, and its exit handler, which would repeat failed writes.
void quieten() {
  static const herr_t no_work_at_exit = H5dont_atexit();
  static_cast<void>(no_work_at_exit);
  static thread_local const herr_t no_messages = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  static_cast<void>(no_messages);
}

}  // namespace

LibraryUse::LibraryUse() {
  const std::thread::id self = std::this_thread::get_id();
  std::thread::id before{};
  is_outermost_ = user.compare_exchange_strong(before, self);
  if (!is_outermost_ && before != self) throw std::logic_error("two threads call the HDF5 library at a time");
  quieten();
}

LibraryUse::~LibraryUse() {
  if (is_outermost_) user.store(std::thread::id());
}

}  // namespace zerocount::hdf5
