#include "study/table/table.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "study/table/database.hpp"

namespace tandem::study {
namespace {

constexpr std::size_t kMostColumns = 1000;  // of measures in the view; SQLite has 2000 at most

/// Keeps others from writing the same table, for as long as it lives. Processes that are forked do not hold it.
class WriterLock {
 public:
  static hal::Result<std::unique_ptr<WriterLock>> take(const std::string& path) {
    std::unique_ptr<WriterLock> lock(new WriterLock);
    lock->fd_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock->fd_ < 0) return hal::Error{"cannot write the table '" + path + "': " + std::strerror(errno)};
    // The runs of a sweep that was just killed may still hold it.
    for (int tries = 0; flock(lock->fd_, LOCK_EX | LOCK_NB) != 0; ++tries) {
      if (errno == EINTR) continue;
      if (errno != EWOULDBLOCK) break;  // a file system without locks
      if (tries == 30) return hal::Error{"cannot write the table '" + path + "': another sweep is writing it"};
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return lock;
  }
  ~WriterLock() { let_go(); }
  void let_go() noexcept {
    if (fd_ >= 0) close(std::exchange(fd_, -1));
  }
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  WriterLock() = default;
  int fd_ = -1;
};

std::string hash_text(std::uint64_t hash) {
  char text[20];
  const int n = std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(hash));
  return {text, static_cast<std::size_t>(n)};
}

/// A setting as the table gives it back.
std::string canonical(const std::string& text) {
  const char* const end = text.data() + text.size();
  double number = 0.0;
  const auto [at, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || at != end) return text;
  char digits[40];
  return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

constexpr const char* kTables = R"(
CREATE TABLE study(key TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE versions(version INTEGER PRIMARY KEY, program TEXT NOT NULL);
CREATE TABLE version_files(version INTEGER NOT NULL, file TEXT NOT NULL, sha256 TEXT NOT NULL);
CREATE TABLE measures(run INTEGER NOT NULL, measure TEXT NOT NULL, value REAL, PRIMARY KEY(run, measure)) WITHOUT ROWID;
CREATE TABLE samples(run INTEGER NOT NULL, measure TEXT NOT NULL, tick INTEGER NOT NULL, time_s REAL NOT NULL, value REAL,
                     PRIMARY KEY(run, measure, tick)) WITHOUT ROWID;
CREATE TABLE times(run INTEGER PRIMARY KEY, wall_s REAL, cpu_s REAL);
)";

}  // namespace

bool same_setting(const std::string& in_table, const std::string& in_study) {
  return canonical(in_table) == canonical(in_study);
}

struct Table::Impl {
  std::string path;
  std::unique_ptr<WriterLock> lock;  // before the database: SQLite's own locks are gone first
  std::unique_ptr<Database> database;
  std::vector<std::string> settings;

  struct Statements {
    Statement run, clear_measures, clear_samples, measure, sample, times;
  };
  std::unique_ptr<Statements> statements;

  void prepare() {
    std::string columns, places;
    for (const std::string& name : settings) {
      columns += "," + quoted(name);
      places += ",?";
    }
    Database& d = *database;
    statements = std::make_unique<Statements>(Statements{
        {d, "INSERT OR REPLACE INTO runs(run,experiment,seed" + columns +
                ",state,ended,failure,ticks,virtual_s,fingerprint,version) VALUES(?,?,?" + places + ",?,?,?,?,?,?,?)"},
        {d, "DELETE FROM measures WHERE run=?"},
        {d, "DELETE FROM samples WHERE run=?"},
        {d, "INSERT INTO measures(run,measure,value) VALUES(?,?,?)"},
        {d, "INSERT INTO samples(run,measure,tick,time_s,value) VALUES(?,?,?,?,?)"},
        {d, "INSERT OR REPLACE INTO times(run,wall_s,cpu_s) VALUES(?,?,?)"}});
  }

  void put(const std::string& key, std::string_view value) {
    Statement(*database, "INSERT OR REPLACE INTO study(key,value) VALUES(?,?)")
        .bind(std::string_view(key))
        .bind(value)
        .run();
  }
  void put_head(const TableHead& head) {
    put("study", head.study);
    put("file", head.file);
    put("runs", std::to_string(head.runs));
  }
  std::string get(const std::string& key) {
    Statement find(*database, "SELECT value FROM study WHERE key=?");
    find.bind(std::string_view(key));
    return find.step() ? find.text(0) : "";
  }
  /// Commits when all was well; else nothing of it stays.
  hal::Status end_transaction() {
    database->execute("COMMIT");
    hal::Status status = database->status();
    if (!status.ok()) database->roll_back();
    return status;
  }

  void add(const RunRow& row) {
    Statements& s = *statements;
    const RunOutcome& o = row.outcome;
    s.run.bind(row.run).bind(std::string_view(row.experiment)).bind(static_cast<std::int64_t>(row.seed));
    for (const std::string& setting : row.settings) s.run.bind_setting(setting);
    s.run.bind(std::string_view(o.done ? "done" : "failed")).bind(std::string_view(o.ended));
    s.run.bind(std::string_view(o.failure)).bind(o.ticks).bind(o.virtual_s);
    s.run.bind(std::string_view(o.ticks > 0 ? hash_text(o.fingerprint) : "")).bind(row.version).run();
    s.clear_measures.bind(row.run).run();
    s.clear_samples.bind(row.run).run();
    for (const auto& [name, value] : o.measures) s.measure.bind(row.run).bind(std::string_view(name)).bind(value).run();
    for (const auto& [name, values] : o.samples) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) continue;  // not measured yet
        const std::int64_t tick = o.sample_ticks[i];
        s.sample.bind(row.run).bind(std::string_view(name)).bind(tick);
        s.sample.bind(static_cast<double>(tick) * row.tick_s).bind(values[i]).run();
      }
    }
    s.times.bind(row.run).bind(o.wall_s).bind(o.cpu_s).run();
  }
};

Table::Table(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Table::~Table() = default;

hal::Result<std::unique_ptr<Table>> Table::open(const std::string& path) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  auto lock = WriterLock::take(path);
  if (!lock.ok()) return lock.error();
  impl->lock = std::move(lock).value();
  auto database = Database::open(path, Database::Use::Write);
  if (!database.ok()) return database.error();
  impl->database = std::move(database).value();
  // A commit is then in the system's hands, and costs no wait for the disk: it outlives the process, not the machine.
  impl->database->execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;");
  const hal::Status status = impl->database->status();
  if (!status.ok()) return status.error();
  return std::unique_ptr<Table>(new Table(std::move(impl)));
}

std::optional<TableHead> Table::head() {
  Database& d = *impl_->database;
  if (!d.has("study") || !d.has("runs")) return std::nullopt;
  TableHead head{impl_->get("study"), impl_->get("file"), {}, std::strtoll(impl_->get("runs").c_str(), nullptr, 10)};
  Statement columns(d, "SELECT name FROM pragma_table_info('runs')");
  std::vector<std::string> names;
  while (columns.step()) names.push_back(columns.text(0));
  // run, experiment, seed, the settings, and seven more
  if (names.size() >= 10) head.settings.assign(names.begin() + 3, names.end() - 7);
  impl_->settings = head.settings;
  impl_->prepare();
  return head;
}

hal::Status Table::begin(const TableHead& head) {
  Database& d = *impl_->database;
  if (Statement other(d, "SELECT name FROM sqlite_master LIMIT 1"); other.step())
    return hal::Error{"'" + impl_->path + "' is a database of something else; choose another name for the table"};
  std::string columns;
  for (const std::string& name : head.settings) columns += quoted(name) + ", ";
  d.execute("BEGIN IMMEDIATE");
  d.execute(kTables);
  d.execute("CREATE TABLE runs(run INTEGER PRIMARY KEY, experiment TEXT NOT NULL, seed INTEGER NOT NULL, " + columns +
            "state TEXT NOT NULL, ended TEXT, failure TEXT, ticks INTEGER, virtual_s REAL, fingerprint TEXT, version "
            "INTEGER)");
  impl_->put_head(head);
  impl_->settings = head.settings;
  hal::Status done = impl_->end_transaction();
  if (done.ok()) impl_->prepare();
  return done;
}

hal::Status Table::renew(const TableHead& head) {
  impl_->database->execute("BEGIN IMMEDIATE");
  impl_->put_head(head);
  return impl_->end_transaction();
}

std::optional<Version> Table::version() {
  Database& d = *impl_->database;
  Statement last(d, "SELECT version, program FROM versions ORDER BY version DESC LIMIT 1");
  if (!last.step()) return std::nullopt;
  Version version{last.text(1), {}};
  Statement files(d, "SELECT file, sha256 FROM version_files WHERE version=? ORDER BY rowid");
  files.bind(last.integer(0));
  while (files.step()) version.files.emplace_back(files.text(0), files.text(1));
  return version;
}

hal::Result<std::int64_t> Table::add_version(const Version& version) {
  Database& d = *impl_->database;
  std::int64_t number = 0;
  if (Statement last(d, "SELECT coalesce(max(version),0) FROM versions"); last.step()) number = last.integer(0);
  if (const auto last = this->version(); last && *last == version) return number;
  ++number;
  d.execute("BEGIN IMMEDIATE");
  Statement(d, "INSERT INTO versions(version,program) VALUES(?,?)")
      .bind(number)
      .bind(std::string_view(version.program))
      .run();
  Statement add(d, "INSERT INTO version_files(version,file,sha256) VALUES(?,?,?)");
  for (const auto& [file, sha256] : version.files)
    add.bind(number).bind(std::string_view(file)).bind(std::string_view(sha256)).run();
  if (hal::Status done = impl_->end_transaction(); !done.ok()) return done.error();
  return number;
}

std::vector<KnownRun> Table::known() {
  std::vector<KnownRun> all;
  std::string columns;
  for (const std::string& name : impl_->settings) columns += "," + quoted(name);
  Statement rows(*impl_->database, "SELECT run,experiment,seed,state" + columns + " FROM runs ORDER BY run");
  while (rows.step()) {
    KnownRun& run = all.emplace_back();
    run.run = rows.integer(0);
    run.experiment = rows.text(1);
    run.seed = static_cast<std::uint64_t>(rows.integer(2));
    run.done = rows.text(3) == "done";
    for (int i = 4; i < rows.columns(); ++i) run.settings.push_back(rows.text(i));
  }
  return all;
}

hal::Status Table::add(std::span<const RunRow> rows) {
  impl_->database->execute("BEGIN IMMEDIATE");
  for (const RunRow& row : rows) impl_->add(row);
  return impl_->end_transaction();
}

hal::Status Table::finish() {
  Database& d = *impl_->database;
  std::vector<std::string> taken = {"run",   "experiment", "seed",        "state",   "ended",  "failure",
                                    "ticks", "virtual_s",  "fingerprint", "version", "wall_s", "cpu_s"};
  taken.insert(taken.end(), impl_->settings.begin(), impl_->settings.end());
  std::string columns;
  std::size_t count = 0;
  {
    Statement names(d, "SELECT DISTINCT measure FROM measures ORDER BY measure");
    while (names.step() && ++count <= kMostColumns) {
      const std::string name = names.text(0);
      std::string column = name;
      while (std::any_of(taken.begin(), taken.end(), [&](const auto& t) { return same_name(t, column); }))
        column += "_";
      taken.push_back(column);
      std::string literal;
      for (const char c : name) literal += c == '\'' ? std::string("''") : std::string(1, c);
      columns += ", (SELECT m.value FROM measures m WHERE m.run=runs.run AND m.measure='" + literal + "') AS " +
                 quoted(column);
    }
  }
  impl_->statements.reset();  // they would keep the file's mode
  d.execute("BEGIN IMMEDIATE");
  d.execute("DROP VIEW IF EXISTS results");
  d.execute("CREATE VIEW results AS SELECT runs.*" + columns +
            ", times.wall_s, times.cpu_s FROM runs LEFT JOIN times "
            "ON times.run=runs.run");
  hal::Status done = impl_->end_transaction();
  if (!done.ok()) return done;
  d.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  Statement(d, "PRAGMA journal_mode=DELETE").run();  // one file; where somebody reads it, it stays as it is
  if (!d.good()) d.roll_back();
  impl_->prepare();
  return d.status();
}

void Table::leave_to_parent() noexcept {
  impl_->lock->let_go();
}

}  // namespace tandem::study
