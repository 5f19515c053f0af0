#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

/// A thin layer over SQLite: no handle leaks, and no text of SQLite reaches the user.
namespace zerocount::history {
namespace sqlite {

class Connection;

/// A prepared statement. Parameters and columns count from 0.
class Statement {
 public:
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::int64_t number);
  Statement& bind(int parameter, double number);  ///< NaN as NULL
  Statement& bind_null(int parameter);

  /// Runs up to the next row; false at the end.
  bool step();
  /// Makes the statement ready to run again, with its parameters.
  void reset();

  bool is_null(int column) const;
  std::string text(int column) const;
  std::int64_t whole(int column) const;
  double number(int column) const;  ///< NaN for NULL

 private:
  friend class Connection;
  Statement(const Connection& connection, sqlite3_stmt* statement);
  void require(int code) const;

  const Connection* connection_;
  std::unique_ptr<sqlite3_stmt, void (*)(sqlite3_stmt*)> statement_;
};

/// An open database. Every function may find that the file is damaged, locked or cannot be read or written,
/// and throws Failure then, with the file's name and the reason in our words: bad_data for damage or another
/// format, otherwise machine_failed.
class Connection {
 public:
  enum class Mode {
    existing,  ///< the file must exist
    create     ///< an empty database is made where there is no file
  };

  /// @param wait seconds to wait for another process that holds the database
  Connection(std::filesystem::path path, Mode mode, double wait);

  const std::filesystem::path& path() const { return path_; }
  void execute(const std::string& sql) const;
  Statement prepare(std::string_view sql) const;
  std::int64_t last_row() const;
  /// The single number that a statement such as "PRAGMA user_version" gives.
  std::int64_t whole_number(std::string_view sql) const;

  /// Throws the Failure of this result code of SQLite.
  [[noreturn]] void fail(int code) const;
  /// @throws Failure (bad_data): damaged
  [[noreturn]] void fail_damaged() const;

 private:
  void require(int code) const;

  std::filesystem::path path_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> connection_;
};

/// A transaction that holds the write lock from the start. The destructor undoes it unless it was committed.
class Transaction {
 public:
  explicit Transaction(const Connection& connection);
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();

  void commit();

 private:
  const Connection& connection_;
  bool open_{true};
};

}  // namespace sqlite
}  // namespace zerocount::history
