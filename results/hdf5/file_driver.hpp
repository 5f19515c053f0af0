#pragma once

#include <memory>

#include "results/hdf5/hdf5.hpp"
#include "results/storage/byte_file.hpp"

/// A driver of the HDF5 library that hands its reads and writes to a ByteFile.
///
/// Version 1.10 of the library does not bear a write that fails. H5Dclose drops the failure of a chunk that
/// it could not write: the file is closed without a word, and the chunk reads as zeros. Where H5Dwrite does
/// report it, the library frees the dataset's cache of chunks and uses it once more when the dataset is
/// closed (SIGSEGV in H5D_close). So this driver reports no failed write: ByteFile remembers it, keeps the
/// bytes in memory so that the library reads what it wrote, and Object and File look for it after every call.
namespace zerocount::hdf5 {

/// Properties of access to a file that stands in `bytes`.
///
/// Object headers of version 2 carry checksums; later formats would lock out readers built on HDF5 1.8. Files
/// are immutable once they have their name, so the library's own file locks (which fail on some cluster file
/// systems) are off.
/// @param bytes must stay where it is until the file is open; the library shares it from then on
Handle access_properties(const std::shared_ptr<ByteFile>& bytes);

}  // namespace zerocount::hdf5
