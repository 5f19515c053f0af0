#include "results/hdf5/file_driver.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "results/hdf5/hdf5_detail.hpp"

namespace zerocount::hdf5 {
namespace {

constexpr herr_t success = 0;
constexpr herr_t failure = -1;
constexpr haddr_t max_address = (haddr_t{1} << 63) - 1;

/// The HDF5 library's handle of a file that this driver has opened.
struct DriverFile : H5FD_t {
  std::shared_ptr<storage::ByteFile> bytes;
  haddr_t allocated{0};  ///< End of the address space that the library has allocated
};

/// Data that access_properties() passes to the driver's open_file().
struct DriverInfo {
  const std::shared_ptr<storage::ByteFile>* bytes{nullptr};
};

DriverFile& own_file(H5FD_t* file) {
  return *static_cast<DriverFile*>(file);
}

const DriverFile& own_file(const H5FD_t* file) {
  return *static_cast<const DriverFile*>(file);
}

H5FD_t* open_file(const char*, unsigned, hid_t properties, haddr_t) {
  const auto* info = static_cast<const DriverInfo*>(H5Pget_driver_info(properties));
  auto* file = info == nullptr ? nullptr : new (std::nothrow) DriverFile;
  if (file != nullptr) file->bytes = *info->bytes;
  return file;
}

herr_t close_file(H5FD_t* file) {
  delete &own_file(file);
  return success;
}

/// Reports to the HDF5 library the features of this driver: those of its default driver (sec2), so that it
/// lays out files in the same way.
herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return success;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) {
  return own_file(file).allocated;
}

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  own_file(file).allocated = address;
  return success;
}

haddr_t file_end(const H5FD_t* file, H5FD_mem_t) {
  return own_file(file).bytes->size();
}

[[noreturn]] void end_after_failed_read(const storage::ByteFile& bytes) {
  const storage::IoFailure reason = bytes.failure().value();
  const std::string message =
      text::printable_lines(fmt::format("{}: cannot {}: {}\n", bytes.path().string(), reason.action,
                                        std::system_category().message(reason.error)));
  std::fwrite(message.data(), 1, message.size(), stderr);
  std::_Exit(static_cast<int>(ExitCode::machine_failed));
}

thread_local ReadNote* note_of_reads = nullptr;

herr_t read(H5FD_t* file, H5FD_mem_t kind, hid_t, haddr_t address, std::size_t size, void* buffer) {
  if (note_of_reads != nullptr && kind == H5FD_MEM_DRAW) {
    note_of_reads->set(address, size);
    return success;
  }
  storage::ByteFile& bytes = *own_file(file).bytes;
  if (!bytes.read(address, {static_cast<std::byte*>(buffer), size})) end_after_failed_read(bytes);
  return success;
}

herr_t write(H5FD_t* file, H5FD_mem_t kind, hid_t, haddr_t address, std::size_t size, const void* buffer) {
  const auto rewritten = kind == H5FD_MEM_DRAW ? storage::Rewritten::as_a_whole : storage::Rewritten::in_part;
  try {
    own_file(file).bytes->write(address, {static_cast<const std::byte*>(buffer), size}, rewritten);
    return success;
  } catch (const std::exception&) {
    return failure;  // no memory left to keep the unwritten bytes
  }
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  DriverFile& own = own_file(file);
  if (own.allocated != own.bytes->size()) own.bytes->resize(own.allocated);
  return success;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
  driver.name = "zerocount";
  driver.maxaddr = max_address;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = allocated_end;
  driver.set_eoa = set_allocated_end;
  driver.get_eof = file_end;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  constexpr H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  static_assert(std::size(map) == H5FD_MEM_NTYPES);
  std::copy(std::begin(map), std::end(map), driver.fl_map);
  return driver;
}

Id driver() {
  static const H5FD_class_t description = driver_class();
  static const Id id = H5FDregister(&description);
  return id;
}

}  // namespace

ReadNote::ReadNote() {
  note_of_reads = this;
}

ReadNote::~ReadNote() {
  note_of_reads = nullptr;
}

Handle access_properties(const std::shared_ptr<storage::ByteFile>& bytes) {
  Handle properties = made(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const DriverInfo info{&bytes};
  demand(H5Pset_driver(properties.get(), driver(), &info));
  // What is written can be read by HDF5 1.8; what others have rewritten may be in any format.
  demand(H5Pset_libver_bounds(properties.get(), H5F_LIBVER_V18,
                              bytes->writable() ? H5F_LIBVER_V18 : H5F_LIBVER_LATEST));
  demand(H5Pset_fclose_degree(properties.get(), H5F_CLOSE_STRONG));
  demand(H5Pset_file_locking(properties.get(), false, true));
  return properties;
}

}  // namespace zerocount::hdf5
