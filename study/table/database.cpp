#include "study/table/database.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sqlite3.h>
#include <utility>

#include "hal/input_file.hpp"
#include "hal/unit.hpp"

namespace tandem::study {

std::string quoted(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

bool same_name(const std::string& a, const std::string& b) {
  return sqlite3_stricmp(a.c_str(), b.c_str()) == 0;
}

// --- statements ---

Statement::Statement(Database& database, const std::string& sql) : database_(&database) {
  if (!database.good()) return;
  database.note(sqlite3_prepare_v2(database.database_, sql.c_str(), -1, &statement_, nullptr));
}

Statement::~Statement() {
  sqlite3_finalize(statement_);
}

Statement::Statement(Statement&& other) noexcept
    : database_(other.database_), statement_(std::exchange(other.statement_, nullptr)), next_(other.next_) {}

Statement& Statement::bind(std::int64_t value) {
  if (statement_ != nullptr) database_->note(sqlite3_bind_int64(statement_, next_++, value));
  return *this;
}

Statement& Statement::bind(double value) {
  if (statement_ == nullptr) return *this;
  database_->note(std::isfinite(value) ? sqlite3_bind_double(statement_, next_, value)
                                       : sqlite3_bind_null(statement_, next_));
  ++next_;
  return *this;
}

Statement& Statement::bind(std::string_view text) {
  if (statement_ != nullptr)
    database_->note(
        sqlite3_bind_text(statement_, next_++, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind_setting(const std::string& text) {
  const char* const end = text.data() + text.size();
  std::int64_t whole = 0;
  if (const auto [at, error] = std::from_chars(text.data(), end, whole); error == std::errc() && at == end)
    return bind(whole);
  double number = 0.0;
  if (const auto [at, error] = std::from_chars(text.data(), end, number);
      error == std::errc() && at == end && std::isfinite(number))
    return bind(number);
  return bind(std::string_view(text));
}

bool Statement::step() {
  if (statement_ == nullptr || !database_->good()) return false;
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_->note(code);
  sqlite3_reset(statement_);
  next_ = 1;
  return false;
}

void Statement::run() {
  while (step()) {
  }
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}
double Statement::number(int column) const {
  return is_null(column) ? std::numeric_limits<double>::quiet_NaN() : sqlite3_column_double(statement_, column);
}
std::string Statement::text(int column) const {
  if (sqlite3_column_type(statement_, column) == SQLITE_FLOAT) return hal::format_number(number(column));
  const unsigned char* const text = sqlite3_column_text(statement_, column);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}
bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}
int Statement::columns() const {
  return sqlite3_column_count(statement_);
}
std::string Statement::name(int column) const {
  const char* const name = sqlite3_column_name(statement_, column);
  return name == nullptr ? "" : name;
}

// --- the database ---

hal::Result<std::unique_ptr<Database>> Database::open(const std::string& path, Use use) {
  std::unique_ptr<Database> database(new Database(path));
  if (use == Use::Read || std::filesystem::exists(path)) {
    if (const hal::Status file = hal::check_input_file(path, "table"); !file.ok()) return file.error();
  }
  const int flags = use == Use::Read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int code = sqlite3_open_v2(path.c_str(), &database->database_, flags, nullptr);
  if (code != SQLITE_OK) {
    database->note(code);
    return database->status().error();
  }
  sqlite3_busy_timeout(database->database_, 10'000);
  return database;
}

Database::~Database() {
  sqlite3_close_v2(database_);
}

void Database::note(int code) {
  if (code == SQLITE_OK || !error_.empty()) return;
  switch (code & 0xFF) {
    case SQLITE_FULL:
      error_ = "the disk is full";
      break;
    case SQLITE_NOTADB:
      error_ = "it is no table of a study (SQLite)";
      break;
    default:
      error_ = database_ != nullptr ? sqlite3_errmsg(database_) : "no memory";
  }
}

hal::Status Database::status() const {
  if (error_.empty()) return {};
  return hal::Error{"the table '" + path_ + "' cannot be used: " + error_};
}

void Database::execute(const std::string& sql) {
  if (good()) note(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr));
}

bool Database::has(const std::string& table) {
  Statement find(*this, "SELECT 1 FROM sqlite_master WHERE type='table' AND name=?");
  find.bind(std::string_view(table));
  return find.step();
}

void Database::roll_back() {
  error_.clear();
  if (sqlite3_get_autocommit(database_) == 0) sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
}

}  // namespace tandem::study
