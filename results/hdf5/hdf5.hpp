#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/failure/failure.hpp"
#include "results/hdf5/chunk_filters.hpp"
#include "results/hdf5/element.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/written_bytes.hpp"

namespace zerocount::timeline {
class Timeline;
}

/// A thin layer over the HDF5 C library: handles that close themselves, and errors as Failure.
///
/// A failed operation throws Failure: machine_failed while a file is written or if the system reports an
/// error, bad_data if a file that is read has unexpected contents. Messages contain no text of the library.
/// All objects of one file must be used by one thread at a time.
///
/// A file is written in three steps: File::create, File::close, WrittenBytes::require_in. A write that fails
/// is reported by the call that made it, or by a later one, File::close at the latest. After a failed write
/// the library is not called again for that file: its handles stay open until the process ends.
namespace zerocount::hdf5 {

using Id = std::int64_t;          ///< An identifier of an object in the HDF5 library, its type hid_t
using Size = unsigned long long;  ///< A number of elements or a length of a dimension in the HDF5 library,
                                  /// < its type hsize_t

/// Owner of an identifier of the HDF5 library; the destructor closes the identifier.
class Handle {
 public:
  using Close = int (*)(Id);

  Handle() = default;
  Handle(Id id, Close closer) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&& other) noexcept;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close(); }

  Id get() const { return id_; }
  bool close();    ///< Closes the identifier. Returns false if the HDF5 library reports a failure. A second
                   /// < call does nothing.
  void abandon();  ///< Gives the identifier up without closing it.

 private:
  static constexpr Id none = -1;

  Id id_{none};
  Close close_{nullptr};
};

/// The open HDF5 file to which an object belongs, shared by all its objects.
struct Origin;

/// A group or a dataset of an HDF5 file: something with a path and attributes.
class Object {
 public:
  Object(Object&& other) noexcept = default;
  Object& operator=(Object&& other) noexcept;
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  ~Object() { release(); }

  const std::string& path() const { return path_; }
  const std::string& file_name() const;  ///< Name of the file to which the object belongs
  bool has_attribute(const std::string& name) const;

  void set_text(const std::string& name, const std::string& value);
  void set_integer(const std::string& name, std::int64_t value);
  void set_unsigned(const std::string& name, std::uint64_t value);
  /// Writes a one-dimensional attribute of integers to the object.
  /// @param element type of the elements in the file, an integer type.
  void set_integers(const std::string& name, Element element, std::span<const std::int64_t> values);

  std::string text(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  std::uint64_t unsigned_integer(const std::string& name) const;
  std::vector<std::int64_t> integers(const std::string& name) const;

  /// Throws the Failure for a damaged or unusable object, with file and path in its message; `problem`
  /// completes the message "damaged: ".
  [[noreturn]] void fail(std::string_view problem) const;

 protected:
  Object(Handle handle, std::shared_ptr<Origin> origin, std::string path)
      : origin_(std::move(origin)), handle_(std::move(handle)), path_(std::move(path)) {}

  Id id() const { return handle_.get(); }
  const std::shared_ptr<Origin>& origin() const { return origin_; }
  /// Takes over the identifier that an operation of the HDF5 library returned. Throws the Failure with the
  /// text `problem` if the identifier is invalid or a write has failed.
  Handle own(Id id, Handle::Close close, std::string_view problem) const;
  /// Throws the Failure with the text `problem` if an operation of the HDF5 library returned a negative
  /// status, or a write has failed.
  void require(int status, std::string_view problem) const;
  void release() noexcept;  ///< Closes the object; a failure is kept for File::close.

 private:
  void write_attribute(const std::string& name, Id file_type, Id memory_type, Id space, const void* data);
  Handle open_attribute(const std::string& name) const;
  void write_single(const std::string& name, Id file_type, Id memory_type, const void* data);
  /// Reads an attribute with one value into `data`; `kind` completes the error message "the attribute is not
  /// a ".
  void read_single(const std::string& name, Id memory_type, void* data, std::string_view kind) const;

  std::shared_ptr<Origin> origin_;
  Handle handle_;
  std::string path_;
};

/// Type, size and storage form of a new dataset.
struct Storage {
  Element element{Element::float64};
  std::vector<Size> extent;  ///< Lengths along the dimensions, in elements; empty: a single value
  std::vector<Size> chunk;   ///< Lengths of a chunk, the block in which the file stores the elements: one per
                             /// < dimension, each at least 1
  bool extendible{false};    ///< Whether the first dimension can grow later
  Compression compression{Compression::deflate};
};

struct RowsToWrite;
struct EncodedRows;
struct FetchedRows;

/// Shape of a dataset's chunks, the blocks in which the file stores it. Each chunk consists of whole rows;
/// the first dimension counts the rows.
struct ChunkShape {
  std::int64_t rows{0};
  std::size_t row_size{0};  ///< Size of one row in memory, bytes
  ChunkFilters filters;
  std::size_t dimensions{1};  ///< Number of dimensions of the dataset

  bool operator==(const ChunkShape&) const = default;
};

/// Position and bytes of one chunk, a stored block of a dataset, in the file.
struct StoredChunk {
  std::uint64_t address{0};        ///< Position of the chunk in the file, bytes from its beginning
  std::size_t size{0};             ///< Size of the stored chunk, bytes; 0: the chunk must be read by the HDF5
                                   /// < library
  std::vector<std::byte> bytes{};  ///< Stored bytes of the chunk, if the HDF5 library has read them;
                                   /// < otherwise empty
};

/// Source of rows of elements that are stored in chunks and can be read: a dataset of a results file, or a
/// column of a shard.
class RowSource {
 public:
  RowSource() = default;
  RowSource(const RowSource&) = default;
  RowSource& operator=(const RowSource&) = default;
  virtual ~RowSource() = default;

  virtual Element element() const = 0;
  /// Finds the chunks that hold the rows [first, first + rows), for decode_rows(). The source must live until
  /// they are decoded.
  virtual FetchedRows fetch(std::int64_t first, std::int64_t rows) const = 0;
  /// The stored bytes of a chunk. Reads them from the file unless `chunk` has them already. Any thread may
  /// call this while the file stays open, because it does not call the HDF5 library.
  virtual std::vector<std::byte> bytes_of(StoredChunk&& chunk) const = 0;
  /// Throws the Failure for damaged contents of this source; `problem` completes the message "damaged: ".
  [[noreturn]] void fail(std::string_view problem) const {
    fail_with(problem);
    std::terminate();  // not reached
  }

  /// Reads the rows [first, first + rows) of the first dimension, whole in the others, into `data`, as
  /// elements of type element().
  void read(std::int64_t first, std::int64_t rows, void* data) const;

 private:
  /// Throws the Failure for damaged contents, with `problem` in its message
  virtual void fail_with(std::string_view problem) const = 0;
};

class Dataset : public Object, public RowSource {
 public:
  Element element() const override { return element_; }
  std::vector<Size> extent() const;

  /// Writes the rows [first, first + rows) of the first dimension, whole in the others, from `data`, which
  /// holds elements of type element(). To write to several datasets at a time, see encoded_rows.hpp.
  void write(std::int64_t first, std::int64_t rows, const void* data);
  FetchedRows fetch(std::int64_t first, std::int64_t rows) const override;
  std::vector<std::byte> bytes_of(StoredChunk&& chunk) const override;
  using Object::fail;
  /// Writes encoded rows to the dataset, from row `first` on, chunk by chunk. The rows must have been encoded
  /// for a dataset with the same chunks.
  void write(std::int64_t first, const EncodedRows& encoded);

  /// Shape of the dataset's chunks, the blocks in which it is stored. Empty if the dataset has no chunks, a
  /// chunk does not span whole rows, the dataset holds texts, its filters are not those of chunk_filters.hpp,
  /// or the processor is not little-endian.
  const std::optional<ChunkShape>& chunk_shape() const;

  void write_texts(std::span<const std::string> texts);
  std::vector<std::string> read_texts() const;

  void make_scale(const std::string& name);
  void attach_scale(const Dataset& scale, unsigned dimension);

 private:
  friend class Group;
  friend void write_rows(std::span<const RowsToWrite> all, timeline::Timeline* timeline);
  Dataset(Handle handle, std::shared_ptr<Origin> origin, std::string path);
  void fail_with(std::string_view problem) const override { fail(problem); }
  Element stored_element() const;
  struct Selection {
    Handle file;
    Handle memory;
  };
  void require_rows(std::int64_t first, std::int64_t rows) const;
  Selection select(std::int64_t first, std::int64_t rows) const;
  void write_by_library(std::int64_t first, std::int64_t rows, const void* data);
  void read_by_library(std::int64_t first, std::int64_t rows, void* data) const;

  /// Finds the stored chunk that begins at row `first`. Its size is 0 if it was never written, or if a filter
  /// was left out for it.
  StoredChunk find_chunk(std::int64_t first) const;
  void store_chunk(std::int64_t first, std::span<const std::byte> stored);
  std::vector<Size> place_of(std::int64_t first) const;  ///< Coordinates of the first element of row `first`,
                                                         /// < one per dimension: (first, 0, 0, …)
  std::optional<ChunkShape> read_chunk_shape() const;

  Element element_;
  /// Result of chunk_shape(), once it has been read; until then empty
  mutable std::optional<std::optional<ChunkShape>> chunk_shape_{};
};

class Group : public Object {
 public:
  Group create_group(const std::string& name);
  Group open_group(const std::string& name) const;
  Dataset create_dataset(const std::string& name, const Storage& storage);
  Dataset open_dataset(const std::string& name) const;
  bool contains(const std::string& name) const;
  bool is_group(const std::string& name) const;  ///< Whether the member `name` is a group, not a dataset
  std::vector<std::string> children() const;     ///< Names of the members of the group, in order of creation

 protected:
  Group(Handle handle, std::shared_ptr<Origin> origin, std::string path)
      : Object(std::move(handle), std::move(origin), std::move(path)) {}
  std::string path_to(const std::string& name) const;
};

/// True if the file begins with the signature of HDF5.
/// @throws Failure (machine_failed) with the path and the reason if it cannot be read.
bool is_hdf5(const std::filesystem::path& path);

/// An open HDF5 file, used as its own root group.
class File : public Group {
 public:
  File(File&& other) noexcept = default;
  File& operator=(File&& other) = delete;
  ~File();

  /// Creates a new HDF5 file at `path`; replaces an existing file.
  static File create(const std::filesystem::path& path);
  static File open_to_read(const std::filesystem::path& path);
  /// Opens an existing HDF5 file for reading and writing.
  /// @param so_far bytes written to the file earlier; close() returns them together with the new ones.
  static File open_to_change(const std::filesystem::path& path, storage::WrittenBytes so_far = {});

  /// Closes the file, and flushes it to the disk unless that is left to the caller. All other objects of the
  /// file must be destroyed.
  /// @return the bytes written, to compare the file with them.
  storage::WrittenBytes close(storage::Flush flush = storage::Flush::now);

 private:
  File(Handle file, Handle root, std::shared_ptr<Origin> origin)
      : Group(std::move(root), std::move(origin), "/"), file_(std::move(file)) {}
  static File open(std::shared_ptr<Origin> origin, bool create);

  Handle file_;
};

}  // namespace zerocount::hdf5
