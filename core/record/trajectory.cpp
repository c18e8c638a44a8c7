#include "core/record/trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <sys/stat.h>
#include <utility>

#include "core/record/block_file.hpp"
#include "core/record/csv_table.hpp"
#include "core/record/pattern.hpp"
#include "core/record/record.hpp"
#include "core/record/record_reader.hpp"
#include "core/record/record_streams.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr int kDecimals = 6;
constexpr std::string_view kHeader = "tick,time_s,id,x_m,y_m,z_m,heading_rad\n";

/// A record of poses alone.
RecordConfig poses_of(const TrajectoryConfig& config) {
  RecordConfig record;
  record.path = config.path;
  if (!config.entities.empty()) record.entities = config.entities;
  record.state = record.look = record.inputs = record.objects = record.attitudes = false;
  return record;
}

/// Bytes that stand in a file; of what has no size: 0.
std::int64_t size_of(const hal::OutputFile& file) {
  struct stat info {};
  return ::fstat(file.descriptor(), &info) == 0 ? info.st_size : 0;
}

}  // namespace

struct TrajectoryRecorder::Impl {
  Impl(const TrajectoryConfig& config, std::int64_t ticks_per_second)
      : every(std::max<std::int64_t>(1, config.every)),
        streams(poses_of(config), RowOrder::Ids),
        table(ticks_per_second, kDecimals) {}

  std::int64_t every;
  RecordStreams streams;
  bool declared = false;
  std::string blocks;  // of the tick at hand
  RecordDecoder decoder;
  CsvTable table;
  std::optional<hal::OutputFile> file;
  bool header_written = false;
  hal::Tick flushed_until = 0;  // the first tick that `buffer` holds lines of
  std::string buffer;           // whole lines, but while a record is made
  UnwrittenRecords unwritten;
  std::string failure;

  void write_lines(const Space& space, hal::Tick tick);
  hal::Status flush();
  hal::Tick first_tick_after(std::size_t kept) const;
  void show_buffer() noexcept {
    unwritten.data.store(buffer.data(), std::memory_order_relaxed);
    unwritten.size.store(buffer.size(), std::memory_order_release);
  }
};

/// Makes the blocks that a record would have of this tick, and lines of them.
void TrajectoryRecorder::Impl::write_lines(const Space& space, hal::Tick tick) {
  if (!std::exchange(header_written, true)) buffer += kHeader;
  blocks.clear();
  if (!std::exchange(declared, true) || streams.stale(space)) streams.declare(space, tick, blocks);
  streams.copy(space, true);
  streams.encode(tick, blocks);
  BlockFileReader reader = BlockFileReader::of(blocks);
  while (const std::optional<Block> block = reader.next()) {
    if (block->type != static_cast<std::uint16_t>(RecordBlock::Rows)) {
      (void)decoder.declare(*block);
      continue;
    }
    const auto entry = decoder.read(*block);
    if (!entry.ok() || !entry.value() || !entry.value()->rows) continue;
    table.note(*entry.value()->rows);
    table.append(tick, *entry.value()->rows, nullptr, buffer);
  }
}

hal::Status TrajectoryRecorder::Impl::flush() {
  if (!failure.empty()) return hal::Error{failure};
  unwritten.size.store(0, std::memory_order_release);  // what is written here is not to be written by another
  const std::int64_t before = size_of(*file);
  const hal::Status written = file->write(buffer);
  if (written.ok()) {
    buffer.clear();
    return {};
  }
  const auto kept = static_cast<std::size_t>(std::max<std::int64_t>(0, size_of(*file) - before));
  failure = written.error().message + "; it is lost from tick " + std::to_string(first_tick_after(kept)) + " on" +
            (file->part().empty() ? "" : ", what came before is in '" + file->part() + "'");
  buffer.clear();
  return hal::Error{failure};
}

/// Of the first line of the buffer behind `kept` bytes, which are whole lines.
hal::Tick TrajectoryRecorder::Impl::first_tick_after(std::size_t kept) const {
  hal::Tick tick = flushed_until;
  const std::string_view lost = std::string_view(buffer).substr(std::min(kept, buffer.size()));
  (void)std::from_chars(lost.data(), lost.data() + lost.size(), tick);  // the header begins with no number
  return tick;
}

hal::Result<std::unique_ptr<TrajectoryRecorder>> TrajectoryRecorder::open(const TrajectoryConfig& config,
                                                                          const Space& space,
                                                                          std::int64_t ticks_per_second) {
  const hal::Status chosen = check_chosen(poses_of(config), space, "trajectory '" + config.path + "'");
  if (!chosen.ok()) return chosen.error();
  auto file = hal::OutputFile::open(config.path, "trajectory");
  if (!file.ok()) return file.error();
  auto impl = std::make_unique<Impl>(config, ticks_per_second);
  impl->file = std::move(file).value();
  impl->buffer.reserve(2 * kBufferBytes);
  impl->unwritten.descriptor = impl->file->descriptor();
  return std::unique_ptr<TrajectoryRecorder>(new TrajectoryRecorder(std::move(impl)));
}

TrajectoryRecorder::TrajectoryRecorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

TrajectoryRecorder::~TrajectoryRecorder() {
  if (impl_->file && impl_->header_written) (void)close();
}

hal::Status TrajectoryRecorder::record(const Space& space, hal::Tick tick) {
  Impl& r = *impl_;
  if (!r.failure.empty()) return hal::Error{r.failure};
  if (tick % r.every != 0) return {};
  r.unwritten.size.store(0, std::memory_order_release);  // the buffer may move
  if (r.buffer.empty()) r.flushed_until = tick;
  r.write_lines(space, tick);
  hal::Status flushed;
  if (r.buffer.size() >= kBufferBytes) flushed = r.flush();
  r.show_buffer();
  return flushed;
}

hal::Status TrajectoryRecorder::flush() {
  return impl_->flush();
}

hal::Status TrajectoryRecorder::close() {
  Impl& r = *impl_;
  if (!r.file) return r.failure.empty() ? hal::Status{} : hal::Status(hal::Error{r.failure});
  if (!r.header_written && r.failure.empty()) r.buffer += kHeader;
  hal::Status closed = r.flush();
  if (closed.ok()) {
    closed = r.file->commit();
  } else {
    r.file->keep_part();
  }
  r.file.reset();
  if (!closed.ok()) r.failure = closed.error().message;
  return closed;
}

const UnwrittenRecords& TrajectoryRecorder::unwritten() const noexcept {
  return impl_->unwritten;
}

const hal::OutputFile& TrajectoryRecorder::file() const noexcept {
  return *impl_->file;
}

}  // namespace tandem::core
