// A database file and prepared statements on it.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "hal/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace tandem::study {

class Database;

/// A statement that is run again and again. Errors are kept until `Database::status` is asked.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(Statement&& other) noexcept;
  Statement& operator=(Statement&&) = delete;

  Statement& bind(std::int64_t value);
  Statement& bind(double value);  ///< not finite: null
  Statement& bind(std::string_view text);
  /// A number where the whole text is one.
  Statement& bind_setting(const std::string& text);
  /// @returns whether there is a row; without one it is ready for the next values.
  bool step();
  void run();

  std::int64_t integer(int column) const;
  double number(int column) const;     ///< null: NaN
  std::string text(int column) const;  ///< of a number: all its digits; null: empty
  bool is_null(int column) const;
  int columns() const;
  std::string name(int column) const;

 private:
  Database* database_;
  sqlite3_stmt* statement_ = nullptr;
  int next_ = 1;
};

/// An open database; closed at the end. Its first error stays, and everything after it does nothing.
class Database {
 public:
  enum class Use { Read, Write };
  static hal::Result<std::unique_ptr<Database>> open(const std::string& path, Use use);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Statements without results, separated by semicolons.
  void execute(const std::string& sql);
  bool has(const std::string& table);
  /// "cannot write the table 'x.sqlite': the disk is full".
  hal::Status status() const;
  bool good() const noexcept { return error_.empty(); }
  /// Forgets the error, and what a broken transaction wrote.
  void roll_back();

 private:
  friend class Statement;
  explicit Database(std::string path) : path_(std::move(path)) {}
  void note(int code);

  std::string path_;
  std::string error_;
  sqlite3* database_ = nullptr;
};

/// As a name stands in SQL.
std::string quoted(const std::string& name);
/// Whether SQL takes two names for one: capital letters are as small ones.
bool same_name(const std::string& a, const std::string& b);

}  // namespace tandem::study
