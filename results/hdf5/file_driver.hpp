#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "results/hdf5/hdf5.hpp"
#include "results/storage/byte_file.hpp"

/// A file driver for the HDF5 library that reads and writes through a ByteFile.
///
/// Version 1.10 of the library does not handle failed writes. H5Dclose ignores that a chunk could not be
/// written: the file is closed without an error, and the chunk reads as zeros. If H5Dwrite reports the
/// failure, the library frees the dataset's chunk cache and uses it again when the dataset is closed (SIGSEGV
/// in H5D_close). Therefore this driver reports every write as successful. ByteFile records the failure and
/// keeps the bytes in memory, so that the library reads what it wrote. Object and File check for a failure
/// after every call.
///
/// The library does not handle failed reads either. If a read fails while the library lists the links of a
/// group or reads texts, it frees pointers that it has not set (SIGSEGV in H5G__link_release_table, SIGABRT
/// in H5MM_xfree). Therefore a failed read ends the process: the driver prints the path and the reason, and
/// exits with machine_failed. A file *.part may remain; the next command removes it.
namespace zerocount::hdf5 {

/// Creates the HDF5 access property list by which the library opens the file `bytes` through this driver.
///
/// Object headers have version 2: they have checksums, and readers built on HDF5 1.8 can read them. The
/// library's own file locks are off: finished files never change, and the locks fail on some cluster file
/// systems.
/// @param bytes must stay valid until the file is open; the library holds a shared pointer from then on
Handle access_properties(const std::shared_ptr<storage::ByteFile>& bytes);

/// Finds out where the file stores a chunk. While an object of this class lives, the reads of dataset
/// elements by this thread are noted and not done: the library reveals the position of the bytes by asking
/// for them, and leaves its buffer as it is.
class ReadNote {
 public:
  ReadNote();
  ReadNote(const ReadNote&) = delete;
  ReadNote& operator=(const ReadNote&) = delete;
  ~ReadNote();

  std::uint64_t address() const {
    return address_;
  }  ///< Position in the file of the last read that was
     ///< noted, bytes from its beginning
  std::size_t size() const {
    return size_;
  }  ///< Size of the last read that was noted, bytes; 0 if
     ///< there was none
  void set(std::uint64_t address, std::size_t size) {
    address_ = address;
    size_ = size;
  }

 private:
  std::uint64_t address_{0};
  std::size_t size_{0};
};

}  // namespace zerocount::hdf5
