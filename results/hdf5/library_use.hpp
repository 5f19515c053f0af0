#pragma once

namespace zerocount::hdf5 {

/// Guard for a use of the HDF5 library, which is not thread-safe: it has one state for all files. The library
/// counts as used while an object of this class lives. One thread may nest several uses.
class LibraryUse {
 public:
  /// Begins a use of the library.
  /// @throws std::logic_error while another thread uses the library
  LibraryUse();
  LibraryUse(const LibraryUse&) = delete;
  LibraryUse& operator=(const LibraryUse&) = delete;
  ~LibraryUse();

 private:
  bool is_outermost_;
};

}  // namespace zerocount::hdf5
