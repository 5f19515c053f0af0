#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/failure.hpp"
#include "results/hdf5/element.hpp"

/// A thin layer over the HDF5 C library: handles that close themselves, and failures in our own words.
///
/// A failed operation throws Failure: machine_failed where the file is being written or the system reports an
/// error, bad_data where a file being read does not hold what it should. No text of the library reaches the
/// message. All objects of one file must be used by one thread at a time.
namespace zerocount::hdf5 {

using Id = std::int64_t;          ///< an identifier of the library, its hid_t
using Size = unsigned long long;  ///< a number of elements, the library's hsize_t

/// An identifier of the library, closed at the end of its life.
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
  bool close();  ///< false where the library reports a failure; closing twice is harmless

 private:
  static constexpr Id none = -1;

  Id id_{none};
  Close close_{nullptr};
};

/// The file an object belongs to, for messages, and whether it is being read or written.
struct Origin {
  std::string file;
  bool writing{false};
};

/// A group or a dataset: something with a path and attributes.
class Object {
 public:
  const std::string& path() const { return path_; }
  const std::string& file_name() const { return origin_->file; }  ///< of the file it belongs to
  bool has_attribute(const std::string& name) const;

  void set_text(const std::string& name, const std::string& value);
  void set_integer(const std::string& name, std::int64_t value);
  void set_unsigned(const std::string& name, std::uint64_t value);
  /// A 1-D attribute with elements of type `element` (an integer type).
  void set_integers(const std::string& name, Element element, std::span<const std::int64_t> values);

  std::string text(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  std::uint64_t unsigned_integer(const std::string& name) const;

  /// Throws the Failure for this object; `problem` completes "damaged: ".
  [[noreturn]] void fail(std::string_view problem) const;

 protected:
  Object(Handle handle, std::shared_ptr<const Origin> origin, std::string path)
      : handle_(std::move(handle)), origin_(std::move(origin)), path_(std::move(path)) {}

  Id id() const { return handle_.get(); }
  const std::shared_ptr<const Origin>& origin() const { return origin_; }
  Handle own(Id id, Handle::Close close, std::string_view problem) const;
  void require(int status, std::string_view problem) const;

  Handle handle_;

 private:
  void write_attribute(const std::string& name, Id file_type, Id memory_type, Id space, const void* data);
  Handle open_attribute(const std::string& name) const;

  std::shared_ptr<const Origin> origin_;
  std::string path_;
};

/// How a new dataset is stored.
/// Shuffled and deflated, or as it is. What is not compressed is written faster and takes more room.
enum class Compression { deflate, none };

struct Storage {
  Element element{Element::float64};
  std::vector<Size> extent;  ///< empty: a scalar
  std::vector<Size> chunk;   ///< as many as extent, each at least 1
  bool extendible{false};    ///< the first dimension can grow
  Compression compression{Compression::deflate};
};

class Dataset : public Object {
 public:
  Element element() const { return element_; }
  std::vector<Size> extent() const;

  /// Rows [first, first + rows) of the first dimension, whole in the others; `data` holds elements of type
  /// element().
  void write(std::int64_t first, std::int64_t rows, const void* data);
  void read(std::int64_t first, std::int64_t rows, void* data) const;

  void write_texts(std::span<const std::string> texts);
  std::vector<std::string> read_texts() const;

  void make_scale(const std::string& name);
  void attach_scale(const Dataset& scale, unsigned dimension);

 private:
  friend class Group;
  Dataset(Handle handle, std::shared_ptr<const Origin> origin, std::string path);
  Element stored_element() const;
  struct Selection {
    Handle file;
    Handle memory;
  };
  Selection select(std::int64_t first, std::int64_t rows) const;

  Element element_;
};

class Group : public Object {
 public:
  Group create_group(const std::string& name);
  Group open_group(const std::string& name) const;
  Dataset create_dataset(const std::string& name, const Storage& storage);
  Dataset open_dataset(const std::string& name) const;
  bool contains(const std::string& name) const;
  bool is_group(const std::string& name) const;  ///< of a member: a group, and no dataset
  std::vector<std::string> children() const;     ///< names, in order of creation

 protected:
  Group(Handle handle, std::shared_ptr<const Origin> origin, std::string path)
      : Object(std::move(handle), std::move(origin), std::move(path)) {}
  std::string path_to(const std::string& name) const;
};

/// True where the file begins as the HDF5 format does.
/// @throws Failure (machine_failed) with the path and the reason where it cannot be read.
bool is_hdf5(const std::filesystem::path& path);

/// An open file, which is its root group.
class File : public Group {
 public:
  /// A new file at `path`; what stood there is lost.
  static File create(const std::filesystem::path& path);
  static File open_to_read(const std::filesystem::path& path);
  static File open_to_change(const std::filesystem::path& path);

  /// Writes everything out and closes. Without it the destructor closes, and failures go unseen.
  void close();

 private:
  File(Handle file, Handle root, std::shared_ptr<const Origin> origin)
      : Group(std::move(root), std::move(origin), "/"), file_(std::move(file)) {}
  static File wrap(Id file, std::shared_ptr<const Origin> origin);

  Handle file_;
};

}  // namespace zerocount::hdf5
