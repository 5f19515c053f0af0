#pragma once

namespace zerocount::hdf5 {

/// A use of the HDF5 library, which is not made for threads: it has one state for all files. Uses of one
/// thread may be inside each other.
class LibraryUse {
 public:
  /// @throws std::logic_error while another thread uses the library
  LibraryUse();
  LibraryUse(const LibraryUse&) = delete;
  LibraryUse& operator=(const LibraryUse&) = delete;
  ~LibraryUse();

 private:
  bool is_outermost_;
};

}  // namespace zerocount::hdf5
