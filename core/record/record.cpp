#include "core/record/record.hpp"

#include <algorithm>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "core/record/block_file.hpp"
#include "core/record/floor_image.hpp"
#include "core/record/pattern.hpp"
#include "core/record/record_streams.hpp"
#include "core/record/scene_json.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

using hal::Json;

struct Recorder::Impl {
  explicit Impl(RecordConfig c) : config(std::move(c)), streams(config) {}

  RecordConfig config;
  std::optional<hal::OutputFile> file;
  RecordStreams streams;
  hal::Tick last = std::numeric_limits<hal::Tick>::min();
  SceneVersion scene;
  std::uint64_t floor = 0, sketch = 0;  // as they were written last
  bool everything = true;               // … or must be, whatever was

  // Between the thread that steps and the one that writes.
  std::mutex mutex;
  std::condition_variable changed, idle;
  std::string ready, after;  // whole blocks, in front of the rows and behind them
  bool rows_ready = false;   // the streams hold rows of `tick` that are to be encoded
  bool over = false;
  bool busy = false;          // the writer uses `streams`
  bool writer_waits = false;  // it is to be woken
  bool stepper_waits = false;
  hal::Tick tick = 0;
  std::string failure;
  std::uint64_t written = 0;
  std::thread writer;

  void describe(const Space& space, hal::Tick now, std::string& out);
  hal::Status hand_over(const std::string& blocks, bool with_rows, hal::Tick now);
  hal::Status append(RecordBlock type, hal::Tick now, std::string_view payload);
  /// Until the writer has done with the streams.
  hal::Status wait_for_streams() {
    std::unique_lock lock(mutex);
    stepper_waits = true;
    idle.wait(lock, [this] { return !busy && !rows_ready; });
    stepper_waits = false;
    return status();
  }
  void end_writer() {
    {
      const std::lock_guard lock(mutex);
      over = true;
    }
    changed.notify_all();
    if (writer.joinable()) writer.join();
  }
  hal::Status status() const { return failure.empty() ? hal::Status{} : hal::Status(hal::Error{failure}); }
  void write();
};

// --- the writer's thread ---

void Recorder::Impl::write() {
  std::string blocks, behind;
  std::unique_lock lock(mutex);
  for (;;) {
    writer_waits = true;
    changed.wait(lock, [this] { return over || rows_ready || !ready.empty(); });
    writer_waits = false;
    if (!rows_ready && ready.empty()) return;
    blocks.swap(ready);
    behind.swap(after);
    const bool with_rows = std::exchange(rows_ready, false);
    const hal::Tick now = tick;
    busy = true;
    const bool lost = !failure.empty();
    lock.unlock();
    hal::Status status;
    if (!lost) {
      if (with_rows) streams.encode(now, blocks);
      blocks += behind;
      status = file->write(blocks);
    }
    lock.lock();
    busy = false;
    if (status.ok() && !lost) written += blocks.size();
    if (!status.ok()) {
      failure = status.error().message + "; it is lost from tick " + std::to_string(now) + " on" +
                (file->part().empty() ? "" : ", what came before is in '" + file->part() + "'");
    }
    blocks.clear();
    behind.clear();
    if (stepper_waits) idle.notify_all();
  }
}

// --- the thread that steps ---

hal::Status Recorder::Impl::hand_over(const std::string& blocks, bool with_rows, hal::Tick now) {
  bool wake = false;
  hal::Status so_far;
  {
    const std::lock_guard lock(mutex);
    (rows_ready ? after : ready) += blocks;
    if (with_rows || !rows_ready) tick = now;  // rows that still wait keep theirs
    rows_ready = rows_ready || with_rows;
    wake = writer_waits;
    so_far = status();
  }
  if (wake) changed.notify_one();  // it finds the lock free
  return so_far;
}

hal::Status Recorder::Impl::append(RecordBlock type, hal::Tick now, std::string_view payload) {
  std::string block;
  append_block(block, static_cast<std::uint16_t>(type), now, payload);
  return hand_over(block, false, now);
}

/// Appends what is new besides rows: scene, floor, drawings, who is there.
void Recorder::Impl::describe(const Space& space, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  const SceneVersion version = scene_version(s);
  const bool new_scene = everything || version != scene;
  if (new_scene) {
    scene = version;
    append_block(out, static_cast<std::uint16_t>(RecordBlock::Scene), now, hal::to_text(scene_json(s)));
  }
  if (config.look) {
    if (const std::uint64_t mark = floor_mark(s); everything ? mark != 0 || floor != 0 : mark != floor) {
      floor = mark;
      append_block(out, static_cast<std::uint16_t>(RecordBlock::Floor), now,
                   mark == 0 ? std::string() : png_of(floor_image(s)));
    }
    const bool drawn = !space.sketch().shapes().empty();
    if (const std::uint64_t mark = drawn ? sketch_mark(space.sketch()) : 0;
        everything ? mark != 0 || sketch != 0 : mark != sketch) {
      sketch = mark;
      append_block(out, static_cast<std::uint16_t>(RecordBlock::Sketch), now,
                   hal::to_text(sketch_json(space.sketch())));
    }
  }
  if (new_scene || streams.stale(space)) streams.declare(space, now, out);
  everything = false;
}

hal::Result<std::unique_ptr<Recorder>> Recorder::open(const RecordConfig& config, const Space& space,
                                                      const Json& start) {
  if (const hal::Status chosen = check_chosen(config, space, "record '" + config.path + "'"); !chosen.ok())
    return chosen.error();
  auto file = hal::OutputFile::open(config.path, "record");
  if (!file.ok()) return file.error();
  auto impl = std::make_unique<Impl>(config);
  impl->config.every = std::max<std::int64_t>(1, config.every);
  impl->file = std::move(file).value();
  impl->file->keep_part();
  std::string blocks(kBlockFileStart);
  append_block(blocks, static_cast<std::uint16_t>(RecordBlock::Start), -1, hal::to_text(start));
  impl->describe(space, -1, blocks);
  impl->streams.copy(space, true);
  (void)impl->hand_over(blocks, true, -1);
  impl->writer = std::thread([&impl = *impl] { impl.write(); });
  return std::unique_ptr<Recorder>(new Recorder(std::move(impl)));
}

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Recorder::~Recorder() {
  impl_->end_writer();
}

hal::Status Recorder::add(const RecordTable& table) {
  Impl& r = *impl_;
  if (const hal::Status so_far = r.wait_for_streams(); !so_far.ok()) return so_far;
  r.streams.add(table);
  return {};
}

hal::Status Recorder::tick_done(const Space& space, hal::Tick tick) {
  Impl& r = *impl_;
  std::string blocks;
  if (tick <= r.last) {
    if (const hal::Status back = went_back(tick); !back.ok()) return back;
  }
  r.last = tick;
  const bool due = tick % r.config.every == 0 || r.everything;
  if (!due && !r.streams.every_tick()) return {};
  if (const hal::Status so_far = r.wait_for_streams(); !so_far.ok()) return so_far;
  if (due || r.streams.stale(space)) r.describe(space, tick, blocks);
  r.streams.copy(space, due);
  return r.hand_over(blocks, true, tick);
}

hal::Status Recorder::set_inputs(const Space& space, const SpaceInputs& inputs) {
  Impl& r = *impl_;
  if (!r.config.inputs) return r.status();
  if (const hal::Status so_far = r.wait_for_streams(); !so_far.ok()) return so_far;
  r.streams.set_inputs(inputs);
  std::string blocks;
  const hal::Tick now = std::max<hal::Tick>(r.last, -1);
  r.streams.declare(space, now, blocks);
  r.streams.copy(space, false);
  return r.hand_over(blocks, true, now);
}

hal::Status Recorder::went_back(std::int64_t to) {
  Impl& r = *impl_;
  if (to > r.last) return r.status();
  r.last = to - 1;
  r.everything = true;
  return r.append(RecordBlock::Back, to, {});
}

bool Recorder::wants_fingerprint(hal::Tick tick) const noexcept {
  const std::int64_t every = impl_->config.fingerprint_every;
  return every > 0 && (wants_checks() || tick % every == 0);
}

bool Recorder::wants_checks() const noexcept {
  return impl_->streams.every_tick();
}

hal::Status Recorder::checks(hal::Tick tick, const StateChecks& checks) {
  std::string payload;
  const auto put = [&payload](const auto& value) {
    payload.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(checks.fields.size()));
  put(static_cast<std::uint32_t>(checks.robots.size()));
  for (const std::uint8_t field : checks.fields) put(field);
  for (const std::uint8_t robot : checks.robots) put(robot);
  return impl_->append(RecordBlock::Checks, tick, payload);
}

hal::Status Recorder::fingerprint(hal::Tick tick, std::uint64_t fingerprint) {
  return impl_->append(RecordBlock::Fingerprint, tick,
                       {reinterpret_cast<const char*>(&fingerprint), sizeof fingerprint});
}

hal::Status Recorder::event(hal::Tick tick, const Json& event) {
  if (const auto to = event.find("to"); event.value("kind", "") == "back" && to != event.end() && to->is_number()) {
    if (const hal::Status back = went_back(to->get<std::int64_t>()); !back.ok()) return back;
  }
  return impl_->append(RecordBlock::Event, tick, hal::to_text(event));
}

hal::Status Recorder::close(hal::Tick tick, const Json& end) {
  Impl& r = *impl_;
  if (!r.file) return r.status();
  (void)r.append(RecordBlock::End, tick, hal::to_text(end));
  r.end_writer();
  hal::Status closed = r.status();
  if (closed.ok()) closed = r.file->commit();
  r.file.reset();
  if (!closed.ok()) r.failure = closed.error().message;
  return closed;
}

const hal::OutputFile& Recorder::file() const noexcept {
  return *impl_->file;
}

std::uint64_t Recorder::bytes() const noexcept {
  const std::lock_guard lock(impl_->mutex);
  return impl_->written;
}

}  // namespace tandem::core
